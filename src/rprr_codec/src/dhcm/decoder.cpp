// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <opencv2/core.hpp>

#include "dhcm/container.hpp"
#include "dhcm/float_image.hpp"
#include "dhcm/scan.hpp"
#include "dhcm/strip_reader.hpp"
#include "dhcm/tables.hpp"
#include "dhcm/values.hpp"
#include "rprr_codec/dhcm.hpp"

namespace rprr {
namespace dhcm {
namespace {

// An event by the next kMaxCodeLength bits, where residual and run are both found there.
struct JointEntry {
  std::int16_t residual;
  std::uint8_t run;
  std::uint8_t bits;  // low 4: bits taken; 0x40 no reading; 0x80 not found: look both up
};
constexpr std::uint8_t kBitsMask = 0x0F;
constexpr std::uint8_t kJointHole = 0x40;
constexpr std::uint8_t kJointNone = 0x80;
using JointTable = std::array<JointEntry, 1u << kMaxCodeLength>;

void join_tables(const DecodeTable& residuals, const DecodeTable& runs, JointTable& joint) {
  for (std::uint32_t i = 0; i < joint.size(); ++i) {
    const DecodeTable::Entry first = residuals.entries[i];
    const DecodeTable::Entry second = runs.entries[i >> first.length];
    const int length = first.length + second.length;
    const bool hole = first.symbol == kHoleSymbol;
    JointEntry& entry = joint[i];
    entry = {0, second.symbol, static_cast<std::uint8_t>(length)};
    if (length > kMaxCodeLength || second.symbol >= kDirect || (first.symbol >= kDirect && !hole)) {
      entry.bits = kJointNone;
    } else if (hole) {
      entry.bits |= kJointHole;
    } else {
      entry.residual = static_cast<std::int16_t>(unfold(first.symbol));
    }
  }
}

struct DecodedEvent {
  std::int16_t residual;
  bool hole;
  std::uint32_t run;
};

// Reads pixels in the order and contexts in which EventCoder wrote them.
class EventReader {
 public:
  EventReader(BitReader& bits, const std::vector<DecodeTable>& tables,
              const std::vector<JointTable>& joint, std::uint16_t largest, int width)
      : bits_(bits),
        tables_(tables),
        joint_(joint),
        largest_(largest),
        north_(static_cast<std::size_t>(width + kLanes)),
        step_(static_cast<std::size_t>(width + kLanes)) {}

  /// False once a rank was not in the value table.
  bool good() const { return good_; }

  void row(const std::vector<Segment>& segments, Surface& surface) {
    for (const Segment& segment : segments) {
      if (segment.north) {
        below_known(segment, surface);
      } else {
        first_row(segment, surface);
      }
    }
  }

 private:
  void below_known(const Segment& segment, Surface& surface);
  void first_row(const Segment& segment, Surface& surface);
  DecodedEvent event(std::size_t context, BitReader& bits);
  DecodedEvent long_event(std::size_t context, BitReader& bits);
  std::uint32_t number(std::size_t table, BitReader& bits);
  void check(std::int16_t rank) { good_ = good_ && static_cast<std::uint16_t>(rank) <= largest_; }

  BitReader& bits_;
  const std::vector<DecodeTable>& tables_;
  const std::vector<JointTable>& joint_;
  std::uint16_t largest_;
  bool good_ = true;
  std::array<std::uint32_t, kContexts> left_{};  // right guesses to come
  std::vector<std::uint8_t> north_;
  std::vector<std::int16_t> step_;
};

inline DecodedEvent EventReader::event(std::size_t context, BitReader& bits) {
  bits.refill();
  const JointEntry entry = joint_[context][bits.peek(kMaxCodeLength)];
  if ((entry.bits & kJointNone) != 0) {
    BitReader copy = bits;
    const DecodedEvent event = long_event(context, copy);
    bits = copy;
    return event;
  }
  bits.skip(entry.bits & kBitsMask);
  return {entry.residual, (entry.bits & kJointHole) != 0, entry.run};
}

DecodedEvent EventReader::long_event(std::size_t context, BitReader& bits) {
  DecodedEvent event = {0, false, 0};
  const std::uint32_t residual = number(context, bits);
  event.hole = residual == ~0u;
  if (!event.hole) event.residual = static_cast<std::int16_t>(unfold(residual));
  bits.refill();
  event.run = number(kContexts + context, bits);
  return event;
}

// ~0 for the hole symbol of a table of residuals.
std::uint32_t EventReader::number(std::size_t table, BitReader& bits) {
  const DecodeTable::Entry entry = tables_[table].entries[bits.peek(kMaxCodeLength)];
  bits.skip(entry.length);
  if (entry.symbol < kDirect) return entry.symbol;
  if (table < kContexts && entry.symbol >= kHoleSymbol) {
    good_ = good_ && entry.symbol == kHoleSymbol;
    return ~0u;
  }
  const int extra = extra_bits_of(entry.symbol);
  const std::uint32_t value = base_of(entry.symbol) + bits.peek(extra);
  bits.skip(extra);
  return value;
}

// How many of the bytes from first on are the same as it, at most limit, of which 7 more can be
// read.
inline int same_bytes(const std::uint8_t* first, int limit) {
  const std::uint64_t pattern = *first * 0x0101010101010101u;
  for (int i = 0; i < limit; i += 8) {
    const std::uint64_t difference = load64(first + i) ^ pattern;
    if (difference != 0) return std::min(limit, i + (__builtin_ctzll(difference) >> 3));
  }
  return limit;
}

void EventReader::below_known(const Segment& segment, Surface& surface) {
  surface.prepare(segment);
  std::int16_t* const fill = surface.fill();
  std::int16_t* const hole = surface.hole();
  const int end = segment.end;
  classify_north(fill, hole, segment.begin, end, north_.data(), step_.data());
  const std::uint8_t* const north = north_.data();
  const std::int16_t* const step = step_.data();
  const std::uint8_t* const map = context_map().data();
  BitReader bits = bits_;
  std::int16_t w = fill[segment.begin - 1];
  std::int16_t nw = w;
  bool w_hole = hole[segment.begin - 1] != 0;
  for (int u = segment.begin; u < end; ++u) {
    const std::int16_t n = fill[u];
    const int west = w_hole ? kWestHole : west_class(w, nw);
    const std::size_t context = map[north[u] * kWestClasses + west];
    const std::int16_t guess = predict(w, n, step[u]);
    nw = n;
    std::uint32_t& left = left_[context];
    if (left != 0) {
      if (context <= kInHole) {
        // Nothing changes, neither the surface nor the context, while north stays as it is.
        const int limit =
            static_cast<int>(std::min<std::uint32_t>(left, static_cast<std::uint32_t>(end - u)));
        const int same = same_bytes(north + u, limit);
        left -= static_cast<std::uint32_t>(same);
        u += same - 1;
        w = nw = fill[u];
        continue;
      }
      --left;
      w = guess;
      w_hole = false;
      hole[u] = 0;
    } else {
      const DecodedEvent read = event(context, bits);
      left = read.run;
      w_hole = read.hole;
      w = w_hole ? n : static_cast<std::int16_t>(guess + read.residual);
      hole[u] = w_hole ? 1 : 0;
      check(w);
    }
    fill[u] = w;
  }
  bits_ = bits;
}

void EventReader::first_row(const Segment& segment, Surface& surface) {
  std::int16_t* const fill = surface.fill();
  std::int16_t* const hole = surface.hole();
  for (int u = segment.begin; u < segment.end; ++u) {
    const bool start = u == segment.begin && !segment.west;
    const std::int16_t guess = start ? surface.last_start() : fill[u - 1];
    const std::size_t context = start ? kStart : hole[u - 1] != 0 ? kNoNorthHole : kNoNorth;
    fill[u] = guess;
    hole[u] = 0;
    if (left_[context] != 0) {
      --left_[context];
    } else {
      const DecodedEvent read = event(context, bits_);
      left_[context] = read.run;
      hole[u] = read.hole ? 1 : 0;
      if (!read.hole) fill[u] = static_cast<std::int16_t>(guess + read.residual);
      check(fill[u]);
    }
    if (start) surface.last_start() = fill[u];
  }
}

}  // namespace
}  // namespace dhcm

struct DhcmDecoder::Buffers {
  dhcm::ValueTable values;
  dhcm::Surface surface;
  std::vector<dhcm::DecodeTable> tables;
  std::vector<dhcm::JointTable> joint;
  dhcm::StripTables strip_tables;

  Result<DepthFrame> decode(const dhcm::Opened& opened, const BlockMask* mask,
                            std::size_t max_pixels);

 private:
  bool decode_body(const dhcm::Opened& opened, const BlockMask* mask, cv::Mat& counts);
  bool decode_events(dhcm::BitReader& bits, const BlockMask* mask, bool ranked, cv::Mat& counts);
  bool decode_strips(ByteView body, const BlockMask* mask, cv::Mat& counts);
  bool read_values(dhcm::BitReader& bits, bool ranked);
  // What ranks stand for, from rank 0; without a value table nothing.
  std::vector<std::uint16_t> lookup;
};

namespace dhcm {
namespace {

// The row's surface as readings.
void write_row(Surface& surface, const std::vector<Segment>& segments,
               const std::vector<std::uint16_t>& values, bool ranked, std::uint16_t* out) {
  const std::int16_t* const fill = surface.fill();
  const std::int16_t* const hole = surface.hole();
  for (const Segment& segment : segments) {
    if (ranked) {
      for (int u = segment.begin; u < segment.end; ++u) {
        out[u] =
            static_cast<std::uint16_t>(values[static_cast<std::uint16_t>(fill[u])] & (hole[u] - 1));
      }
    } else {
      for (int u = segment.begin; u < segment.end; ++u) {
        out[u] = static_cast<std::uint16_t>(fill[u] & (hole[u] - 1));
      }
    }
  }
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

bool DhcmDecoder::Buffers::decode_events(dhcm::BitReader& bits, const BlockMask* mask, bool ranked,
                                         cv::Mat& counts) {
  tables.resize(dhcm::kTables);
  if (!dhcm::read_tables(bits, dhcm::kTables, tables.data())) return false;
  joint.resize(dhcm::kContexts);
  for (std::size_t c = 0; c < dhcm::kContexts; ++c) {
    dhcm::join_tables(tables[c], tables[dhcm::kContexts + c], joint[c]);
  }
  surface.reset(counts.cols);
  dhcm::Segments segments(BlockGrid(counts.cols, counts.rows), mask);
  const auto largest = static_cast<std::uint16_t>(ranked ? values.values().size() : 65535);
  dhcm::EventReader reader(bits, tables, joint, largest, counts.cols);
  for (int v = 0; v < counts.rows; ++v) {
    const auto& row = segments.of_row(v);
    reader.row(row, surface);
    if (bits.overrun() || !reader.good()) return false;
    dhcm::write_row(surface, row, lookup, ranked, counts.ptr<std::uint16_t>(v));
  }
  return true;
}

bool DhcmDecoder::Buffers::decode_strips(ByteView body, const BlockMask* mask, cv::Mat& counts) {
  ByteReader sizes(body);
  std::array<std::size_t, dhcm::kStripStreams> lengths{};
  std::size_t all = 0;
  for (std::size_t& length : lengths) all += length = sizes.get<std::uint32_t>();
  if (!sizes.ok() || all > sizes.left()) return false;
  dhcm::BitReader head(sizes.get_view(sizes.left() - all));
  const bool ranked = head.get(1) != 0;
  if (!read_values(head, ranked) || !strip_tables.read(head) || !head.finished()) return false;
  dhcm::StripStreams streams;
  for (std::size_t s = 0; s < streams.size(); ++s) {
    streams[s] = dhcm::BitReader(sizes.get_view(lengths[s]));
  }
  const BlockGrid grid(counts.cols, counts.rows);
  const auto largest = static_cast<std::uint16_t>(ranked ? values.values().size() : 65535);
  dhcm::StripReader reader(grid, mask, largest);
  for (int strip = 0; strip < grid.rows; ++strip) {
    const dhcm::StripTarget target = {counts.ptr<std::uint16_t>(strip * dhcm::kStripRows),
                                      counts.step1(), ranked ? lookup.data() : nullptr};
    if (!reader.strip(strip, strip_tables, streams, target)) return false;
    for (const dhcm::BitReader& stream : streams) {
      if (stream.overrun()) return false;
    }
  }
  return std::all_of(streams.begin(), streams.end(),
                     [](const dhcm::BitReader& stream) { return stream.finished(); });
}

bool DhcmDecoder::Buffers::read_values(dhcm::BitReader& bits, bool ranked) {
  if (!ranked) return true;
  if (!values.read(bits)) return false;
  lookup.assign(1, 0);
  lookup.insert(lookup.end(), values.values().begin(), values.values().end());
  // A guess lies between two ranks that were checked, as signed numbers; where some are negative
  // that is any number at all.
  if (lookup.size() > 32768) lookup.resize(65536, 0);
  return true;
}

bool DhcmDecoder::Buffers::decode_body(const dhcm::Opened& opened, const BlockMask* mask,
                                       cv::Mat& counts) {
  dhcm::Segments segments(BlockGrid(counts.cols, counts.rows), mask);
  if (opened.header.body == dhcm::Body::kStored) {
    return dhcm::read_stored(opened.body, segments, counts);
  }
  if (segments.pixels() == 0) return opened.body.size == 0;
  if (opened.header.body == dhcm::Body::kStrips) return decode_strips(opened.body, mask, counts);
  dhcm::BitReader bits(opened.body);
  const bool ranked = bits.get(1) != 0;
  if (!read_values(bits, ranked)) return false;
  return decode_events(bits, mask, ranked, counts) && bits.finished();
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
  const bool good = decode_body(opened, mask, frame.counts);
  if (!good) return Error{"depth payload is malformed"};
  return frame;
}

DhcmDecoder::DhcmDecoder(std::size_t max_pixels)
    : buffers_(std::make_unique<Buffers>()), max_pixels_(max_pixels) {
}
DhcmDecoder::~DhcmDecoder() = default;

namespace {

Result<dhcm::Opened> open_counts(ByteView payload) {
  Result<dhcm::Opened> opened = dhcm::open(payload);
  if (opened && opened->header.pixels != DhcmPixels::kCounts) {
    return Error{"depth payload of a 32FC1 image where counts were expected"};
  }
  return opened;
}

}  // namespace

Result<DepthFrame> DhcmDecoder::decode(ByteView payload) {
  const Result<dhcm::Opened> opened = open_counts(payload);
  if (!opened) return Error{opened.reason()};
  return buffers_->decode(*opened, nullptr, max_pixels_);
}

Result<DepthFrame> DhcmDecoder::decode(ByteView payload, cv::Size expected) {
  const Result<dhcm::Opened> opened = open_counts(payload);
  if (!opened) return Error{opened.reason()};
  if (opened->header.width != expected.width || opened->header.height != expected.height) {
    return Error{"depth payload is of another size than expected"};
  }
  return buffers_->decode(*opened, nullptr, max_pixels_);
}

Result<DepthFrame> DhcmDecoder::decode(ByteView payload, const BlockMask& blocks) {
  const Result<dhcm::Opened> opened = open_counts(payload);
  if (!opened) return Error{opened.reason()};
  return buffers_->decode(*opened, &blocks, max_pixels_);
}

Result<cv::Mat> DhcmDecoder::decode_float(ByteView payload) {
  const Result<dhcm::Opened> opened = dhcm::open(payload);
  if (!opened) return Error{opened.reason()};
  const dhcm::Header& header = opened->header;
  if (header.pixels == DhcmPixels::kCounts) {
    return Error{"depth payload of counts where a 32FC1 image was expected"};
  }
  if (header.pixels == DhcmPixels::kFloat) {
    const cv::Size size(header.width, header.height);
    return dhcm::unpack_float(*opened, [&](ByteView plane) { return decode(plane, size); });
  }
  const Result<DepthFrame> frame = buffers_->decode(*opened, nullptr, max_pixels_);
  if (!frame) return Error{frame.reason()};
  return to_float_image(*frame);
}

}  // namespace rprr
