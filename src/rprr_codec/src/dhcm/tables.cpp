// SPDX-License-Identifier: BSD-3-Clause
#include "dhcm/tables.hpp"

namespace rprr::dhcm {
namespace {

struct Group {
  Histogram histogram{};
  CodeLengths lengths{};
  std::uint64_t bits = 0;  // of the table and of all that it codes

  explicit Group(const Histogram& counts) : histogram(counts), lengths(code_lengths(counts)) {
    bits = static_cast<std::uint64_t>(list_bits(lengths));
    std::uint64_t words = 0;
    int used = 0;
    for (std::size_t symbol = 0; symbol < kSymbols; ++symbol) {
      words += std::uint64_t{histogram[symbol]} * lengths[symbol];
      used += histogram[symbol] > 0 ? 1 : 0;
    }
    if (used > 1) bits += words;
  }
};

Group joined(const Group& group, const Histogram& other) {
  Histogram sum = group.histogram;
  for (std::size_t symbol = 0; symbol < kSymbols; ++symbol) sum[symbol] += other[symbol];
  return Group(sum);
}

void write_group(const Group& group, int first, int end, BitWriter& bits, EncodeTable* tables) {
  const EncodeTable table(group.lengths);
  for (int t = first; t < end; ++t) {
    bits.put(t == first ? 0 : 1, 1);
    if (t == first) write_lengths(group.lengths, bits);
    tables[t] = table;
  }
}

}  // namespace

std::uint64_t coded_bits(const Histogram& histogram) {
  return Group(histogram).bits;
}

void write_tables(const Histogram* histograms, int count, BitWriter& bits, EncodeTable* tables) {
  int first = 0;
  Group group(histograms[0]);
  for (int t = 1; t < count; ++t) {
    const Group own(histograms[t]);
    Group both = joined(group, own.histogram);
    if (both.bits <= group.bits + own.bits) {
      group = both;
    } else {
      write_group(group, first, t, bits, tables);
      group = own;
      first = t;
    }
  }
  write_group(group, first, count, bits, tables);
}

bool read_tables(BitReader& bits, int count, DecodeTable* tables) {
  for (int t = 0; t < count; ++t) {
    const bool shared = bits.get(1) != 0;
    if (shared && t == 0) return false;
    if (shared) {
      tables[t] = tables[t - 1];
      continue;
    }
    CodeLengths lengths;
    if (!read_lengths(bits, lengths) || !tables[t].build(lengths)) return false;
  }
  return true;
}

}  // namespace rprr::dhcm
