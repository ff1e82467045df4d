// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <random>

#include "dhcm/values.hpp"
#include "rprr_wire/bytes.hpp"

namespace rprr::dhcm {
namespace {

ValueTable table_of(const std::vector<int>& values) {
  std::vector<std::uint8_t> occurs(65536, 0);
  for (const int value : values) occurs[static_cast<std::size_t>(value)] = 1;
  ValueTable table;
  table.collect(occurs);
  return table;
}

TEST(ValueTable, ComesBack) {
  std::mt19937 random(1);
  std::vector<std::vector<int>> sets = {{1}, {65535}, {1, 65535}, {0, 7}};
  for (int trial = 0; trial < 100; ++trial) {
    std::vector<int> values = {1 + static_cast<int>(random() % 65535)};
    for (std::uint32_t i = 0; i < random() % 400; ++i) {
      values.push_back(static_cast<int>(random() % 65536));
    }
    sets.push_back(values);
  }
  std::vector<int> all;
  for (int value = 0; value < 65536; ++value) all.push_back(value);
  sets.push_back(all);
  for (const auto& set : sets) {
    const ValueTable table = table_of(set);
    Bytes bytes;
    BitWriter writer(bytes);
    table.write(writer);
    writer.finish();
    BitReader reader(bytes);
    ValueTable back;
    ASSERT_TRUE(back.read(reader));
    EXPECT_EQ(back.values(), table.values());
    EXPECT_TRUE(reader.finished());
  }
}

TEST(ValueTable, PaysForFewLevelsAndManyPixelsOnly) {
  std::vector<int> levels;
  for (int i = 1; i <= 270; ++i) levels.push_back(580000 / (1100 - 3 * i));
  EXPECT_TRUE(table_of(levels).pays(300000));
  EXPECT_FALSE(table_of(levels).pays(100));
  std::vector<int> every;
  for (int i = 400; i < 4000; ++i) every.push_back(i);
  EXPECT_FALSE(table_of(every).pays(300000));
  EXPECT_FALSE(table_of({0}).pays(300000));
}

TEST(ValueTable, HostileBitsGiveAscendingValuesOrAnError) {
  std::mt19937 random(2);
  for (int trial = 0; trial < 5000; ++trial) {
    Bytes bytes(4 + random() % 60);
    for (auto& byte : bytes) byte = static_cast<std::uint8_t>(random());
    if (trial % 2 == 0) bytes[1] = 0;  // few values: more often well-formed
    BitReader reader(bytes);
    ValueTable table;
    if (!table.read(reader)) continue;
    for (std::size_t i = 1; i < table.values().size(); ++i) {
      ASSERT_LT(table.values()[i - 1], table.values()[i]);
    }
  }
}

}  // namespace
}  // namespace rprr::dhcm
