// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "dhcm/strips.hpp"
#include "rprr_geometry/block_mask.hpp"

namespace rprr::dhcm {

/// Tables of a payload, ready to decode with.
struct StripTables {
  // symbol << 4 | length of the code word
  using Sets = std::array<std::uint16_t, 1u << kLongestWord<kSetSymbols>>;
  struct Residual {
    std::uint16_t base;   // folded, with the plain bits 0
    std::uint16_t extra;  // as many ones as there are plain bits
    std::uint8_t length;  // of the code word
    std::uint8_t bits;    // of both
    std::uint8_t bad;     // 1 where the symbol is none of a residual
  };

  std::array<Sets, kHoleClasses> groups;
  Sets changes;
  std::array<Residual, 1u << kMaxCodeLength> residuals;
  // Two residuals, where both are found in the same bits.
  struct Pair {
    std::int16_t first;
    std::int16_t second;
    std::uint8_t bits;
    std::uint8_t found;  // 0 or 1
  };
  std::array<Pair, 1u << kMaxCodeLength> pairs;
  bool mostly_pairs;  // worth looking for: two residuals are found in most words

  /// Errors: false if the bits are no tables of strips.
  bool read(BitReader& bits);

 private:
  void find_pairs();
};

using StripStreams = std::array<BitReader, kStripStreams>;

/// Where the decoded pixels of a strip are written.
struct StripTarget {
  std::uint16_t* first;         // its first row
  std::size_t stride;           // from row to row
  const std::uint16_t* values;  // depth of each rank, from rank 0 on; nullptr: ranks are depths
};

/// Reads what StripCoder wrote.
class StripReader {
 public:
  /// largest: ranks above it are refused. From 32768 on nothing is refused, and any rank may come
  /// out.
  StripReader(const BlockGrid& grid, const BlockMask* mask, std::uint16_t largest);
  /// Writes the pixels of a strip that are sent.
  /// Errors: false where a rank or a symbol means nothing. What was written then is arbitrary, as
  /// it is past the end of a stream.
  bool strip(int strip, const StripTables& tables, StripStreams& streams,
             const StripTarget& target);

 private:
  void read_rows(const StripSegment& segment, int row, bool pair, const StripTables& tables,
                 StripStreams& streams);
  void read_residuals(const StripTables& tables, StripStreams& streams);
  void place_holes(const StripSegment& segment, int rows);
  template <bool kHoles>
  std::int16_t rebuild(const StripSegment& part, std::size_t from);
  void check(Lanes lowest, Lanes highest);
  void write(const StripSegment& segment, int rows, const StripTarget& target) const;
  void write_part(const StripSegment& part, std::size_t from, int rows,
                  const StripTarget& target) const;

  BlockGrid grid_;
  const BlockMask* mask_;
  std::uint16_t largest_;
  bool good_ = true;
  StripSurface surface_;
  std::vector<StripSegment> segments_;
  // The segment that is being read. Pixels that are not as guessed, as 8 times the column plus row.
  std::array<std::vector<std::uint16_t>, kStripSides> missed_;
  std::array<std::size_t, kStripSides> missed_count_{};
  std::array<std::vector<std::uint8_t>, kStripRows> holes_;  // of its rows, by group
  std::vector<std::uint8_t> some_;   // pixels of a column without reading in any row
  std::vector<std::uint8_t> every_;  // and in all of them
  std::vector<StripSegment> parts_;  // of the segment, between blocks without any reading
  bool any_holes_ = false;           // in the parts
  // Eight rows side by side, each one column later than the one above, so that what a pixel is
  // predicted from lies before it: pixel (u, k) is number 8 (u + k) + k. First residuals, then
  // ranks.
  std::vector<std::int16_t> skewed_;
  std::vector<std::int16_t> skewed_holes_;  // 0 or -1
};

}  // namespace rprr::dhcm
