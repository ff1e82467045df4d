// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "dhcm/container.hpp"
#include "dhcm/events.hpp"
#include "dhcm/float_image.hpp"
#include "dhcm/strips.hpp"
#include "dhcm/values.hpp"
#include "rprr_codec/dhcm.hpp"
#include "rprr_geometry/camera.hpp"

namespace rprr {
namespace dhcm {
namespace {

// Second pass.
void write_events(const EventCoder& coder, const EncodeTables& tables, BitWriter& bits) {
  for (std::size_t i = 0; i < coder.event_count(); ++i) {
    const Event& event = coder.events()[i];
    const EncodeTable::Word& word = tables[event.context].words[event.symbol];
    const int extra = event.symbol == kHoleSymbol ? 0 : extra_bits_of(event.symbol);
    bits.put(word.code | static_cast<std::uint32_t>(event.extra) << word.length,
             word.length + extra);
    const Split run = split_number(event.run);
    const EncodeTable::Word& length =
        tables[static_cast<std::size_t>(run_table(event.context))].words[run.symbol];
    bits.put(length.code, length.length);
    if (run.extra_bits > 0) bits.put(run.extra, run.extra_bits);
  }
}

}  // namespace
}  // namespace dhcm

struct DhcmEncoder::Buffers {
  std::vector<std::uint8_t> occurs;    // by reading
  std::vector<std::uint16_t> rank_of;  // by reading
  std::vector<std::uint16_t> row;
  dhcm::ValueTable values;
  dhcm::EventCoder coder;
  dhcm::Histograms histograms;
  dhcm::EncodeTables tables;
  dhcm::StripCoder strips;

  Bytes encode(const DepthFrame& frame, const BlockMask* mask, DhcmMode mode,
               DhcmPixels pixels = DhcmPixels::kCounts);

 private:
  void collect_strips(const DepthFrame& frame, const BlockMask* mask, bool ranked);
  Bytes write_strips(const dhcm::Header& header, bool ranked);
  Bytes write_events(const dhcm::Header& header, bool ranked);
  void take_row(const DepthFrame& frame, int v, bool ranked, std::uint16_t* to) const;
  bool rank_values(const DepthFrame& frame, dhcm::Segments& segments);
  void collect_events(const DepthFrame& frame, dhcm::Segments& segments, bool ranked,
                      const dhcm::DirectContexts& direct);
  static Bytes stored(const DepthFrame& frame, dhcm::Segments& segments, dhcm::Header header);
};

namespace {

// Whether eight pixels have none; such are mostly many together.
bool no_readings(const std::uint16_t* eight) {
  std::uint64_t halves[2];
  std::memcpy(halves, eight, sizeof(halves));
  return (halves[0] | halves[1]) == 0;
}

}  // namespace

bool DhcmEncoder::Buffers::rank_values(const DepthFrame& frame, dhcm::Segments& segments) {
  occurs.assign(65536, 0);
  std::uint8_t* const marks = occurs.data();
  for (int v = 0; v < frame.height(); ++v) {
    const auto* in = frame.counts.ptr<std::uint16_t>(v);
    for (const dhcm::Segment& segment : segments.of_row(v)) {
      int u = segment.begin;
      for (; u + dhcm::kLanes <= segment.end; u += dhcm::kLanes) {
        if (no_readings(in + u)) continue;
        for (int i = 0; i < dhcm::kLanes; ++i) marks[in[u + i]] = 1;
      }
      for (; u < segment.end; ++u) marks[in[u]] = 1;
    }
  }
  values.collect(occurs);
  if (!values.pays(segments.pixels())) return false;
  // What does not occur keeps what it had: nobody asks for it.
  rank_of.resize(65536, 0);
  std::uint16_t rank = 0;
  for (const std::uint16_t value : values.values()) rank_of[value] = ++rank;
  return true;
}

// Ranks or readings of a row; the buffer is longer than that.
void DhcmEncoder::Buffers::take_row(const DepthFrame& frame, int v, bool ranked,
                                    std::uint16_t* to) const {
  const auto* in = frame.counts.ptr<std::uint16_t>(v);
  const auto width = static_cast<std::size_t>(frame.width());
  if (!ranked) {
    std::copy(in, in + width, to);
    return;
  }
  const std::uint16_t* const ranks = rank_of.data();
  std::size_t u = 0;
  for (; u + dhcm::kLanes <= width; u += dhcm::kLanes) {
    if (no_readings(in + u)) {
      std::fill_n(to + u, dhcm::kLanes, std::uint16_t{0});
    } else {
      for (std::size_t i = 0; i < dhcm::kLanes; ++i) to[u + i] = ranks[in[u + i]];
    }
  }
  for (; u < width; ++u) to[u] = ranks[in[u]];
}

void DhcmEncoder::Buffers::collect_events(const DepthFrame& frame, dhcm::Segments& segments,
                                          bool ranked, const dhcm::DirectContexts& direct) {
  row.assign(static_cast<std::size_t>(frame.width() + dhcm::kLanes), 0);
  coder.begin(frame.width(), direct);
  for (int v = 0; v < frame.height(); ++v) {
    take_row(frame, v, ranked, row.data());
    coder.row(row.data(), segments.of_row(v));
  }
  coder.finish(histograms);
}

Bytes DhcmEncoder::Buffers::stored(const DepthFrame& frame, dhcm::Segments& segments,
                                   dhcm::Header header) {
  header.body = dhcm::Body::kStored;
  Bytes out;
  dhcm::begin(header, out);
  out.reserve(out.size() + 2 * segments.pixels() + 4);
  for (int v = 0; v < frame.height(); ++v) {
    const auto* in = frame.counts.ptr<std::uint16_t>(v);
    for (const dhcm::Segment& segment : segments.of_row(v)) {
      for (int u = segment.begin; u < segment.end; ++u) {
        out.push_back(static_cast<std::uint8_t>(in[u]));
        out.push_back(static_cast<std::uint8_t>(in[u] >> 8));
      }
    }
  }
  dhcm::finish(out);
  return out;
}

void DhcmEncoder::Buffers::collect_strips(const DepthFrame& frame, const BlockMask* mask,
                                          bool ranked) {
  const BlockGrid grid(frame.width(), frame.height());
  const std::size_t stride = static_cast<std::size_t>(grid.columns) * dhcm::kLanes;
  row.assign(stride * dhcm::kStripRows, 0);
  strips.begin(grid, mask);
  for (int strip = 0; strip < grid.rows; ++strip) {
    const int first = strip * dhcm::kStripRows;
    const int rows = std::min(dhcm::kStripRows, frame.height() - first);
    for (int k = 0; k < rows; ++k) {
      take_row(frame, first + k, ranked, row.data() + static_cast<std::size_t>(k) * stride);
    }
    strips.strip(row.data(), stride, strip);
  }
}

Bytes DhcmEncoder::Buffers::encode(const DepthFrame& frame, const BlockMask* mask, DhcmMode mode,
                                   DhcmPixels pixels) {
  dhcm::Segments segments(BlockGrid(frame.width(), frame.height()), mask);
  const bool small = mode == DhcmMode::kSmall;
  const dhcm::Header header = {small ? dhcm::Body::kEvents : dhcm::Body::kStrips,
                               mode,
                               pixels,
                               mask != nullptr,
                               frame.width(),
                               frame.height(),
                               frame.unit};
  const bool ranked = rank_values(frame, segments);
  Bytes out;
  if (small) {
    collect_events(frame, segments, ranked, {});
    out = write_events(header, ranked);
    collect_events(frame, segments, ranked, coder.better_direct(histograms));
    Bytes other = write_events(header, ranked);
    if (other.size() < out.size()) out = std::move(other);
  } else {
    collect_strips(frame, mask, ranked);
    out = write_strips(header, ranked);
  }
  if (out.size() > 2 * segments.pixels() + 32) return stored(frame, segments, header);
  dhcm::finish(out);
  return out;
}

Bytes DhcmEncoder::Buffers::write_events(const dhcm::Header& header, bool ranked) {
  Bytes out;
  dhcm::begin(header, out);
  if (coder.event_count() == 0) return out;
  dhcm::BitWriter bits(out);
  bits.put(ranked ? 1 : 0, 1);
  if (ranked) values.write(bits);
  dhcm::write_tables(histograms.data(), dhcm::kTables, bits, tables.data());
  dhcm::write_events(coder, tables, bits);
  bits.finish();
  return out;
}

Bytes DhcmEncoder::Buffers::write_strips(const dhcm::Header& header, bool ranked) {
  Bytes out;
  dhcm::begin(header, out);
  if (strips.empty()) return out;
  const std::size_t sizes_at = out.size();
  out.resize(sizes_at + 4 * dhcm::kStripStreams);
  dhcm::BitWriter bits(out);
  bits.put(ranked ? 1 : 0, 1);
  if (ranked) values.write(bits);
  strips.write(header.mode == DhcmMode::kFast, bits);
  bits.finish();
  for (std::size_t s = 0; s < dhcm::kStripStreams; ++s) {
    const ByteView stream = strips.stream(s);
    for (std::size_t i = 0; i < 4; ++i) {
      out[sizes_at + 4 * s + i] = static_cast<std::uint8_t>(stream.size >> (8 * i));
    }
    out.insert(out.end(), stream.data, stream.data + stream.size);
  }
  return out;
}

DhcmEncoder::DhcmEncoder(DhcmMode mode) : buffers_(std::make_unique<Buffers>()), mode_(mode) {
}
DhcmEncoder::~DhcmEncoder() = default;

Bytes DhcmEncoder::encode(const DepthFrame& frame) {
  return buffers_->encode(frame, nullptr, mode_);
}

Bytes DhcmEncoder::encode(const DepthFrame& frame, const BlockMask& blocks) {
  return buffers_->encode(frame, &blocks, mode_);
}

Result<Bytes> DhcmEncoder::encode_float(const cv::Mat& metres, double step) {
  if (metres.type() != CV_32FC1) return Error{"depth image is not 32FC1"};
  if (metres.empty() || metres.cols > kMaxImageSide || metres.rows > kMaxImageSide) {
    return Error{"depth image has an impossible size"};
  }
  if (!std::isfinite(step) || step < 0.0)
    return Error{"quantisation step is negative or no number"};
  if (step > 0.0) {
    const Result<DepthFrame> frame = dhcm::quantise(metres, step);
    if (!frame) return Error{frame.reason()};
    return buffers_->encode(*frame, nullptr, mode_, DhcmPixels::kQuantisedFloat);
  }
  return dhcm::pack_float(metres, mode_, [this](const DepthFrame& plane) { return encode(plane); });
}

}  // namespace rprr
