// SPDX-License-Identifier: BSD-3-Clause
#include "../src/row_sums.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace rprr {
namespace {

TEST(RowSums, AreTheSumsOfWeightedProducts) {
  RowSums sums;
  Matrix6 information = Matrix6::Zero();
  Twist gradient = Twist::Zero();
  double squares = 0.0;
  for (int k = 0; k < 50; ++k) {
    Row row;
    Twist j;
    for (int i = 0; i < 6; ++i) {
      row.at[i] = std::sin(0.7f * static_cast<float>(k) + static_cast<float>(i * i));
      j[i] = static_cast<double>(row.at[i]);
    }
    row.at[6] = std::cos(0.3f * static_cast<float>(k));
    const auto residual = static_cast<double>(row.at[6]);
    const float weight = 0.1f + 0.02f * static_cast<float>(k);
    sums.add(row, weight);
    const auto w = static_cast<double>(weight);
    information += w * j * j.transpose();
    gradient += w * residual * j;
    squares += w * residual * residual;
  }
  EXPECT_LT((sums.information() - information).cwiseAbs().maxCoeff(), 1e-3);
  EXPECT_LT((sums.gradient() - gradient).cwiseAbs().maxCoeff(), 1e-3);
  EXPECT_NEAR(sums.squares(), squares, 1e-3);
}

}  // namespace
}  // namespace rprr
