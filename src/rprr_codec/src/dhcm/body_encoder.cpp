// SPDX-License-Identifier: BSD-3-Clause
#include "dhcm/body_encoder.hpp"
#include "rprr_geometry/block_mask.hpp"
#include "rprr_wire/bytes.hpp"

#include <algorithm>
#include <cstring>

namespace rprr::dhcm {
namespace {

// Where the mode small tries strips too: elsewhere events are shorter.
constexpr std::size_t kFewPixels = 1u << 16;

// Whether eight pixels have none; such are mostly many together.
bool no_readings(const std::uint16_t* eight) {
  std::uint64_t halves[2];
  std::memcpy(halves, eight, sizeof(halves));
  return (halves[0] | halves[1]) == 0;
}

// Nothing yet is empty.
void keep_shorter(Bytes other, Bytes& body) {
  if (body.empty() || other.size() < body.size()) body = std::move(other);
}

// Second pass.
void write_pixels(const EventCoder& coder, const EncodeTables& tables, BitWriter& bits) {
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

void write_stored(const CountsView& counts, Segments& segments, Bytes& body) {
  body.clear();
  body.reserve(2 * segments.pixels());
  for (int v = 0; v < counts.height; ++v) {
    const std::uint16_t* const in = counts.row(v);
    for (const Segment& segment : segments.of_row(v)) {
      for (int u = segment.begin; u < segment.end; ++u) {
        body.push_back(static_cast<std::uint8_t>(in[u]));
        body.push_back(static_cast<std::uint8_t>(in[u] >> 8));
      }
    }
  }
}

}  // namespace

Body BodyEncoder::encode(const CountsView& counts, const BlockMask* mask, DhcmMode mode,
                         Bytes& body) {
  body.clear();
  Segments segments(BlockGrid(counts.width, counts.height), mask);
  const std::size_t pixels = segments.pixels();
  if (pixels == 0) return Body::kStrips;
  ranked_ = rank_values(counts, segments);
  const bool small = mode == DhcmMode::kSmall;
  if (!small || pixels < kFewPixels) {
    collect_strips(counts, mask);
    if (!strips_.quiet()) write_strips(mode == DhcmMode::kFast, body);
  }
  const std::size_t strips = body.size();
  if (small || body.empty()) {
    collect_events(counts, segments, {});
    keep_shorter(write_events(), body);
  }
  if (small) {
    collect_events(counts, segments, coder_.better_direct(histograms_));
    keep_shorter(write_events(), body);
  }
  if (body.size() <= 2 * pixels + kStoredGain) {
    return body.size() == strips ? Body::kStrips : Body::kEvents;
  }
  write_stored(counts, segments, body);
  return Body::kStored;
}

bool BodyEncoder::rank_values(const CountsView& counts, Segments& segments) {
  occurs_.assign(65536, 0);
  std::uint8_t* const marks = occurs_.data();
  for (int v = 0; v < counts.height; ++v) {
    const std::uint16_t* const in = counts.row(v);
    for (const Segment& segment : segments.of_row(v)) {
      int u = segment.begin;
      for (; u + kLanes <= segment.end; u += kLanes) {
        if (no_readings(in + u)) continue;
        for (int i = 0; i < kLanes; ++i) marks[in[u + i]] = 1;
      }
      for (; u < segment.end; ++u) marks[in[u]] = 1;
    }
  }
  values_.collect(occurs_);
  if (!values_.pays(segments.pixels())) return false;
  // What does not occur keeps what it had: nobody asks for it.
  rank_of_.resize(65536, 0);
  std::uint16_t rank = 0;
  for (const std::uint16_t value : values_.values()) rank_of_[value] = ++rank;
  return true;
}

// Ranks or readings of a row.
void BodyEncoder::take_row(const std::uint16_t* in, int width, std::uint16_t* to) const {
  if (!ranked_) {
    std::copy(in, in + width, to);
    return;
  }
  const std::uint16_t* const ranks = rank_of_.data();
  int u = 0;
  for (; u + kLanes <= width; u += kLanes) {
    if (no_readings(in + u)) {
      std::fill_n(to + u, kLanes, std::uint16_t{0});
    } else {
      for (int i = 0; i < kLanes; ++i) to[u + i] = ranks[in[u + i]];
    }
  }
  for (; u < width; ++u) to[u] = ranks[in[u]];
}

void BodyEncoder::collect_events(const CountsView& counts, Segments& segments,
                                 const DirectContexts& direct) {
  rows_.assign(static_cast<std::size_t>(counts.width + kLanes), 0);
  coder_.begin(counts.width, direct);
  for (int v = 0; v < counts.height; ++v) {
    take_row(counts.row(v), counts.width, rows_.data());
    coder_.row(rows_.data(), segments.of_row(v));
  }
  coder_.finish(histograms_);
}

void BodyEncoder::collect_strips(const CountsView& counts, const BlockMask* mask) {
  const BlockGrid grid(counts.width, counts.height);
  const std::size_t stride = static_cast<std::size_t>(grid.columns) * kLanes;
  rows_.assign(stride * kStripRows, 0);
  strips_.begin(grid, mask);
  for (int strip = 0; strip < grid.rows; ++strip) {
    const int first = strip * kStripRows;
    const int rows = std::min(kStripRows, counts.height - first);
    for (int k = 0; k < rows; ++k) {
      take_row(counts.row(first + k), counts.width,
               rows_.data() + static_cast<std::size_t>(k) * stride);
    }
    strips_.strip(rows_.data(), stride, strip);
  }
}

Bytes BodyEncoder::write_events() {
  Bytes body;
  BitWriter bits(body);
  bits.put(ranked_ ? 1 : 0, 1);
  if (ranked_) values_.write(bits);
  write_tables(histograms_.data(), kTables, bits, tables_.data());
  write_pixels(coder_, tables_, bits);
  bits.finish();
  return body;
}

void BodyEncoder::write_strips(bool quick, Bytes& body) {
  body.resize(4 * kStripStreams);
  BitWriter bits(body);
  bits.put(ranked_ ? 1 : 0, 1);
  if (ranked_) values_.write(bits);
  strips_.write(quick, bits);
  bits.finish();
  for (std::size_t s = 0; s < kStripStreams; ++s) {
    const ByteView stream = strips_.stream(s);
    for (std::size_t i = 0; i < 4; ++i) {
      body[4 * s + i] = static_cast<std::uint8_t>(stream.size >> (8 * i));
    }
    body.insert(body.end(), stream.data, stream.data + stream.size);
  }
}

}  // namespace rprr::dhcm
