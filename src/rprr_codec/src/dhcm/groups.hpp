// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "dhcm/bit_io.hpp"
#include "dhcm/huffman.hpp"
#include "dhcm/lanes.hpp"
#include "rprr_geometry/block_mask.hpp"

namespace rprr::dhcm {

/// The fast coder: eight pixels at a time, which are a row of a block. A group is one Huffman
/// symbol that says how wide its residuals to the row above are, and those residuals in plain bits
/// (doc/dhcm.md).
enum GroupKind : int {
  kSame = 0,   // all as above
  kUpOnly,     // one bit each: as above or one more
  kDownOnly,   // one bit each: as above or one less
  kNarrow,     // 2 to 8 bits each: seven kinds
  kWide = 10,  // 16 bits each
  kGroupKinds
};
/// Twice the kind, and 1 where the pixels without reading are not those of the row above.
constexpr int kGroupSymbols = 2 * kGroupKinds;
constexpr int kGroupContexts = 19;

constexpr std::uint8_t kKindBits[kGroupKinds] = {0, 1, 1, 2, 3, 4, 5, 6, 7, 8, 16};
inline int bits_of_kind(int kind) {
  return kKindBits[kind];
}

/// What a coder knows of the rows above, a group column each.
struct GroupSurface {
  std::vector<std::int16_t> fill;      // by column, padded to whole groups
  std::vector<std::uint8_t> holes;     // bits, the first pixel lowest
  std::vector<std::uint8_t> category;  // of the last kind
  std::vector<std::uint8_t> known;     // the last row of this group was sent
  std::int16_t last = 0;               // the last pixel of the last group sent

  void reset(int columns);
  /// Context of a group, west being whether the one before was sent in this row.
  std::size_t context(std::size_t column, bool west) const {
    if (known[column] == 0) return kGroupContexts - 1;
    const std::size_t left = west ? column - 1 : column;
    if (holes[column] != 0) return holes[column] == 255 && holes[left] == 255 ? 16 : 17;
    return category[column] * 4u + category[left];
  }
};

inline std::uint8_t category_of(int kind) {
  constexpr std::uint8_t kCategories[kGroupKinds] = {0, 1, 1, 2, 3, 3, 3, 3, 3, 3, 3};
  return kCategories[kind];
}

/// First pass: rows of ranks (or readings), 0 = no reading.
class GroupCoder {
 public:
  void begin(const BlockGrid& grid, const BlockMask* mask);
  /// The row's values, with room for kLanes beyond the width.
  void row(const std::uint16_t* ranks, int v);
  bool empty() const { return group_count_ == 0; }
  void count(std::array<Histogram, kGroupContexts>& histograms) const;
  /// Second pass.
  void write(const std::array<EncodeTable, kGroupContexts>& tables, BitWriter& bits) const;

 private:
  struct Group {
    std::uint8_t context;
    std::uint8_t symbol;
    std::uint8_t holes;  // bits that changed
    std::uint8_t unused;
  };
  void group(const std::uint16_t* ranks, std::size_t column, bool west);

  BlockGrid grid_;
  const BlockMask* mask_ = nullptr;
  GroupSurface surface_;
  // As long as any frame needed so far; what is used of them is counted apart.
  std::vector<Group> groups_;
  std::vector<std::array<std::uint16_t, kLanes>> residuals_;  // folded
  std::size_t group_count_ = 0;
  std::size_t residual_count_ = 0;
};

/// Reads what GroupCoder wrote.
class GroupReader {
 public:
  GroupReader(const BlockGrid& grid, const BlockMask* mask, std::uint16_t largest);
  /// A row of readings; values is what ranks stand for, from rank 0, or nullptr. out has room for
  /// whole groups. False where a rank is not in the value table or a symbol means nothing.
  bool row(int v, const std::vector<DecodeTable>& tables, const std::uint16_t* values,
           BitReader& bits, std::uint16_t* out);

 private:
  Lanes residuals(int kind, BitReader& bits);

  BlockGrid grid_;
  const BlockMask* mask_;
  std::uint16_t largest_;
  GroupSurface surface_;
};

}  // namespace rprr::dhcm
