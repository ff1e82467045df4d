// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_ros/input_watch.hpp"

#include <gtest/gtest.h>

namespace rprr {
namespace {

const std::string kTopic = "/a/camera/rgb/image_rect_color";

SteadyTime after(double seconds) {
  return steady_seconds(1000.0 + seconds);
}

InputWatch watch_of(InputKind kind) {
  InputWatch watch;
  watch.expect(kTopic, kind, "colour images", "start the camera", after(0.0));
  return watch;
}

// The only problem's text; empty: there is none.
std::string problem_of(const InputWatch& watch, double seconds) {
  const auto problems = watch.problems(after(seconds));
  EXPECT_LE(problems.size(), 1u);
  return problems.empty() ? std::string() : problems.front().text;
}

class AllKindsOfInput : public testing::TestWithParam<InputKind> {};
INSTANTIATE_TEST_SUITE_P(Kinds, AllKindsOfInput,
                         testing::Values(InputKind::kStream, InputKind::kOnce,
                                         InputKind::kSometimes, InputKind::kRegularly));

TEST_P(AllKindsOfInput, NobodyWhoPublishesIsMissedWithinFiveSeconds) {
  const InputWatch watch = watch_of(GetParam());
  EXPECT_EQ(problem_of(watch, 1.0), "") << "nodes start one after the other";
  const std::string text = problem_of(watch, 4.0);
  EXPECT_NE(text.find(kTopic), std::string::npos) << text;
  EXPECT_NE(text.find("colour images"), std::string::npos) << text;
  EXPECT_NE(text.find("start the camera"), std::string::npos) << text;
}

TEST_P(AllKindsOfInput, WhatIsHeardIsNotMissed) {
  InputWatch watch = watch_of(GetParam());
  watch.connected(kTopic, 1, after(4.0));
  watch.heard(kTopic, after(4.0));
  EXPECT_EQ(problem_of(watch, 4.1), "") << "the report goes when its cause goes";
  EXPECT_EQ(problem_of(watch, 7.0), "");
}

TEST(InputWatch, APublisherThatSendsNothingIsMissedIfMessagesAreNeeded) {
  for (const InputKind kind :
       {InputKind::kStream, InputKind::kOnce, InputKind::kSometimes, InputKind::kRegularly}) {
    InputWatch watch = watch_of(kind);
    watch.connected(kTopic, 1, after(3.0));
    EXPECT_EQ(problem_of(watch, 5.0), "") << "it has only begun";
    const bool is_needed = kind == InputKind::kStream || kind == InputKind::kOnce;
    EXPECT_EQ(problem_of(watch, 7.0).empty(), !is_needed);
  }
}

TEST(InputWatch, WhatFallsSilentIsMissedUntilItComesAgain) {
  for (const InputKind kind : {InputKind::kStream, InputKind::kRegularly}) {
    InputWatch watch = watch_of(kind);
    watch.connected(kTopic, 1, after(0.0));
    for (int i = 0; i < 10; ++i) watch.heard(kTopic, after(0.1 * i));
    EXPECT_EQ(problem_of(watch, 3.5), "");
    EXPECT_NE(problem_of(watch, 10.9).find("for 10 s"), std::string::npos)
        << problem_of(watch, 10.9);
    watch.heard(kTopic, after(12.0));
    EXPECT_EQ(problem_of(watch, 12.5), "");
  }
}

TEST(InputWatch, WhatIsNeededOnceMayEnd) {
  InputWatch watch = watch_of(InputKind::kOnce);
  watch.connected(kTopic, 1, after(0.5));
  watch.heard(kTopic, after(0.5));
  watch.connected(kTopic, 0, after(1.0));
  EXPECT_EQ(problem_of(watch, 100.0), "");
}

TEST(InputWatch, APublisherThatIsGoneIsMissed) {
  InputWatch watch = watch_of(InputKind::kSometimes);
  watch.connected(kTopic, 1, after(0.0));
  watch.heard(kTopic, after(0.0));
  watch.connected(kTopic, 0, after(50.0));
  EXPECT_EQ(problem_of(watch, 52.0), "") << "a node that is started again has its time";
  EXPECT_NE(problem_of(watch, 54.0).find("no more"), std::string::npos) << problem_of(watch, 54.0);
}

TEST(InputWatch, TopicsThatNobodyNeedsAreIgnored) {
  InputWatch watch;
  watch.heard(kTopic, after(0.0));
  watch.connected(kTopic, 3, after(0.0));
  EXPECT_EQ(problem_of(watch, 100.0), "");
}

}  // namespace
}  // namespace rprr
