// SPDX-License-Identifier: BSD-3-Clause
#include "dhcm/huffman.hpp"

#include <algorithm>
#include <numeric>
#include <vector>

namespace rprr::dhcm {
namespace {

constexpr int kFirstLength = 2;  // what the list of lengths starts from
template <std::size_t kSize>
constexpr std::uint32_t kKraftOne = 1u << kLongestWord<kSize>;

template <std::size_t kSize>
std::uint32_t kraft_sum(const CodeLengthsOf<kSize>& lengths) {
  std::uint32_t sum = 0;
  for (const std::uint8_t length : lengths) {
    if (length > 0) sum += kKraftOne<kSize> >> length;
  }
  return sum;
}

// Moffat and Katajainen's in-place calculation: sorted counts in, lengths in the same order out.
void minimum_redundancy(std::uint32_t* a, int n) {
  int root = 0;
  int leaf = 2;
  a[0] += a[1];
  for (int next = 1; next < n - 1; ++next) {
    if (leaf >= n || a[root] < a[leaf]) {
      a[next] = a[root];
      a[root++] = static_cast<std::uint32_t>(next);
    } else {
      a[next] = a[leaf++];
    }
    if (leaf >= n || (root < next && a[root] < a[leaf])) {
      a[next] += a[root];
      a[root++] = static_cast<std::uint32_t>(next);
    } else {
      a[next] += a[leaf++];
    }
  }
  a[n - 2] = 0;
  for (int next = n - 3; next >= 0; --next) a[next] = a[a[next]] + 1;
  int available = 1;
  int used = 0;
  std::uint32_t depth = 0;
  root = n - 2;
  int next = n - 1;
  while (available > 0) {
    while (root >= 0 && a[root] == depth) {
      ++used;
      --root;
    }
    while (available > used) {
      a[next--] = depth;
      --available;
    }
    available = 2 * used;
    ++depth;
    used = 0;
  }
}

// Shortens the code space that too long words were cut to: lengthens the rarest shorter words until
// the words fit, then gives back what is left over to the most frequent that can take it.
template <std::size_t kSize>
void limit_lengths(const std::array<std::uint16_t, kSize>& rarest_first, int count,
                   CodeLengthsOf<kSize>& lengths) {
  constexpr int kLongest = kLongestWord<kSize>;
  constexpr std::uint32_t kOne = kKraftOne<kSize>;
  for (auto& length : lengths) length = std::min<std::uint8_t>(length, kLongest);
  std::uint32_t sum = kraft_sum(lengths);
  for (int i = 0; i < count && sum > kOne;) {
    auto& length = lengths[rarest_first[static_cast<std::size_t>(i)]];
    if (length < kLongest) {
      ++length;
      sum -= kOne >> length;
    } else {
      ++i;
    }
  }
  for (int i = count - 1; i >= 0; --i) {
    auto& length = lengths[rarest_first[static_cast<std::size_t>(i)]];
    while (length > 1 && sum + (kOne >> length) <= kOne) {
      sum += kOne >> length;
      --length;
    }
  }
}

std::uint32_t reversed(std::uint32_t code, int length) {
  std::uint32_t out = 0;
  for (int i = 0; i < length; ++i) out |= (code >> i & 1u) << (length - 1 - i);
  return out;
}

// Canonical code words: shorter first, and by symbol within a length.
template <std::size_t kSize, typename Visit>
void for_each_word(const CodeLengthsOf<kSize>& lengths, const Visit& visit) {
  std::uint32_t code = 0;
  for (int length = 1; length <= kLongestWord<kSize>; ++length) {
    for (std::size_t symbol = 0; symbol < kSize; ++symbol) {
      if (lengths[symbol] != length) continue;
      visit(symbol, reversed(code, length), length);
      ++code;
    }
    code <<= 1;
  }
}

template <std::size_t kSize>
int used_symbols(const CodeLengthsOf<kSize>& lengths) {
  return static_cast<int>(std::count_if(lengths.begin(), lengths.end(),
                                        [](std::uint8_t length) { return length > 0; }));
}

}  // namespace

template <std::size_t kSize>
CodeLengthsOf<kSize> code_lengths(const HistogramOf<kSize>& histogram) {
  std::array<std::uint16_t, kSize> order{};
  std::size_t count = 0;
  for (std::size_t symbol = 0; symbol < kSize; ++symbol) {
    if (histogram[symbol] > 0) order[count++] = static_cast<std::uint16_t>(symbol);
  }
  CodeLengthsOf<kSize> lengths{};
  if (count == 0) return lengths;
  if (count == 1) {
    lengths[order[0]] = 1;
    return lengths;
  }
  std::stable_sort(order.begin(), order.begin() + count,
                   [&](std::uint16_t a, std::uint16_t b) { return histogram[a] < histogram[b]; });
  std::array<std::uint32_t, kSize> work{};
  for (std::size_t i = 0; i < count; ++i) work[i] = histogram[order[i]];
  minimum_redundancy(work.data(), static_cast<int>(count));
  for (std::size_t i = 0; i < count; ++i) {
    lengths[order[i]] = static_cast<std::uint8_t>(std::min(work[i], 255u));
  }
  limit_lengths(order, static_cast<int>(count), lengths);
  return lengths;
}

template <std::size_t kSize>
EncodeTableOf<kSize>::EncodeTableOf(const CodeLengthsOf<kSize>& lengths) {
  if (used_symbols(lengths) <= 1) return;
  for_each_word(lengths, [&](std::size_t symbol, std::uint32_t code, int length) {
    words[symbol] = {static_cast<std::uint16_t>(code), static_cast<std::uint8_t>(length)};
  });
}

template <std::size_t kSize>
bool DecodeTableOf<kSize>::build(const CodeLengthsOf<kSize>& lengths) {
  const int used = used_symbols(lengths);
  if (used <= 1) {
    Symbol symbol = 0;
    for (std::size_t s = 0; s < kSize; ++s) {
      if (lengths[s] > 1) return false;
      if (lengths[s] == 1) symbol = static_cast<Symbol>(s);
    }
    entries.fill({symbol, 0});
    return true;
  }
  if (kraft_sum(lengths) != kKraftOne<kSize>) return false;
  for_each_word(lengths, [&](std::size_t symbol, std::uint32_t code, int length) {
    const Entry entry = {static_cast<Symbol>(symbol), static_cast<std::uint8_t>(length)};
    for (std::uint32_t i = code; i < kKraftOne<kSize>; i += 1u << length) entries[i] = entry;
  });
  return true;
}

namespace {

// Bits of the number that says how many lengths are listed.
template <std::size_t kSize>
constexpr int kCountBits = kSize < 64 ? 6 : 9;

// Lengths are listed up to the last symbol that occurs. They mostly stay or grow by one from symbol
// to symbol, which takes one or two bits: 0 as before, 10 one more, 110 one less, 1110 does not
// occur, 1111 and the length in four bits; "before" is the last symbol that occurs. Behind a symbol
// that does not occur stands one bit more: whether the next one does.
template <std::size_t kSize, typename Put>
void list_lengths(const CodeLengthsOf<kSize>& lengths, const Put& put) {
  std::size_t last = kSize;
  while (last > 0 && lengths[last - 1] == 0) --last;
  put(static_cast<std::uint32_t>(last), kCountBits<kSize>);
  int before = kFirstLength;
  bool in_gap = false;
  for (std::size_t i = 0; i < last; ++i) {
    const int length = lengths[i];
    if (in_gap) put(length != 0 ? 1 : 0, 1);
    if (length == 0) {
      if (!in_gap) put(0b0111, 4);
      in_gap = true;
      continue;
    }
    if (length == before) {
      put(0b0, 1);
    } else if (length == before + 1) {
      put(0b01, 2);
    } else if (length == before - 1) {
      put(0b011, 3);
    } else {
      put(0b1111 | static_cast<std::uint32_t>(length) << 4, 8);
    }
    before = length;
    in_gap = false;
  }
}

// A length in terms of the one before, 0 for a symbol that does not occur, or -1 where the bits
// state no possible length.
int read_length(BitReader& bits, int before, int longest) {
  int length = before;
  if (bits.get(1) != 0) {
    if (bits.get(1) == 0) {
      length = before + 1;
    } else if (bits.get(1) == 0) {
      length = before - 1;
    } else if (bits.get(1) == 0) {
      return 0;
    } else {
      length = static_cast<int>(bits.get(4));
    }
  }
  return length >= 1 && length <= longest ? length : -1;
}

}  // namespace

template <std::size_t kSize>
int list_bits(const CodeLengthsOf<kSize>& lengths) {
  int sum = 0;
  list_lengths(lengths, [&](std::uint32_t, int count) { sum += count; });
  return sum;
}

template <std::size_t kSize>
void write_lengths(const CodeLengthsOf<kSize>& lengths, BitWriter& bits) {
  list_lengths(lengths, [&](std::uint32_t value, int count) { bits.put(value, count); });
}

template <std::size_t kSize>
bool read_lengths(BitReader& bits, CodeLengthsOf<kSize>& lengths) {
  lengths.fill(0);
  const std::uint32_t last = bits.get(kCountBits<kSize>);
  if (last > kSize) return false;
  int before = kFirstLength;
  bool in_gap = false;
  for (std::uint32_t i = 0; i < last; ++i) {
    if (in_gap && bits.get(1) == 0) continue;
    const int length = read_length(bits, before, kLongestWord<kSize>);
    if (length < 0) return false;
    lengths[i] = static_cast<std::uint8_t>(length);
    in_gap = length == 0;
    if (!in_gap) before = length;
  }
  return !bits.overrun();
}

template CodeLengthsOf<kSymbols> code_lengths(const HistogramOf<kSymbols>&);
template struct EncodeTableOf<kSymbols>;
template struct DecodeTableOf<kSymbols>;
template int list_bits(const CodeLengthsOf<kSymbols>&);
template void write_lengths(const CodeLengthsOf<kSymbols>&, BitWriter&);
template bool read_lengths(BitReader&, CodeLengthsOf<kSymbols>&);
template CodeLengthsOf<kSetSymbols> code_lengths(const HistogramOf<kSetSymbols>&);
template struct EncodeTableOf<kSetSymbols>;
template struct DecodeTableOf<kSetSymbols>;
template int list_bits(const CodeLengthsOf<kSetSymbols>&);
template void write_lengths(const CodeLengthsOf<kSetSymbols>&, BitWriter&);
template bool read_lengths(BitReader&, CodeLengthsOf<kSetSymbols>&);

}  // namespace rprr::dhcm
