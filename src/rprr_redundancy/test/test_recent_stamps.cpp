// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_redundancy/recent_stamps.hpp"

#include <gtest/gtest.h>

namespace rprr {
namespace {

TEST(RecentStamps, EveryStampIsNewOnce) {
  RecentStamps stamps(3);
  EXPECT_TRUE(stamps.insert(5));
  EXPECT_FALSE(stamps.insert(5));
  EXPECT_TRUE(stamps.contains(5));
  EXPECT_FALSE(stamps.contains(6));
}

TEST(RecentStamps, TheOldestIsForgotten) {
  RecentStamps stamps(2);
  for (const Stamp stamp : {1, 2, 3}) stamps.insert(stamp);
  EXPECT_FALSE(stamps.contains(1));
  EXPECT_TRUE(stamps.contains(2));
  RecentStamps none(0);
  EXPECT_TRUE(none.insert(1)) << "a capacity of 0 is one of 1";
}

}  // namespace
}  // namespace rprr
