// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "dhcm/lanes.hpp"
#include "dhcm/model.hpp"

namespace rprr::dhcm {
namespace {

struct Rows {
  std::vector<std::int16_t> above, above_hole, fill, hole, step;
  std::vector<std::uint8_t> north;
};

constexpr int kWidth = 37;  // no multiple of the lanes
constexpr int kMargin = 2;

// Rows of all kinds: smooth, rough, and with extreme numbers.
Rows random_rows(std::mt19937& random, int kind) {
  Rows rows;
  const std::size_t size = kWidth + 2 * kMargin + kLanes;
  for (std::size_t i = 0; i < size; ++i) {
    const int spread = kind == 0 ? 2 : kind == 1 ? 40 : 65536;
    rows.above.push_back(static_cast<std::int16_t>(random() % static_cast<unsigned>(spread)));
    rows.fill.push_back(static_cast<std::int16_t>(random() % static_cast<unsigned>(spread)));
    rows.above_hole.push_back(static_cast<std::int16_t>(random() % 3 == 0));
    rows.hole.push_back(static_cast<std::int16_t>(random() % 3 == 0));
  }
  rows.north.resize(size);
  rows.step.resize(size);
  return rows;
}

TEST(DhcmModel, LanesAgreeWithOnePixelAtATime) {
  std::mt19937 random(4);
  const ContextMap& map = context_map();
  for (int trial = 0; trial < 300; ++trial) {
    Rows rows = random_rows(random, trial % 3);
    const std::int16_t* above = rows.above.data() + kMargin;
    const std::int16_t* fill = rows.fill.data() + kMargin;
    const std::int16_t* hole = rows.hole.data() + kMargin;
    const std::int16_t* above_hole = rows.above_hole.data() + kMargin;
    classify_north(above, above_hole, 0, kWidth, rows.north.data(), rows.step.data());
    std::vector<std::int16_t> place(rows.step.size());
    std::vector<std::int16_t> residual(rows.step.size());
    std::vector<std::uint8_t> miss(rows.step.size());
    compare_row({fill, hole, above, rows.step.data(), rows.north.data()}, 0, kWidth, place.data(),
                residual.data(), miss.data());
    for (int u = 0; u < kWidth; ++u) {
      const auto column = static_cast<std::size_t>(u);
      ASSERT_EQ(rows.north[column], north_class(above + u, above_hole + u));
      ASSERT_EQ(rows.step[column], static_cast<std::int16_t>(above[u] - above[u - 1]));
      const int west = hole[u - 1] != 0 ? kWestHole : west_class(fill[u - 1], above[u - 1]);
      ASSERT_EQ(place[column], rows.north[column] * kWestClasses + west);
      const std::int16_t guess = predict(fill[u - 1], above[u], rows.step[column]);
      ASSERT_EQ(residual[column], static_cast<std::int16_t>(fill[u] - guess));
      const bool in_hole = map[static_cast<std::size_t>(place[column])] == kInHole;
      const bool usual = in_hole ? hole[u] != 0 : hole[u] == 0 && fill[u] == guess;
      ASSERT_EQ(miss[column], usual ? 0 : 1);
    }
  }
}

TEST(DhcmModel, GuessesLieBetweenWestAndNorth) {
  std::mt19937 random(6);
  for (int trial = 0; trial < 10000; ++trial) {
    const auto w = static_cast<std::int16_t>(random());
    const auto n = static_cast<std::int16_t>(random());
    const std::int16_t guess = predict(w, n, static_cast<std::int16_t>(random()));
    EXPECT_GE(guess, std::min(w, n));
    EXPECT_LE(guess, std::max(w, n));
  }
  EXPECT_EQ(predict(5, 9, 0), 5);
  EXPECT_EQ(predict(5, 9, 1), 6);
  EXPECT_EQ(predict(5, 9, 100), 9);
}

TEST(DhcmModel, OnlyRightPlacesAreRunsOfNothingNew) {
  // The decoder steps over whole stretches in these two contexts: north's class must settle them.
  const ContextMap& map = context_map();
  for (int place = 0; place < kNorthClasses * kWestClasses; ++place) {
    const int north = place / kWestClasses;
    const int west = place % kWestClasses;
    const int context = map[static_cast<std::size_t>(place)];
    EXPECT_EQ(context == kFlat, north == kNorthFlat && west == kWestLevel);
    EXPECT_EQ(context == kInHole, north == kNorthHole && west == kWestHole);
  }
}

}  // namespace
}  // namespace rprr::dhcm
