// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include "dhcm/huffman.hpp"
#include "dhcm/model.hpp"

namespace rprr::dhcm {

/// A context's residuals and its runs have a table each: first all of residuals, then all of runs.
constexpr int kTables = 2 * kContexts;
constexpr int run_table(int context) {
  return kContexts + context;
}

using Histograms = std::array<Histogram, kTables>;
using EncodeTables = std::array<EncodeTable, kTables>;

/// Bits of a table of its own for these symbols and of their code words.
std::uint64_t coded_bits(const Histogram& histogram);

/// Chooses which of count contexts share a table with their predecessor, writes the tables and
/// hands out the code words.
void write_tables(const Histogram* histograms, int count, BitWriter& bits, EncodeTable* tables);

/// False if the bits are no complete set of tables.
bool read_tables(BitReader& bits, int count, DecodeTable* tables);

}  // namespace rprr::dhcm
