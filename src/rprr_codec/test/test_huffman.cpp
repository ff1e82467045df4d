// SPDX-License-Identifier: BSD-3-Clause
#include "dhcm/huffman.hpp"
#include "rprr_wire/bytes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace rprr::dhcm {
namespace {

double kraft(const CodeLengths& lengths) {
  double sum = 0.0;
  for (const auto length : lengths) sum += length > 0 ? std::exp2(-length) : 0.0;
  return sum;
}

Histogram steep(int symbols) {  // Fibonacci counts make the deepest tree
  Histogram histogram{};
  std::uint32_t a = 1;
  std::uint32_t b = 1;
  for (int i = 0; i < symbols; ++i) {
    histogram[static_cast<std::size_t>(i)] = a;
    const std::uint32_t next = a + b;
    a = b;
    b = next;
  }
  return histogram;
}

TEST(Huffman, LengthsAreACompleteCodeWithinTheLimit) {
  std::mt19937 random(1);
  std::vector<Histogram> histograms;
  for (int symbols = 2; symbols <= kSymbols; ++symbols) {
    histograms.push_back(steep(symbols));
    Histogram histogram{};
    for (int i = 0; i < symbols; ++i) {
      histogram[static_cast<std::size_t>(i)] = 1 + random() % (1u << random() % 20);
    }
    histograms.push_back(histogram);
  }
  for (const Histogram& histogram : histograms) {
    const CodeLengths lengths = code_lengths(histogram);
    EXPECT_EQ(kraft(lengths), 1.0);
    for (std::size_t s = 0; s < kSymbols; ++s) {
      EXPECT_LE(lengths[s], kMaxCodeLength);
      EXPECT_EQ(lengths[s] > 0, histogram[s] > 0);
    }
  }
}

TEST(Huffman, CostIsWithinOneBitOfTheEntropyForEachSymbol) {
  Histogram histogram{};
  for (std::size_t s = 0; s < 20; ++s) histogram[s] = static_cast<std::uint32_t>(100000 >> (s / 2));
  const CodeLengths lengths = code_lengths(histogram);
  double total = 0.0;
  for (const auto count : histogram) total += count;
  double entropy = 0.0;
  double cost = 0.0;
  for (std::size_t s = 0; s < kSymbols; ++s) {
    if (histogram[s] == 0) continue;
    entropy -= histogram[s] / total * std::log2(histogram[s] / total);
    cost += histogram[s] / total * lengths[s];
  }
  EXPECT_LT(cost, entropy + 0.1);
}

TEST(Huffman, WrittenWordsAreReadBack) {
  const CodeLengths lengths = code_lengths(steep(kSymbols));
  const EncodeTable encode(lengths);
  DecodeTable decode;
  ASSERT_TRUE(decode.build(lengths));
  Bytes bytes;
  BitWriter writer(bytes);
  for (const auto& word : encode.words) writer.put(word.code, word.length);
  writer.finish();
  BitReader reader(bytes);
  for (int s = 0; s < kSymbols; ++s) {
    reader.refill();
    const DecodeTable::Entry entry = decode.entries[reader.peek(kMaxCodeLength)];
    reader.skip(entry.length);
    EXPECT_EQ(entry.symbol, s);
  }
  EXPECT_TRUE(reader.finished());
}

TEST(Huffman, OneSymbolTakesNoBits) {
  Histogram histogram{};
  histogram[5] = 1000;
  const CodeLengths lengths = code_lengths(histogram);
  EXPECT_EQ(EncodeTable(lengths).words[5].length, 0);
  DecodeTable decode;
  ASSERT_TRUE(decode.build(lengths));
  EXPECT_EQ(decode.entries[123].symbol, 5);
  EXPECT_EQ(decode.entries[123].length, 0);
}

TEST(Huffman, IncompleteAndOverfullCodesAreRefused) {
  CodeLengths lengths{};
  lengths[0] = lengths[1] = 2;
  DecodeTable decode;
  EXPECT_FALSE(decode.build(lengths));
  lengths[0] = lengths[1] = lengths[2] = 1;
  EXPECT_FALSE(decode.build(lengths));
  CodeLengths lonely{};
  lonely[3] = 4;
  EXPECT_FALSE(decode.build(lonely));
}

TEST(Huffman, ListsOfLengthsComeBackAndRandomBitsAreNoHarm) {
  std::mt19937 random(2);
  for (int trial = 0; trial < 500; ++trial) {
    Histogram histogram{};
    for (auto& count : histogram) count = random() % 3 == 0 ? random() % 5000 : 0;
    const CodeLengths lengths = code_lengths(histogram);
    Bytes bytes;
    BitWriter writer(bytes);
    write_lengths(lengths, writer);
    writer.finish();
    EXPECT_EQ(bytes.size(), static_cast<std::size_t>(list_bits(lengths) + 7) / 8);
    BitReader reader(bytes);
    CodeLengths back;
    ASSERT_TRUE(read_lengths(reader, back));
    EXPECT_EQ(back, lengths);
    for (auto& byte : bytes) byte = static_cast<std::uint8_t>(random());
    BitReader noise(bytes);
    if (read_lengths(noise, back)) {
      DecodeTable table;
      table.build(back);
    }
  }
}

}  // namespace
}  // namespace rprr::dhcm
