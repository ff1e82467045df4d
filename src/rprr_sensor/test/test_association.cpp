// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_sensor/recordings/association.hpp"

#include <gtest/gtest.h>

#include <set>

#include "rprr_synthetic/random.hpp"

namespace rprr {
namespace {

using Pairs = std::vector<std::pair<std::size_t, std::size_t>>;

TEST(Associate, NearestWithinTheWindowOnly) {
  EXPECT_EQ(associate({0, 100, 200}, {8, 95, 260}, 20), (Pairs{{0, 0}, {1, 1}}));
}

TEST(Associate, ClosestPairWinsAndNoStampIsUsedTwice) {
  EXPECT_EQ(associate({100, 104}, {103}, 20), (Pairs{{1, 0}}));
}

TEST(Associate, OrderOfTheInputsDoesNotMatter) {
  EXPECT_EQ(associate({200, 0, 100}, {101, 199, 2}, 20), (Pairs{{1, 2}, {2, 0}, {0, 1}}));
}

TEST(Associate, EmptyStreams) {
  EXPECT_TRUE(associate({}, {1}, 20).empty());
  EXPECT_TRUE(associate({1}, {}, 20).empty());
}

TEST(Associate, JitteredStreamsWithDroppedFrames) {
  Random random(5);
  std::vector<Stamp> colour;
  std::vector<Stamp> depth;
  std::set<std::pair<Stamp, Stamp>> expected;
  for (Stamp k = 0; k < 500; ++k) {
    const Stamp c = k * 33000000 + random.below(8000000);
    const Stamp d = k * 33000000 + random.below(8000000);
    const bool has_colour = random.below(10) > 0;
    const bool has_depth = random.below(10) > 0;
    if (has_colour) colour.push_back(c);
    if (has_depth) depth.push_back(d);
    if (has_colour && has_depth) expected.insert({c, d});
  }
  std::set<std::pair<Stamp, Stamp>> found;
  for (const auto& [c, d] : associate(colour, depth, 20000000)) found.insert({colour[c], depth[d]});
  EXPECT_EQ(found, expected);
}

TEST(NearestStamp, EitherSideWithinTheWindow) {
  const std::vector<Stamp> stamps{10, 20, 40};
  EXPECT_EQ(nearest_stamp(stamps, 0, 10), 0u);
  EXPECT_EQ(nearest_stamp(stamps, 29, 10), 1u);
  EXPECT_EQ(nearest_stamp(stamps, 31, 10), 2u);
  EXPECT_EQ(nearest_stamp(stamps, 60, 10), std::nullopt);
  EXPECT_EQ(nearest_stamp({}, 60, 10), std::nullopt);
}

}  // namespace
}  // namespace rprr
