// SPDX-License-Identifier: BSD-3-Clause
#include "../src/float4.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <vector>

namespace rprr {
namespace {

TEST(Float4, RowsBecomeBytesAsSinglePixelsDo) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> values(-300.0f, 600.0f);
  for (int pixels = 1; pixels < 40; ++pixels) {
    std::vector<float> row(static_cast<std::size_t>(3 * pixels + 1));
    for (float& value : row) value = values(random);
    for (std::size_t i = 0; i < row.size(); i += 5) row[i] = std::floor(row[i]) + 0.5f;
    std::vector<std::uint8_t> bytes(static_cast<std::size_t>(3 * pixels));
    to_bytes(row.data(), 3 * pixels, bytes.data());
    for (int u = 0; u < pixels; ++u) {
      std::array<std::uint8_t, 3> single{};
      store_bgr(load_pixel(row.data(), u), single.data());
      for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(bytes[static_cast<std::size_t>(3 * u) + i], single[i])
            << "colour " << i << " of pixel " << u << " of " << pixels << ", "
            << row[static_cast<std::size_t>(3 * u) + i];
      }
    }
  }
}

TEST(Float4, BytesComeBackFromFloats) {
  std::vector<std::uint8_t> bytes(256 * 3), back(bytes.size());
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<std::uint8_t>(7 * i);
  std::vector<float> row(bytes.size() + 1);
  to_floats(bytes.data(), static_cast<int>(bytes.size()), row.data());
  const Float4 pixel = load_pixel(row.data(), 100);
  const Float4 single = load_bgr(bytes.data() + 300);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(pixel[i], single[i]);
  to_bytes(row.data(), static_cast<int>(bytes.size()), back.data());
  EXPECT_EQ(back, bytes);
}

}  // namespace
}  // namespace rprr
