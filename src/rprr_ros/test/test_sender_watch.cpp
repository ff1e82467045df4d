// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_ros/sender_watch.hpp"

#include <gtest/gtest.h>

namespace rprr {
namespace {

constexpr SteadyTime kStart = steady_seconds(10.0);

TEST(SenderWatch, OneSenderATopicIsFine) {
  SenderWatch watch;
  for (int i = 0; i < 10; ++i) {
    EXPECT_TRUE(watch.note("encoded", "/a", kStart + i).empty());
    EXPECT_TRUE(watch.note("preview", "/b", kStart + i).empty()) << "topics are told apart";
  }
}

TEST(SenderWatch, TwoAreNamed) {
  SenderWatch watch;
  watch.note("encoded", "/a", kStart);
  const std::string text = watch.note("encoded", "/stranger", kStart + 1);
  EXPECT_NE(text.find("/a"), std::string::npos) << text;
  EXPECT_NE(text.find("/stranger"), std::string::npos) << text;
}

TEST(SenderWatch, ASenderThatTookOverIsFineAfterAWhile) {
  SenderWatch watch;
  watch.note("encoded", "/a", kStart);
  EXPECT_TRUE(watch.note("encoded", "/restarted", kStart + from_seconds(4.0)).empty());
}

TEST(SenderWatch, ManyNamesTakeNoMemory) {
  SenderWatch watch;
  for (int i = 0; i < 5000; ++i) {
    const std::string text = watch.note("encoded", "/n" + std::to_string(i), kStart + i);
    EXPECT_LT(text.size(), 400u);
    watch.note("topic" + std::to_string(i), "/a", kStart + i);
  }
}

}  // namespace
}  // namespace rprr
