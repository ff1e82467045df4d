// SPDX-License-Identifier: BSD-3-Clause
#include "dhcm/body_decoder.hpp"
#include "rprr_geometry/block_mask.hpp"
#include "rprr_wire/bytes.hpp"

#include <algorithm>

namespace rprr::dhcm {
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

bool read_stored(ByteView body, Segments& segments, const CountsTarget& counts) {
  if (body.size != 2 * segments.pixels()) return false;
  const std::uint8_t* at = body.data;
  for (int v = 0; v < counts.height; ++v) {
    std::uint16_t* const out = counts.row(v);
    for (const Segment& segment : segments.of_row(v)) {
      for (int u = segment.begin; u < segment.end; ++u, at += 2) {
        out[u] = static_cast<std::uint16_t>(at[0] | at[1] << 8);
      }
    }
  }
  return true;
}

}  // namespace

bool BodyDecoder::decode(Body kind, ByteView body, const BlockMask* mask,
                         const CountsTarget& counts) {
  Segments segments(BlockGrid(counts.width, counts.height), mask);
  if (kind == Body::kStored) return read_stored(body, segments, counts);
  if (segments.pixels() == 0) return body.size == 0;
  return kind == Body::kStrips ? decode_strips(body, mask, counts)
                               : decode_events(body, mask, counts);
}

bool BodyDecoder::read_values(BitReader& bits) {
  ranked_ = bits.get(1) != 0;
  largest_ = 65535;
  if (!ranked_) return true;
  if (!values_.read(bits)) return false;
  largest_ = static_cast<std::uint16_t>(values_.values().size());
  lookup_.assign(1, 0);
  lookup_.insert(lookup_.end(), values_.values().begin(), values_.values().end());
  // A guess lies between two ranks that were checked, as signed numbers; where some are negative
  // that is any number at all.
  if (lookup_.size() > 32768) lookup_.resize(65536, 0);
  return true;
}

bool BodyDecoder::decode_events(ByteView body, const BlockMask* mask, const CountsTarget& counts) {
  BitReader bits(body);
  tables_.resize(kTables);
  if (!read_values(bits) || !read_tables(bits, kTables, tables_.data())) return false;
  joint_.resize(kContexts);
  for (std::size_t c = 0; c < kContexts; ++c) {
    join_tables(tables_[c], tables_[kContexts + c], joint_[c]);
  }
  surface_.reset(counts.width);
  Segments segments(BlockGrid(counts.width, counts.height), mask);
  EventReader reader(bits, tables_, joint_, largest_, counts.width);
  for (int v = 0; v < counts.height; ++v) {
    const auto& row = segments.of_row(v);
    reader.row(row, surface_);
    if (bits.overrun() || !reader.good()) return false;
    write_row(surface_, row, lookup_, ranked_, counts.row(v));
  }
  return bits.finished();
}

bool BodyDecoder::decode_strips(ByteView body, const BlockMask* mask, const CountsTarget& counts) {
  ByteReader sizes(body);
  std::array<std::size_t, kStripStreams> lengths{};
  std::size_t all = 0;
  for (std::size_t& length : lengths) all += length = sizes.get<std::uint32_t>();
  if (!sizes.ok() || all > sizes.left()) return false;
  BitReader head(sizes.get_view(sizes.left() - all));
  if (!read_values(head) || !strip_tables_.read(head) || !head.finished()) return false;
  StripStreams streams;
  for (std::size_t s = 0; s < streams.size(); ++s) {
    streams[s] = BitReader(sizes.get_view(lengths[s]));
  }
  const BlockGrid grid(counts.width, counts.height);
  StripReader reader(grid, mask, largest_);
  for (int strip = 0; strip < grid.rows; ++strip) {
    const StripTarget target = {counts.row(strip * kStripRows), counts.stride,
                                ranked_ ? lookup_.data() : nullptr};
    if (!reader.strip(strip, strip_tables_, streams, target)) return false;
    for (const BitReader& stream : streams) {
      if (stream.overrun()) return false;
    }
  }
  return std::all_of(streams.begin(), streams.end(),
                     [](const BitReader& stream) { return stream.finished(); });
}

}  // namespace rprr::dhcm
