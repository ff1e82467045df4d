// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "rprr_geometry/se3.hpp"

namespace rprr {

/// A residual's six derivatives, the residual itself and one unused place.
struct alignas(16) Row {
  float at[8] = {};
};

/// Weighted sums of products of rows with themselves: a 7x7 matrix's upper triangle, kept in lanes
/// of four, which compilers turn into SIMD of any kind.
class RowSums {
 public:
  void add(const Row& row, float weight) {
    const Lane low = Lane::Map(row.at);
    const Lane high = Lane::Map(row.at + 4);
    for (int i = 0; i < 4; ++i) {
      const float scaled = weight * row.at[i];
      low_[i] += scaled * low;
      high_[i] += scaled * high;
    }
    for (int i = 4; i < 7; ++i) high_[i] += weight * row.at[i] * high;
  }

  /// Sum of w J^T J.
  Matrix6 information() const {
    Matrix6 out;
    for (int i = 0; i < 6; ++i) {
      for (int j = i; j < 6; ++j) out(i, j) = out(j, i) = static_cast<double>(at(i, j));
    }
    return out;
  }
  /// Sum of w J^T r.
  Twist gradient() const {
    Twist out;
    for (int i = 0; i < 6; ++i) out[i] = static_cast<double>(at(i, 6));
    return out;
  }
  /// Sum of w r^2.
  double squares() const { return static_cast<double>(at(6, 6)); }

 private:
  using Lane = Eigen::Array<float, 4, 1>;
  float at(int i, int j) const { return j < 4 ? low_[i][j] : high_[i][j - 4]; }

  Lane low_[4] = {Lane::Zero(), Lane::Zero(), Lane::Zero(), Lane::Zero()};
  Lane high_[7] = {Lane::Zero(), Lane::Zero(), Lane::Zero(), Lane::Zero(),
                   Lane::Zero(), Lane::Zero(), Lane::Zero()};
};

}  // namespace rprr
