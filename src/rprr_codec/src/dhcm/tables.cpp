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

void write_group(const Group& group, int first, int end, BitWriter& bits, EncodeTables& tables) {
  const EncodeTable table(group.lengths);
  for (int t = first; t < end; ++t) {
    bits.put(t == first ? 0 : 1, 1);
    if (t == first) write_lengths(group.lengths, bits);
    tables[static_cast<std::size_t>(t)] = table;
  }
}

}  // namespace

void write_tables(const Histograms& histograms, BitWriter& bits, EncodeTables& tables) {
  int first = 0;
  Group group(histograms[0]);
  for (int t = 1; t < kTables; ++t) {
    const Group own(histograms[static_cast<std::size_t>(t)]);
    Group both = joined(group, own.histogram);
    if (both.bits <= group.bits + own.bits) {
      group = both;
    } else {
      write_group(group, first, t, bits, tables);
      group = own;
      first = t;
    }
  }
  write_group(group, first, kTables, bits, tables);
}

bool read_tables(BitReader& bits, DecodeTables& tables) {
  for (std::size_t t = 0; t < kTables; ++t) {
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
