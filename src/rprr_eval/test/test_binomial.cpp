// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_eval/measure/binomial.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace rprr {
namespace {

TEST(ClopperPearson, WithoutEventsHasAClosedForm) {
  for (const int n : {1, 20, 1000}) {
    EXPECT_NEAR(clopper_pearson_upper(0, n), 1.0 - std::pow(0.05, 1.0 / n), 1e-9) << n;
  }
}

TEST(ClopperPearson, AgreesWithPublishedValues) {
  // One-sided 97.5% is the upper end of the usual two-sided 95% interval.
  EXPECT_NEAR(clopper_pearson_upper(1, 10, 0.975), 0.4450, 1e-4);
  EXPECT_NEAR(clopper_pearson_upper(5, 100, 0.975), 0.1128, 1e-4);
}

TEST(ClopperPearson, GrowsWithEventsAndShrinksWithTrials) {
  double last = 0.0;
  for (int events = 0; events <= 50; ++events) {
    const double bound = clopper_pearson_upper(events, 50);
    EXPECT_GT(bound, last - 1e-12);
    EXPECT_GE(bound, events / 50.0);
    EXPECT_LE(clopper_pearson_upper(events, 500), bound);
    last = bound;
  }
}

TEST(ClopperPearson, NothingTriedNothingKnown) {
  EXPECT_EQ(clopper_pearson_upper(0, 0), 1.0);
  EXPECT_EQ(clopper_pearson_upper(3, 3), 1.0);
}

}  // namespace
}  // namespace rprr
