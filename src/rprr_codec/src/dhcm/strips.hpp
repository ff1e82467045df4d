// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "dhcm/bit_io.hpp"
#include "dhcm/huffman.hpp"
#include "dhcm/lanes.hpp"
#include "rprr_geometry/block_mask.hpp"
#include "rprr_wire/bytes.hpp"

namespace rprr::dhcm {

/// The coder of the modes fast and default. It codes groups of eight pixels, which are a row of a
/// block. One Huffman symbol says which of the eight pixels are not as guessed. One symbol for each
/// of those, in a stream of its own, says what they are (doc/dhcm.md). So nothing that is decoded
/// decides how the next bits are read: a decoder runs two rows at a time without branches that
/// depend on the picture, and rebuilds eight rows at once afterwards.
constexpr int kStripRows = 8;
/// Rows 0, 2, 4, 6 of all strips are one side, rows 1, 3, 5, 7 the other.
constexpr std::size_t kStripSides = 2;
/// Groups of both sides, then residuals of both.
constexpr std::size_t kStripStreams = 2 * kStripSides;
/// The symbol before a group whose pixels without reading are not those of the row above.
constexpr std::size_t kHolesChange = 256;
/// A group has one of three tables: none, some or all of the pixels above have no reading.
constexpr std::size_t kHoleClasses = 3;
inline std::size_t hole_class(std::uint8_t holes) {
  return static_cast<std::size_t>(holes != 0) + static_cast<std::size_t>(holes == 255);
}

/// The places of the bits of a set, the lowest first, and their number.
struct Places {
  std::uint8_t at[kLanes];
};
using PlacesOfSets = std::array<Places, 256>;
using SizesOfSets = std::array<std::uint8_t, 256>;
constexpr PlacesOfSets make_places() {
  PlacesOfSets all{};
  for (unsigned set = 0; set < 256; ++set) {
    unsigned count = 0;
    for (unsigned bit = 0; bit < 8; ++bit) {
      if ((set >> bit & 1u) != 0) all[set].at[count++] = static_cast<std::uint8_t>(bit);
    }
  }
  return all;
}
constexpr SizesOfSets make_sizes() {
  SizesOfSets all{};
  for (unsigned set = 1; set < 256; ++set) {
    all[set] = static_cast<std::uint8_t>(all[set >> 1] + (set & 1u));
  }
  return all;
}
constexpr PlacesOfSets kPlaces = make_places();
constexpr SizesOfSets kSizes = make_sizes();

/// Neighbouring blocks of a strip that are sent, by group column.
struct StripSegment {
  int begin;
  int end;
};
/// The segments of a strip: one for the whole strip, or those of a mask's blocks.
void list_segments(const BlockGrid& grid, const BlockMask* mask, int strip,
                   std::vector<StripSegment>& segments);

/// What encoder and decoder know of the row above: for each column the rank of the last pixel with
/// a reading, or a guess where there was none; and which pixels had no reading.
struct StripSurface {
  std::vector<std::int16_t> fill;   // by column, padded to whole groups
  std::vector<std::uint8_t> holes;  // by group, the first pixel lowest
  std::int16_t last = 0;            // top left pixel of the segment before

  void reset(int columns);
  /// Guesses the surface above the blocks of a segment above which nothing was sent.
  void prepare(const BlockGrid& grid, const BlockMask* mask, int strip,
               const StripSegment& segment);
};

/// First pass of an encoder: strips become symbols.
class StripCoder {
 public:
  void begin(const BlockGrid& grid, const BlockMask* mask);
  /// Ranks (or readings) of a strip, 0 = no reading; rows are kStripRows rows of stride numbers,
  /// which are whole groups.
  void strip(const std::uint16_t* ranks, std::size_t stride, int strip);
  bool empty() const { return sides_[0].group_count == 0; }
  /// Whether almost all groups are as guessed. Each of them still takes a bit here; the coder of
  /// events then makes fewer bytes as fast.
  bool quiet() const;
  /// Second pass, after the last strip: appends the tables to head and makes the streams, first
  /// those of both sides' groups, then those of their residuals. quick: tables are fitted to one
  /// side only, with words for all that may occur on the other side.
  void write(bool quick, BitWriter& head);
  ByteView stream(std::size_t index) const {
    return {streams_[index].bytes.data(), streams_[index].size};
  }

 private:
  struct Side {
    std::vector<std::uint16_t> groups;     // set, class << 8, whether holes change << 10
    std::vector<std::uint8_t> changes;     // of holes
    std::vector<std::uint16_t> residuals;  // modulo 2^16
    // As long as any frame needed so far; what is used of them is counted apart.
    std::size_t group_count = 0;
    std::size_t change_count = 0;
    std::size_t residual_count = 0;
  };
  // As long as any frame needed so far.
  struct Stream {
    Bytes bytes;
    std::size_t size = 0;

    std::uint8_t* room(std::size_t most) {
      if (bytes.size() < most + 8) bytes.resize(most + 8);
      return bytes.data();
    }
    void close(const PlainBitWriter& writer) {
      size = static_cast<std::size_t>(writer.end() - bytes.data());
    }
  };
  // The last one is of holes that change.
  using GroupTables = std::array<SetEncodeTable, kHoleClasses + 1>;
  void compare(const std::uint16_t* ranks, const StripSegment& segment);
  void collect(const StripSegment& segment, Side& side);
  GroupTables write_group_tables(bool half, BitWriter& head) const;
  EncodeTable write_residual_table(bool half, BitWriter& head) const;
  static void write_groups(const Side& side, const GroupTables& tables, Stream& stream);
  static void write_residuals(const Side& side, const EncodeTable& table, Stream& stream);

  BlockGrid grid_;
  const BlockMask* mask_ = nullptr;
  StripSurface surface_;
  std::vector<StripSegment> segments_;
  std::array<Side, kStripSides> sides_;
  // The row that is being coded: surface (one column further), holes, residuals and which count.
  std::vector<std::int16_t> fill_;
  std::vector<std::uint8_t> holes_;
  std::vector<std::int16_t> residual_;
  std::vector<std::uint8_t> missed_;
  std::array<Stream, kStripStreams> streams_;
};

}  // namespace rprr::dhcm
