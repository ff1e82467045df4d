// SPDX-License-Identifier: BSD-3-Clause
#include "dhcm/bit_io.hpp"
#include "rprr_wire/bytes.hpp"

#include <gtest/gtest.h>

#include <random>

namespace rprr::dhcm {
namespace {

TEST(BitIo, WhatIsPutIsGotAndTheEndIsKnown) {
  std::mt19937 random(1);
  for (int trial = 0; trial < 300; ++trial) {
    std::vector<std::pair<std::uint32_t, int>> numbers;
    Bytes bytes;
    BitWriter writer(bytes);
    for (std::uint32_t i = 0; i < 1 + random() % 60; ++i) {
      const int count = static_cast<int>(random() % 33);
      const auto value = static_cast<std::uint32_t>(random() & ((std::uint64_t{1} << count) - 1));
      numbers.emplace_back(value, count);
      writer.put(value, count);
    }
    writer.finish();
    BitReader reader(bytes);
    for (const auto& [value, count] : numbers) ASSERT_EQ(reader.get(count), value);
    EXPECT_TRUE(reader.finished());
    EXPECT_FALSE(reader.overrun());
    reader.get(8);
    EXPECT_TRUE(reader.overrun());
    EXPECT_FALSE(reader.finished());
  }
}

TEST(BitIo, PastTheEndThereAreZeros) {
  const Bytes bytes = {0xFF, 0xFF};
  BitReader reader(bytes);
  EXPECT_EQ(reader.get(16), 0xFFFFu);
  EXPECT_FALSE(reader.overrun());
  for (int i = 0; i < 100; ++i) EXPECT_EQ(reader.get(32), 0u);
  EXPECT_TRUE(reader.overrun());
}

TEST(BitIo, LeftOverBytesAreNoticed) {
  const Bytes bytes(20, 0);
  BitReader reader(bytes);
  for (int i = 0; i < 19; ++i) {
    EXPECT_FALSE(reader.finished()) << i;
    reader.get(8);
  }
  reader.get(1);
  EXPECT_TRUE(reader.finished());
}

TEST(BitIo, BothWritersWriteTheSame) {
  std::mt19937 random(9);
  for (int trial = 0; trial < 100; ++trial) {
    Bytes with_branches;
    BitWriter writer(with_branches);
    Bytes room(4 * 300 + 8, 0xAA);
    PlainBitWriter plain(room.data());
    for (int i = 0; i < 300; ++i) {
      const int count = static_cast<int>(random() % 29);
      const std::uint32_t value = random() & ((1u << count) - 1u);
      writer.put(value, count);
      plain.put(value, count);
    }
    writer.finish();
    room.resize(static_cast<std::size_t>(plain.end() - room.data()));
    EXPECT_EQ(room, with_branches);
  }
}

}  // namespace
}  // namespace rprr::dhcm
