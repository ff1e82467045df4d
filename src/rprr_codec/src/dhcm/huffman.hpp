// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <type_traits>

#include "dhcm/bit_io.hpp"
#include "dhcm/token.hpp"

namespace rprr::dhcm {

/// Longest code word, by the size of the alphabet: one lookup decodes any symbol.
template <std::size_t kSize>
constexpr int kLongestWord = kSize <= 64 ? 10 : 11;

template <std::size_t kSize>
using HistogramOf = std::array<std::uint32_t, kSize>;
/// Bits of each symbol's code word, 0 for symbols that do not occur. A table of one symbol states
/// length 1, but its code word has no bits.
template <std::size_t kSize>
using CodeLengthsOf = std::array<std::uint8_t, kSize>;

/// Optimal lengths within kLongestWord but for a small loss where that limit binds.
template <std::size_t kSize>
CodeLengthsOf<kSize> code_lengths(const HistogramOf<kSize>& histogram);

/// Code words of one canonical table, ready to be written least significant bit first.
template <std::size_t kSize>
struct EncodeTableOf {
  struct Word {
    std::uint16_t code = 0;
    std::uint8_t length = 0;
  };
  std::array<Word, kSize> words;

  explicit EncodeTableOf(const CodeLengthsOf<kSize>& lengths = {});
};

/// One lookup by the next kLongestWord bits.
template <std::size_t kSize>
struct DecodeTableOf {
  using Symbol = std::conditional_t<kSize <= 256, std::uint8_t, std::uint16_t>;
  struct Entry {
    Symbol symbol;
    std::uint8_t length;
  };
  std::array<Entry, 1u << kLongestWord<kSize>> entries;

  /// False if the lengths are no complete code: then the table is not usable. An empty table
  /// (nothing occurs) is made to decode as symbol 0 with no bits.
  bool build(const CodeLengthsOf<kSize>& lengths);
};

/// Bits that write_lengths takes.
template <std::size_t kSize>
int list_bits(const CodeLengthsOf<kSize>& lengths);
/// Lengths as bits, see doc/dhcm.md ("Code lengths").
template <std::size_t kSize>
void write_lengths(const CodeLengthsOf<kSize>& lengths, BitWriter& bits);
/// False if the bits are no such list.
template <std::size_t kSize>
bool read_lengths(BitReader& bits, CodeLengthsOf<kSize>& lengths);

// All of these exist for the alphabets below only (huffman.cpp).

/// Numbers (token.hpp).
constexpr int kMaxCodeLength = kLongestWord<kSymbols>;
using Histogram = HistogramOf<kSymbols>;
using CodeLengths = CodeLengthsOf<kSymbols>;
using EncodeTable = EncodeTableOf<kSymbols>;
using DecodeTable = DecodeTableOf<kSymbols>;

/// Sets of eight pixels, one symbol more.
constexpr std::size_t kSetSymbols = 257;
using SetHistogram = HistogramOf<kSetSymbols>;
using SetLengths = CodeLengthsOf<kSetSymbols>;
using SetEncodeTable = EncodeTableOf<kSetSymbols>;
using SetDecodeTable = DecodeTableOf<kSetSymbols>;

}  // namespace rprr::dhcm
