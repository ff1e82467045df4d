// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include "dhcm/huffman.hpp"
#include "dhcm/model.hpp"

namespace rprr::dhcm {

using Histograms = std::array<Histogram, kTables>;
using EncodeTables = std::array<EncodeTable, kTables>;
using DecodeTables = std::array<DecodeTable, kTables>;

/// Chooses which contexts share a table with their predecessor, writes the tables and hands out the
/// code words.
void write_tables(const Histograms& histograms, BitWriter& bits, EncodeTables& tables);

/// False if the bits are no complete set of tables.
bool read_tables(BitReader& bits, DecodeTables& tables);

}  // namespace rprr::dhcm
