// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_geometry/block_mask.hpp"
#include "rprr_wire/bytes.hpp"
#include "rprr_wire/mask_wire.hpp"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <random>

namespace rprr {
namespace {

BlockMask blob(const BlockGrid& grid, double radius) {
  BlockMask mask(grid);
  for (int block = 0; block < grid.count(); ++block) {
    const double dc = block % grid.columns - grid.columns * 0.3;
    const double dr = block / grid.columns - grid.rows * 0.6;
    mask.set(block, dc * dc + dr * dr < radius * radius);
  }
  return mask;
}

TEST(BlockMask, RoundTripsAtEverySizeAndDensity) {
  std::mt19937 random(3);
  for (const auto& [width, height] :
       std::vector<std::pair<int, int>>{{640, 480}, {540, 360}, {8, 8}, {3, 900}, {8192, 16}}) {
    for (const double density : {0.0, 0.01, 0.3, 0.9, 1.0}) {
      const BlockGrid grid(width, height);
      BlockMask mask(grid);
      std::bernoulli_distribution coin(density);
      for (int block = 0; block < grid.count(); ++block) mask.set(block, coin(random));
      const Result<BlockMask> back = decode_mask(encode_mask(mask), grid);
      ASSERT_TRUE(back) << back.reason() << " " << width << "x" << height << " " << density;
      EXPECT_TRUE(*back == mask);
    }
  }
}

TEST(BlockMask, ConnectedRegionsTakeAFractionOfTheRawBits) {
  const BlockGrid grid(640, 480);
  EXPECT_LT(encode_mask(blob(grid, 20)).size(), 100u);
  EXPECT_LT(encode_mask(BlockMask(grid)).size(), 12u);
}

TEST(BlockMask, DamageAndOtherSizesAreErrors) {
  const BlockGrid grid(640, 480);
  const Bytes bytes = encode_mask(blob(grid, 15));
  EXPECT_FALSE(decode_mask(bytes, BlockGrid(640, 360)));
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    EXPECT_FALSE(decode_mask(ByteView(bytes).first(size), grid)) << "cut to " << size;
  }
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    Bytes damaged = bytes;
    damaged[i] ^= 0x10;
    EXPECT_FALSE(decode_mask(damaged, grid)) << "byte " << i;
  }
}

TEST(BlockMask, HostileBytesWithAValidChecksumNeverCrash) {
  const BlockGrid grid(640, 480);
  std::mt19937 random(4);
  const Bytes good = encode_mask(blob(grid, 15));
  for (int trial = 0; trial < 2000; ++trial) {
    Bytes bytes(good.begin(), good.end() - 4);
    for (int i = 0; i < 3; ++i)
      bytes[random() % bytes.size()] = static_cast<std::uint8_t>(random());
    if (trial % 3 == 0) bytes.resize(random() % bytes.size());
    seal(bytes);
    const Result<BlockMask> mask = decode_mask(bytes, grid);
    if (mask) {
      EXPECT_EQ(mask->grid().count(), grid.count());
    }
  }
}

TEST(BlockMask, UnionAndImage) {
  const BlockGrid grid(20, 20);
  BlockMask left(grid);
  left.set(0);
  BlockMask right(grid);
  right.set(8);
  left |= right;
  EXPECT_EQ(left.count(), 2);
  const cv::Mat image = left.to_image();
  EXPECT_EQ(cv::countNonZero(image), 64 + 16) << "the last block is 4x4";
}

}  // namespace
}  // namespace rprr
