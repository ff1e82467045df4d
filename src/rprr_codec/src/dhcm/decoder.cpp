// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <opencv2/core.hpp>

#include "dhcm/container.hpp"
#include "dhcm/scan.hpp"
#include "dhcm/tables.hpp"
#include "dhcm/values.hpp"
#include "rprr_codec/dhcm.hpp"

namespace rprr {
namespace dhcm {
namespace {

// Reads pixels in the order and contexts in which TokenCoder wrote them.
class TokenReader {
 public:
  TokenReader(BitReader& bits, const DecodeTables& tables) : bits_(bits), tables_(tables) {}

  void begin_row(std::uint16_t* ranks) { ranks_ = ranks; }

  int run(int context, int guess, int u) {
    Run& run = runs_[static_cast<std::size_t>(context)];
    if (run.left == 0) {
      if (run.number_due) begin_run(run, kRunTables + context);
      if (run.left == 0) {
        run.number_due = true;
        return pixel(context, guess, u);
      }
    }
    --run.left;
    return put(u, context == kInHole ? kNoReading : guess);
  }

  int pixel(int context, int guess, int u) {
    bits_.refill();
    const int symbol = next_symbol(context);
    if (symbol == kHoleSymbol) return put(u, kNoReading);
    const std::uint16_t residual = unfold(rest_of_number(symbol));
    return put(u, static_cast<std::uint16_t>(guess + residual));
  }

 private:
  struct Run {
    std::uint32_t left = 0;
    bool number_due = true;  // where none is left; else the pixel that ended the run is due
  };

  void begin_run(Run& run, int table) {
    bits_.refill();
    run.left = rest_of_number(next_symbol(table));
    run.number_due = run.left == kRunLimit;
  }
  int put(int u, int value) {
    ranks_[u] = value == kNoReading ? 0 : static_cast<std::uint16_t>(value);
    return value;
  }
  int next_symbol(int table) {
    const DecodeTable::Entry entry =
        tables_[static_cast<std::size_t>(table)].entries[bits_.peek(kMaxCodeLength)];
    bits_.skip(entry.length);
    return entry.symbol;
  }
  std::uint32_t rest_of_number(int symbol) {
    if (symbol < kDirect) return static_cast<std::uint32_t>(symbol);
    const int extra = extra_bits_of(symbol);
    const std::uint32_t value = base_of(symbol) + bits_.peek(extra);
    bits_.skip(extra);
    return value;
  }

  BitReader& bits_;
  const DecodeTables& tables_;
  std::array<Run, kRunContexts> runs_;
  std::uint16_t* ranks_ = nullptr;
};

}  // namespace
}  // namespace dhcm

struct DhcmDecoder::Buffers {
  dhcm::ValueTable values;
  dhcm::Surface surface;
  dhcm::DecodeTables tables;

  Result<DepthFrame> decode(const dhcm::Opened& opened, const BlockMask* mask,
                            std::size_t max_pixels);

 private:
  bool decode_body(ByteView body, dhcm::Segments& segments, cv::Mat& counts);
};

namespace dhcm {
namespace {

bool ranks_to_values(const std::vector<std::uint16_t>& values, std::uint16_t* row, int width) {
  for (int u = 0; u < width; ++u) {
    if (row[u] > values.size()) return false;
    if (row[u] != 0) row[u] = values[row[u] - 1u];
  }
  return true;
}

bool read_stored(ByteView body, Segments& segments, cv::Mat& counts) {
  if (body.size != 2 * segments.pixels()) return false;
  const std::uint8_t* at = body.data;
  for (int v = 0; v < counts.rows; ++v) {
    auto* out = counts.ptr<std::uint16_t>(v);
    for (const Segment& segment : segments.of_row(v)) {
      for (int u = segment.begin; u < segment.end; ++u, at += 2) {
        out[u] = static_cast<std::uint16_t>(at[0] | at[1] << 8);
      }
    }
  }
  return true;
}

}  // namespace
}  // namespace dhcm

bool DhcmDecoder::Buffers::decode_body(ByteView body, dhcm::Segments& segments, cv::Mat& counts) {
  if (segments.pixels() == 0) return body.size == 0;
  dhcm::BitReader bits(body);
  const bool ranked = bits.get(1) != 0;
  if (ranked && !values.read(bits)) return false;
  if (!dhcm::read_tables(bits, tables)) return false;
  surface.reset(counts.cols);
  dhcm::TokenReader coder(bits, tables);
  for (int v = 0; v < counts.rows; ++v) {
    auto* row = counts.ptr<std::uint16_t>(v);
    coder.begin_row(row);
    dhcm::scan_row(segments.of_row(v), surface, coder);
    if (bits.overrun()) return false;
    if (ranked && !dhcm::ranks_to_values(values.values(), row, counts.cols)) return false;
  }
  return bits.finished();
}

Result<DepthFrame> DhcmDecoder::Buffers::decode(const dhcm::Opened& opened, const BlockMask* mask,
                                                std::size_t max_pixels) {
  const dhcm::Header& header = opened.header;
  if (header.masked != (mask != nullptr)) {
    return Error{mask != nullptr ? "depth payload of a whole frame where blocks were expected"
                                 : "depth payload of some blocks where a whole frame was expected"};
  }
  const auto width = static_cast<std::size_t>(header.width);
  const auto height = static_cast<std::size_t>(header.height);
  if (width * height > max_pixels) return Error{"depth image is larger than allowed"};
  if (mask != nullptr &&
      (mask->grid().width != header.width || mask->grid().height != header.height)) {
    return Error{"depth payload is of another size than its block mask"};
  }
  DepthFrame frame;
  frame.unit = header.unit;
  // Zeroed by blocks that are not sent; a whole frame writes every pixel.
  frame.counts.create(header.height, header.width, CV_16UC1);
  if (mask != nullptr) frame.counts.setTo(0);
  dhcm::Segments segments(BlockGrid(header.width, header.height), mask);
  const bool good = header.mode == dhcm::Mode::kStored
                        ? dhcm::read_stored(opened.body, segments, frame.counts)
                        : decode_body(opened.body, segments, frame.counts);
  if (!good) return Error{"depth payload is malformed"};
  return frame;
}

DhcmDecoder::DhcmDecoder(std::size_t max_pixels)
    : buffers_(std::make_unique<Buffers>()), max_pixels_(max_pixels) {
}
DhcmDecoder::~DhcmDecoder() = default;

Result<DepthFrame> DhcmDecoder::decode(ByteView payload) {
  const Result<dhcm::Opened> opened = dhcm::open(payload);
  if (!opened) return Error{opened.reason()};
  return buffers_->decode(*opened, nullptr, max_pixels_);
}

Result<DepthFrame> DhcmDecoder::decode(ByteView payload, cv::Size expected) {
  const Result<dhcm::Opened> opened = dhcm::open(payload);
  if (!opened) return Error{opened.reason()};
  if (opened->header.width != expected.width || opened->header.height != expected.height) {
    return Error{"depth payload is of another size than expected"};
  }
  return buffers_->decode(*opened, nullptr, max_pixels_);
}

Result<DepthFrame> DhcmDecoder::decode(ByteView payload, const BlockMask& blocks) {
  const Result<dhcm::Opened> opened = dhcm::open(payload);
  if (!opened) return Error{opened.reason()};
  return buffers_->decode(*opened, &blocks, max_pixels_);
}

}  // namespace rprr
