// SPDX-License-Identifier: BSD-3-Clause
// Strips, which are coded eight pixels or eight rows at a time, beside the same done one pixel at a
// time as doc/dhcm.md tells it.
#include <gtest/gtest.h>

#include <random>

#include "dhcm/body_decoder.hpp"
#include "dhcm/body_encoder.hpp"
#include "dhcm/model.hpp"
#include "rprr_geometry/block_mask.hpp"
#include "rprr_synthetic/coded_images.hpp"
#include "rprr_wire/bytes.hpp"

namespace rprr::dhcm {
namespace {

struct Tables {
  std::array<SetDecodeTable, kHoleClasses> groups;
  SetDecodeTable changes;
  DecodeTable residuals;
};

template <typename Table>
std::size_t symbol(const Table& table, BitReader& bits) {
  int longest = 0;
  while ((1u << longest) < table.entries.size()) ++longest;
  bits.refill();
  const auto entry = table.entries[bits.peek(longest)];
  bits.skip(entry.length);
  return entry.symbol;
}

std::int16_t residual(const DecodeTable& table, BitReader& bits) {
  const int s = static_cast<int>(symbol(table, bits));
  const std::uint32_t number = base_of(s) + bits.get(extra_bits_of(s));
  return static_cast<std::int16_t>(unfold(number + 1));
}

template <typename Table>
void read_table(BitReader& bits, Table& table) {
  std::array<std::uint8_t, std::is_same_v<Table, DecodeTable> ? kSymbols : kSetSymbols> lengths;
  ASSERT_TRUE(read_lengths(bits, lengths));
  ASSERT_TRUE(table.build(lengths));
}

// A strip reader without lanes: one pixel after the other, each from its own neighbours.
class OnePixelAtATime {
 public:
  OnePixelAtATime(int width, int height, const BlockMask* mask)
      : grid_(width, height),
        mask_(mask),
        above_(1, grid_.columns * 8, CV_16SC1, cv::Scalar(0)),
        holes_(static_cast<std::size_t>(grid_.columns), 0) {}

  void read(ByteView body, cv::Mat& counts) {
    open(body);
    for (int strip = 0; strip < grid_.rows; ++strip) {
      for (int column = 0; column < grid_.columns; ++column) {
        const int begin = column;
        while (column < grid_.columns && sent(column, strip)) ++column;
        if (column > begin) segment(begin, column, strip, counts);
      }
    }
    for (const BitReader& stream : streams_) EXPECT_TRUE(stream.finished());
  }

 private:
  bool sent(int column, int strip) const {
    return strip >= 0 && (mask_ == nullptr || (*mask_)[grid_.index(column, strip)]);
  }

  void open(ByteView body) {
    ByteReader reader(body);
    std::size_t sizes[4];
    std::size_t all = 0;
    for (std::size_t& size : sizes) all += size = reader.get<std::uint32_t>();
    BitReader head(reader.get_view(reader.left() - all));
    ranked_ = head.get(1) != 0;
    if (ranked_) {
      ASSERT_TRUE(values_.read(head));
    }
    for (SetDecodeTable& table : tables_.groups) read_table(head, table);
    read_table(head, tables_.changes);
    read_table(head, tables_.residuals);
    EXPECT_TRUE(head.finished());
    for (std::size_t s = 0; s < 4; ++s) streams_[s] = BitReader(reader.get_view(sizes[s]));
  }

  void segment(int begin, int end, int strip, cv::Mat& counts) {
    for (int column = begin; column < end && strip > 0; ++column) {
      if (sent(column, strip - 1)) continue;
      for (int u = 8 * column; u < 8 * column + 8; ++u) {
        north(u) = column == begin ? last_ : north(8 * column - 1);
      }
      holes_[static_cast<std::size_t>(column)] = 0;
    }
    const int rows = std::min(8, grid_.height - 8 * strip);
    for (int k = 0; k < rows; ++k) {
      std::int16_t w = north(8 * begin);
      std::int16_t nw = w;
      for (int column = begin; column < end; ++column) {
        group(column, 8 * strip + k, w, nw, counts);
      }
      if (k == 0) last_ = north(8 * begin);
    }
  }

  void group(int column, int v, std::int16_t& w, std::int16_t& nw, cv::Mat& counts) {
    BitReader& bits = streams_[static_cast<std::size_t>(v % 2)];
    std::uint8_t& holes = holes_[static_cast<std::size_t>(column)];
    const SetDecodeTable& table = tables_.groups[holes == 0 ? 0 : holes == 255 ? 2 : 1];
    std::size_t set = symbol(table, bits);
    if (set == 256) {
      holes = static_cast<std::uint8_t>(holes ^ symbol(tables_.changes, bits));
      set = symbol(table, bits);
    }
    for (int i = 0; i < 8; ++i) {
      const int u = 8 * column + i;
      const std::int16_t n = north(u);
      std::int16_t x = predict(w, n, static_cast<std::int16_t>(n - nw));
      if ((set >> i & 1) != 0) {
        BitReader& residuals = streams_[static_cast<std::size_t>(2 + v % 2)];
        x = static_cast<std::int16_t>(x + residual(tables_.residuals, residuals));
      }
      const bool hole = (holes >> i & 1) != 0;
      if (hole) x = n;
      nw = n;
      w = north(u) = x;
      if (u < grid_.width) counts.at<std::uint16_t>(v, u) = hole ? 0 : reading(x);
    }
  }

  std::uint16_t reading(std::int16_t rank) const {
    const auto number = static_cast<std::uint16_t>(rank);
    return !ranked_ ? number : number == 0 ? 0 : values_.values().at(number - 1u);
  }
  std::int16_t& north(int u) { return above_.at<std::int16_t>(0, u); }

  BlockGrid grid_;
  const BlockMask* mask_;
  cv::Mat above_;
  std::vector<std::uint8_t> holes_;
  std::int16_t last_ = 0;
  bool ranked_ = false;
  ValueTable values_;
  Tables tables_;
  std::array<BitReader, 4> streams_;
};

void expect_same(const DepthFrame& frame, const BlockMask* mask, DhcmMode mode) {
  static BodyEncoder encoder;
  static BodyDecoder decoder;
  Bytes body;
  const cv::Mat& counts = frame.counts;
  const Body kind = encoder.encode(
      {counts.ptr<std::uint16_t>(), counts.step1(), counts.cols, counts.rows}, mask, mode, body);
  if (kind != Body::kStrips || body.empty()) return;
  cv::Mat lanes(counts.size(), CV_16UC1, cv::Scalar(0));
  ASSERT_TRUE(decoder.decode(kind, body, mask,
                             {lanes.ptr<std::uint16_t>(), lanes.step1(), lanes.cols, lanes.rows}));
  cv::Mat single(counts.size(), CV_16UC1, cv::Scalar(0));
  OnePixelAtATime(counts.cols, counts.rows, mask).read(body, single);
  EXPECT_TRUE(synthetic::same(lanes, single)) << counts.size();
}

TEST(DhcmStrips, LanesAgreeWithOnePixelAtATime) {
  for (const DhcmMode mode : {DhcmMode::kFast, DhcmMode::kDefault}) {
    for (const cv::Size size :
         {cv::Size(640, 480), cv::Size(61, 45), cv::Size(8, 1), cv::Size(1, 9)}) {
      const DepthFrame frame = synthetic::kinect_like(size.width, size.height);
      const BlockGrid grid(size.width, size.height);
      expect_same(frame, nullptr, mode);
      for (const double share : {0.1, 0.5, 0.9}) {
        const BlockMask blocks = synthetic::some_blocks(grid, share);
        expect_same(frame, &blocks, mode);
        const BlockMask region = synthetic::region(grid, share);
        expect_same(frame, &region, mode);
      }
    }
  }
}

// Readings of the whole range, whose differences wrap around, and holes of all sizes.
TEST(DhcmStrips, LanesAgreeOnExtremes) {
  std::mt19937 random(5);
  for (int trial = 0; trial < 200; ++trial) {
    DepthFrame frame = synthetic::constant(100, 40, 0);
    const std::uint16_t levels[] = {1, 32767, 32768, 65535};
    for (int patch = 0; patch < 12; ++patch) {
      const int u = static_cast<int>(random() % 90);
      const int v = static_cast<int>(random() % 36);
      const std::uint16_t value = random() % 3 == 0 ? std::uint16_t{0} : levels[random() % 4];
      const cv::Rect rect(u, v, 1 + static_cast<int>(random() % 40),
                          1 + static_cast<int>(random() % 20));
      frame.counts(rect & cv::Rect(0, 0, 100, 40)).setTo(value);
    }
    expect_same(frame, nullptr, DhcmMode::kDefault);
  }
}

TEST(DhcmStrips, PlacesOfSetsAreTheirBits) {
  for (unsigned set = 0; set < 256; ++set) {
    unsigned sum = 0;
    for (unsigned i = 0; i < kSizes[set]; ++i) sum |= 1u << kPlaces[set].at[i];
    EXPECT_EQ(sum, set);
  }
}

TEST(DhcmStrips, LanesShiftAndBecomeBits) {
  const Lanes lanes = {10, -11, 12, -13, 14, -15, 16, -17};
  const Lanes shifted = shift_in(99, lanes);
  EXPECT_EQ(shifted[0], 99);
  for (int i = 1; i < kLanes; ++i) EXPECT_EQ(shifted[i], lanes[i - 1]);
  EXPECT_EQ(bits_of_lanes(lanes < 0), 0b10101010);
  EXPECT_EQ(plus(all(32767), all(1))[3], -32768);
  EXPECT_EQ(minus(all(-32768), all(1))[3], 32767);
}

TEST(DhcmStrips, SetsHaveCompleteCodesThatComeBack) {
  std::mt19937 random(8);
  for (std::size_t used : {2u, 3u, 100u, 257u}) {
    SetHistogram histogram{};
    for (std::size_t i = 0; i < used; ++i)
      histogram[256 - i] = 1 + random() % (1u << random() % 24);
    const SetLengths lengths = code_lengths(histogram);
    SetDecodeTable table;
    EXPECT_TRUE(table.build(lengths));
    Bytes bytes;
    BitWriter writer(bytes);
    write_lengths(lengths, writer);
    writer.finish();
    BitReader reader(bytes);
    SetLengths back;
    ASSERT_TRUE(read_lengths(reader, back));
    EXPECT_EQ(back, lengths);
  }
}

}  // namespace
}  // namespace rprr::dhcm
