// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_pose/pose_verdict.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <limits>
#include <random>
#include <set>

namespace rprr {
namespace {

constexpr std::uint8_t kStatuses = 12;    // from 0 on, without kUnknown
constexpr std::uint8_t kQuantities = 15;  // from 0 on, without kUnknown

PoseStatus status_of(int value) {
  return static_cast<PoseStatus>(value);
}
PoseQuantity quantity_of(int value) {
  return static_cast<PoseQuantity>(value);
}

// The figure that follows those words in a text.
double figure_after(const std::string& text, const std::string& words) {
  const std::size_t at = text.find(words);
  EXPECT_NE(at, std::string::npos) << words << " in " << text;
  return at == std::string::npos ? 0.0 : std::atof(text.c_str() + at + words.size());
}

TEST(PoseVerdict, SaysWhatWasMeasuredAndWhatWasNeeded) {
  EXPECT_EQ(describe({PoseStatus::kAmbiguous, PoseQuantity::kMargin, 0.02f, 0.06f}),
            "two poses fit: margin 0.02, needs 0.06");
  EXPECT_EQ(describe({PoseStatus::kColourDisagrees, PoseQuantity::kLogOdds, 0.3f, 1.0f}),
            "colours disagree: log odds 0.3, needs 1.0");
  EXPECT_EQ(
      describe({PoseStatus::kFreeDirection, PoseQuantity::kTranslationSigma, 0.034f, 0.01f}),
      "the geometry leaves a direction free: translation sigma 0.034 m, needs at most 0.010 m");
  EXPECT_EQ(describe({PoseStatus::kTooFewPoints, PoseQuantity::kValidPoints, 12.0f, 30.0f}),
            "too few points: points with depth 12, needs 30");
  EXPECT_EQ(describe({PoseStatus::kAccepted, PoseQuantity::kLogOdds, 4.25f, 1.0f}),
            "accepted: log odds 4.2, needs 1.0");
  EXPECT_EQ(describe({PoseStatus::kMalformed}), "the peer's message could not be read");
}

TEST(PoseVerdict, EveryStatusAndQuantityHasItsOwnNameAndWords) {
  std::set<std::string> names, causes, quantities, texts;
  for (int value = 0; value < kStatuses; ++value) {
    names.insert(name_of(status_of(value)));
    causes.insert(cause_of(status_of(value)));
  }
  EXPECT_EQ(names.size(), kStatuses);
  EXPECT_EQ(causes.size(), kStatuses);
  for (int value = 0; value < kQuantities; ++value) {
    quantities.insert(name_of(quantity_of(value)));
    texts.insert(describe({PoseStatus::kDepthDisagrees, quantity_of(value), 1.0f, 2.0f}));
  }
  EXPECT_EQ(quantities.size(), kQuantities);
  EXPECT_EQ(texts.size(), kQuantities);
  for (const auto* all : {&names, &causes, &quantities}) {
    EXPECT_EQ(all->count("unknown"), 0u);
    EXPECT_EQ(all->count(""), 0u);
  }
}

TEST(PoseVerdict, TheTextTellsFiguresApartHoweverNearTheyAre) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> size(-4.0, 4.0), apart(-5.0, 0.0);
  for (int trial = 0; trial < 20000; ++trial) {
    const PoseQuantity quantity = quantity_of(1 + trial % (kQuantities - 1));
    const double needed = std::pow(10.0, size(random));
    const double off = std::pow(10.0, apart(random)) * (is_lower_limit(quantity) ? -1.0 : 1.0);
    const PoseVerdict verdict =
        make_verdict(PoseStatus::kNotConverged, quantity, needed * (1.0 + off), needed);
    const std::string text = describe(verdict);
    const std::string limit = is_lower_limit(quantity) ? ", needs " : ", needs at most ";
    const double shown_limit = figure_after(text, limit);
    ASSERT_NEAR(shown_limit, needed, 0.01 * needed + 1e-7) << text;
    const std::string words = describe({PoseStatus::kNotConverged, quantity, 7.0f, 7.0f});
    const double shown = figure_after(text, words.substr(0, words.find('7')));
    if (std::abs(off) * needed > 1e-6) {
      ASSERT_EQ(shown < shown_limit, is_lower_limit(quantity)) << text;
      ASSERT_NE(shown, shown_limit) << text;
    }
  }
}

TEST(PoseVerdict, AnyValuesFromTheRadioHaveWords) {
  const float infinite = std::numeric_limits<float>::infinity();
  const float figures[] = {0.0f,    std::nanf(""), infinite, -infinite, -0.0f,
                           3.4e38f, -3.4e38f,      1e-45f,   -123456.7f};
  for (int status = 0; status < 256; ++status) {
    for (int quantity = 0; quantity < 256; ++quantity) {
      const float measured = figures[(status + quantity) % 9];
      const float needed = figures[(status * 5 + quantity / 9) % 9];
      const std::string text =
          describe({status_of(status), quantity_of(quantity), measured, needed});
      ASSERT_LT(text.size(), 250u) << text;
      ASSERT_EQ(text.find("unknown status") != std::string::npos, status >= kStatuses) << text;
      ASSERT_EQ(text.find("unknown quantity") != std::string::npos, quantity >= kQuantities)
          << text;
      if (quantity == 0) continue;
      ASSERT_EQ(text.find("not a number") != std::string::npos,
                std::isnan(measured) || std::isnan(needed))
          << text;
    }
  }
}

TEST(PoseVerdict, BytesFromTheRadioAreKnownOrUnknown) {
  for (int value = 0; value < 256; ++value) {
    const auto byte = static_cast<std::uint8_t>(value);
    EXPECT_EQ(pose_status_from(byte), value < kStatuses ? status_of(value) : PoseStatus::kUnknown);
    EXPECT_EQ(pose_quantity_from(byte),
              value < kQuantities ? quantity_of(value) : PoseQuantity::kUnknown);
  }
  EXPECT_STREQ(name_of(status_of(77)), "unknown");
  EXPECT_STREQ(name_of(quantity_of(77)), "unknown");
}

TEST(PoseVerdict, WhatNoFloatCanHoldIsInfinite) {
  const PoseVerdict verdict =
      make_verdict(PoseStatus::kNotConverged, PoseQuantity::kTranslationStep, 1e300, 1e-3);
  EXPECT_TRUE(std::isinf(verdict.measured));
  EXPECT_EQ(describe(verdict), "not converged: last step infinite m, needs at most 0.0010 m");
}

}  // namespace
}  // namespace rprr
