// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_wire/bytes.hpp"

#include <gtest/gtest.h>

namespace rprr {
namespace {

TEST(Wire, ValuesComeBackInLittleEndianOrder) {
  ByteWriter writer;
  writer.put<std::uint16_t>(0x1234);
  writer.put<float>(1.5f);
  writer.put<std::int64_t>(-7);
  EXPECT_EQ(writer.bytes()[0], 0x34);
  ByteReader reader(writer.bytes());
  EXPECT_EQ(reader.get<std::uint16_t>(), 0x1234);
  EXPECT_EQ(reader.get<float>(), 1.5f);
  EXPECT_EQ(reader.get<std::int64_t>(), -7);
  EXPECT_TRUE(reader.ok());
  EXPECT_EQ(reader.left(), 0u);
}

TEST(Wire, ReadingPastTheEndGivesZeroAndStaysFailed) {
  const Bytes bytes = {1, 2, 3};
  ByteReader reader(bytes);
  EXPECT_EQ(reader.get<std::uint32_t>(), 0u);
  EXPECT_FALSE(reader.ok());
  EXPECT_EQ(reader.get<std::uint8_t>(), 0u);
  EXPECT_EQ(reader.get_view(1).size, 0u);
}

TEST(Wire, SealFindsEveryFlippedBitAndEveryCut) {
  Bytes bytes = {10, 20, 30, 40, 50};
  seal(bytes);
  EXPECT_EQ(unseal(bytes).size, 5u);
  for (std::size_t bit = 0; bit < bytes.size() * 8; ++bit) {
    Bytes damaged = bytes;
    damaged[bit / 8] = static_cast<std::uint8_t>(damaged[bit / 8] ^ (1u << bit % 8));
    EXPECT_EQ(unseal(damaged).size, 0u) << "bit " << bit;
  }
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    EXPECT_EQ(unseal(ByteView(bytes).first(size)).size, 0u) << "cut to " << size;
  }
}

TEST(Wire, CrcMatchesThePublishedCheckValue) {
  const std::string check = "123456789";
  EXPECT_EQ(crc32({reinterpret_cast<const std::uint8_t*>(check.data()), check.size()}),
            0xCBF43926u);
}

}  // namespace
}  // namespace rprr
