// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_eval/curves/curve.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "rprr_eval/measure/median.hpp"

namespace rprr {
namespace {

using Points = std::vector<CurvePoint>;

bool by_value(const CurvePoint& a, const CurvePoint& b) {
  return a.value < b.value;
}

double interpolate(const CurvePoint& from, const CurvePoint& to, double bytes) {
  const double share = std::log(bytes / from.bytes) / std::log(to.bytes / from.bytes);
  return from.value + share * (to.value - from.value);
}

}  // namespace

Curve::Curve(Points points) : points_(std::move(points)) {
  std::sort(points_.begin(), points_.end(), [](const CurvePoint& a, const CurvePoint& b) {
    return a.bytes != b.bytes ? a.bytes < b.bytes : a.value > b.value;
  });
  const auto same = [](const CurvePoint& a, const CurvePoint& b) { return a.bytes == b.bytes; };
  points_.erase(std::unique(points_.begin(), points_.end(), same), points_.end());
}

std::optional<double> Curve::at(double bytes) const {
  if (points_.empty() || bytes < points_.front().bytes) return std::nullopt;
  const auto after =
      std::upper_bound(points_.begin(), points_.end(), bytes,
                       [](double value, const CurvePoint& point) { return value < point.bytes; });
  const CurvePoint& before = *std::prev(after);
  // The points' own values exactly, so that a curve is on itself.
  if (after == points_.end() || before.bytes == bytes) return before.value;
  return interpolate(before, *after, bytes);
}

std::optional<double> Curve::bytes_for(double value) const {
  for (std::size_t i = 0; i < points_.size(); ++i) {
    if (points_[i].value < value) continue;
    if (i == 0) return points_[i].bytes;
    const CurvePoint& before = points_[i - 1];
    const double share = (value - before.value) / (points_[i].value - before.value);
    return before.bytes * std::pow(points_[i].bytes / before.bytes, share);
  }
  return std::nullopt;
}

double Curve::least_value() const {
  return std::min_element(points_.begin(), points_.end(), by_value)->value;
}

double Curve::greatest_value() const {
  return std::max_element(points_.begin(), points_.end(), by_value)->value;
}

Shortfall worst_shortfall(const Curve& curve, const Curve& rival) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const double first = rival.points().front().bytes;
  const double last = rival.points().back().bytes;
  Shortfall worst{-kInfinity, first};
  // Both are straight between all their points, so the worst place is one of these.
  for (const Curve* bends : {&curve, &rival}) {
    for (const CurvePoint& bend : bends->points()) {
      if (bend.bytes < first || bend.bytes > last) continue;
      const std::optional<double> own = curve.at(bend.bytes);
      if (!own) return {kInfinity, first};
      const double under = *rival.at(bend.bytes) - *own;
      if (under > worst.value) worst = {under, bend.bytes};
    }
  }
  return worst;
}

std::optional<double> median_byte_ratio(const Curve& curve, const Curve& rival, int values) {
  if (curve.empty() || rival.empty()) return std::nullopt;
  const double low = std::max(curve.least_value(), rival.least_value());
  const double high = std::min(curve.greatest_value(), rival.greatest_value());
  if (low > high) return std::nullopt;
  std::vector<double> ratios;
  for (int i = 0; i < values; ++i) {
    const double value = low + (high - low) * i / std::max(values - 1, 1);
    const auto own = curve.bytes_for(std::min(value, high));
    const auto other = rival.bytes_for(std::min(value, high));
    if (own && other) ratios.push_back(*own / *other);
  }
  if (ratios.empty()) return std::nullopt;
  return median(std::move(ratios));
}

}  // namespace rprr
