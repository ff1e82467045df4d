// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_eval/measure/chi_square.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace rprr {
namespace {

TEST(ChiSquare, TwoDegreesOfFreedomHaveAClosedForm) {
  for (const double value : {0.01, 1.0, 3.9, 4.1, 20.0}) {
    EXPECT_NEAR(chi_square_probability(value, 2.0), 1.0 - std::exp(-0.5 * value), 1e-12) << value;
  }
  for (const double p : {0.025, 0.5, 0.975}) {
    EXPECT_NEAR(chi_square_quantile(p, 2.0), -2.0 * std::log1p(-p), 1e-8) << p;
  }
}

TEST(ChiSquare, OneDegreeOfFreedomIsASquaredNormal) {
  for (const double value : {0.05, 1.0, 3.841459, 12.0}) {
    EXPECT_NEAR(chi_square_probability(value, 1.0), std::erf(std::sqrt(0.5 * value)), 1e-12)
        << value;
  }
}

TEST(ChiSquare, AgreesWithPublishedQuantiles) {
  EXPECT_NEAR(chi_square_quantile(0.95, 1.0), 3.841459, 1e-6);
  EXPECT_NEAR(chi_square_quantile(0.95, 3.0), 7.814728, 1e-6);
  EXPECT_NEAR(chi_square_quantile(0.95, 6.0), 12.591587, 1e-6);
  EXPECT_NEAR(chi_square_quantile(0.5, 6.0), 5.348121, 1e-6);
  EXPECT_NEAR(chi_square_quantile(0.025, 100.0), 74.221927, 1e-6);
  EXPECT_NEAR(chi_square_quantile(0.975, 100.0), 129.561197, 1e-6);
}

TEST(ChiSquare, TheQuantileInvertsTheProbability) {
  for (const double freedom : {1.0, 3.0, 6.0, 600.0, 6000.0}) {
    for (const double p : {0.001, 0.025, 0.5, 0.975, 0.999}) {
      EXPECT_NEAR(chi_square_probability(chi_square_quantile(p, freedom), freedom), p, 1e-9)
          << freedom << " degrees of freedom";
    }
  }
}

TEST(ChiSquare, NothingIsBelowZero) {
  EXPECT_EQ(chi_square_probability(0.0, 6.0), 0.0);
  EXPECT_EQ(chi_square_probability(-1.0, 6.0), 0.0);
  EXPECT_NEAR(chi_square_quantile(0.0, 6.0), 0.0, 1e-9);
}

}  // namespace
}  // namespace rprr
