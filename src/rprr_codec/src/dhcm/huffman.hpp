// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>

#include "dhcm/bit_io.hpp"
#include "dhcm/token.hpp"

namespace rprr::dhcm {

/// Longest code word: one lookup decodes any symbol.
constexpr int kMaxCodeLength = 10;

using Histogram = std::array<std::uint32_t, kSymbols>;
/// Bits of each symbol's code word, 0 for symbols that do not occur. A table of one symbol states
/// length 1, but its code word has no bits.
using CodeLengths = std::array<std::uint8_t, kSymbols>;

/// Optimal lengths within kMaxCodeLength but for a small loss where that limit binds.
CodeLengths code_lengths(const Histogram& histogram);

/// Code words of one canonical table, ready to be written least significant bit first.
struct EncodeTable {
  struct Word {
    std::uint16_t code = 0;
    std::uint8_t length = 0;
  };
  std::array<Word, kSymbols> words;

  explicit EncodeTable(const CodeLengths& lengths = {});
};

/// One lookup by the next kMaxCodeLength bits.
struct DecodeTable {
  struct Entry {
    std::uint8_t symbol;
    std::uint8_t length;
  };
  std::array<Entry, 1u << kMaxCodeLength> entries;

  /// False if the lengths are no complete code: then the table is not usable. An empty table
  /// (nothing occurs) is made to decode as symbol 0 with no bits.
  bool build(const CodeLengths& lengths);
};

/// Bits that write_lengths takes.
int list_bits(const CodeLengths& lengths);
/// Lengths as bits, see doc/dhcm.md ("Code lengths").
void write_lengths(const CodeLengths& lengths, BitWriter& bits);
/// False if the bits are no such list.
bool read_lengths(BitReader& bits, CodeLengths& lengths);

}  // namespace rprr::dhcm
