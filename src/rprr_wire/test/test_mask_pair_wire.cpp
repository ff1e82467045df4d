// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_wire/bytes.hpp"
#include "rprr_wire/mask_wire.hpp"

#include <gtest/gtest.h>

#include <random>

namespace rprr {
namespace {

BlockMaskPair random_pair(const BlockGrid& grid, double colour, double depth, unsigned seed) {
  std::mt19937 random(seed);
  std::bernoulli_distribution coloured(colour);
  std::bernoulli_distribution deep(depth);
  BlockMaskPair masks{BlockMask(grid), BlockMask(grid)};
  for (int block = 0; block < grid.count(); ++block) {
    masks.colour.set(block, coloured(random));
    masks.depth.set(block, masks.colour[block] && deep(random));
  }
  return masks;
}

TEST(BlockMaskPair, RoundTripsAtEverySizeAndDensity) {
  for (const auto& [width, height] :
       std::vector<std::pair<int, int>>{{640, 480}, {540, 360}, {8, 8}, {3, 900}, {8192, 16}}) {
    for (const double colour : {0.0, 0.02, 0.5, 1.0}) {
      for (const double depth : {0.0, 0.3, 1.0}) {
        const BlockGrid grid(width, height);
        const BlockMaskPair masks = random_pair(grid, colour, depth, 3);
        const Result<BlockMaskPair> back = decode_mask_pair(encode_mask_pair(masks), grid);
        ASSERT_TRUE(back) << back.reason() << " " << width << "x" << height << " " << colour << " "
                          << depth;
        EXPECT_TRUE(back->colour == masks.colour);
        EXPECT_TRUE(back->depth == masks.depth);
      }
    }
  }
}

TEST(BlockMaskPair, EqualMasksCostOneMask) {
  const BlockGrid grid(640, 480);
  const BlockMaskPair masks = random_pair(grid, 0.3, 1.0, 4);
  EXPECT_EQ(encode_mask_pair(masks), encode_mask(masks.colour));
}

TEST(BlockMaskPair, NoDepthCostsAByteMoreThanOneMask) {
  const BlockMaskPair masks = random_pair(BlockGrid(640, 480), 0.3, 0.0, 4);
  EXPECT_LE(encode_mask_pair(masks).size(), encode_mask(masks.colour).size() + 1);
}

TEST(BlockMaskPair, DepthOutsideOfColourIsLeftOut) {
  const BlockGrid grid(64, 64);
  BlockMaskPair masks = random_pair(grid, 0.5, 0.5, 5);
  const BlockMaskPair good = masks;
  for (int block = 0; block < grid.count(); ++block) {
    if (!masks.colour[block]) masks.depth.set(block);
  }
  EXPECT_FALSE(is_subset(masks.depth, masks.colour));
  const Result<BlockMaskPair> back = decode_mask_pair(encode_mask_pair(masks), grid);
  ASSERT_TRUE(back);
  EXPECT_TRUE(back->depth == good.depth);
  EXPECT_TRUE(is_subset(back->depth, back->colour));
  EXPECT_FALSE(is_subset(BlockMask(BlockGrid(64, 72)), good.colour)) << "another grid";
}

TEST(BlockMaskPair, DamageAndOtherSizesAreErrors) {
  const BlockGrid grid(640, 480);
  const Bytes bytes = encode_mask_pair(random_pair(grid, 0.1, 0.5, 6));
  EXPECT_FALSE(decode_mask_pair(bytes, BlockGrid(640, 360)));
  EXPECT_FALSE(decode_mask(bytes, grid)) << "version 2 is no single mask";
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    EXPECT_FALSE(decode_mask_pair(ByteView(bytes).first(size), grid)) << "cut to " << size;
  }
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    Bytes damaged = bytes;
    damaged[i] ^= 0x10;
    EXPECT_FALSE(decode_mask_pair(damaged, grid)) << "byte " << i;
  }
}

TEST(BlockMaskPair, HostileBytesWithAValidChecksumYieldASubsetOrAnError) {
  const BlockGrid grid(540, 360);
  std::mt19937 random(4);
  const Bytes good = encode_mask_pair(random_pair(grid, 0.2, 0.5, 7));
  for (int trial = 0; trial < 3000; ++trial) {
    Bytes bytes(good.begin(), good.end() - 4);
    for (int i = 0; i < 3; ++i) {
      bytes[random() % (trial % 2 == 0 ? 8 : bytes.size())] = static_cast<std::uint8_t>(random());
    }
    if (trial % 3 == 0) bytes.resize(random() % bytes.size());
    seal(bytes);
    const Result<BlockMaskPair> masks = decode_mask_pair(bytes, grid);
    if (!masks) continue;
    EXPECT_TRUE(is_subset(masks->depth, masks->colour));
    EXPECT_EQ(masks->colour.grid().count(), grid.count());
  }
}

}  // namespace
}  // namespace rprr
