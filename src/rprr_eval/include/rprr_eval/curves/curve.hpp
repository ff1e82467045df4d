// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

namespace rprr {

struct CurvePoint {
  double bytes = 0.0;  // positive
  double value = 0.0;  // the more the better
};

/// What a method reaches for its bytes: linear in the logarithm of the bytes between points that
/// were measured. A limit of bytes need not be used up, so beyond the last point the curve goes on
/// level; below the first there is nothing.
class Curve {
 public:
  /// In any order; of several points of the same bytes the best counts.
  explicit Curve(std::vector<CurvePoint> points);

  bool empty() const { return points_.empty(); }
  /// Ascending bytes.
  const std::vector<CurvePoint>& points() const { return points_; }

  /// Nothing below the first point.
  std::optional<double> at(double bytes) const;
  /// The least bytes at which the curve comes to a value: the first point's for all that is worse.
  /// Nothing if it never does.
  std::optional<double> bytes_for(double value) const;

  double least_value() const;
  double greatest_value() const;

 private:
  std::vector<CurvePoint> points_;
};

/// Where a curve lies under a rival the most, or above it the least.
struct Shortfall {
  double value = 0.0;  // negative: above everywhere
  double bytes = 0.0;  // there
};

/// Anywhere from the rival's first point to its last. Infinite, at the rival's first point, where
/// the curve has not begun there yet. Neither may be empty.
Shortfall worst_shortfall(const Curve& curve, const Curve& rival);

/// The bytes of a curve over a rival's where both come to the same value: the median over so many
/// values, evenly spread over what both reach. Nothing if they have nothing in common.
std::optional<double> median_byte_ratio(const Curve& curve, const Curve& rival, int values = 41);

}  // namespace rprr
