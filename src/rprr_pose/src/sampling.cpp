// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_pose/sampling.hpp"

#include <algorithm>
#include <cmath>

#include "rprr_pose/normals.hpp"

namespace rprr {
namespace {

// Position n of the R2 sequence: the plane's counterpart of the golden ratio.
struct EvenPixels {
  const DepthFrame& frame;
  double offset_u;
  double offset_v;

  cv::Point operator()(int n) const {
    constexpr double kStepU = 0.7548776662466927;
    constexpr double kStepV = 0.5698402909980532;
    double whole = 0.0;
    const double u = std::modf(offset_u + kStepU * n, &whole) * frame.width();
    const double v = std::modf(offset_v + kStepV * n, &whole) * frame.height();
    return {std::min(static_cast<int>(u), frame.width() - 1),
            std::min(static_cast<int>(v), frame.height() - 1)};
  }
};

}  // namespace

std::vector<SamplePoint> sample_points(const DepthFrame& frame, const Camera& camera, int count,
                                       std::uint32_t seed) {
  std::vector<SamplePoint> points;
  std::vector<SamplePoint> without_normal;
  points.reserve(static_cast<std::size_t>(count));
  const double turn = 0.6180339887498949 * (seed % 4096);
  const EvenPixels pixels{frame, turn - std::floor(turn), 0.5};
  // Holes may fill most of a frame: try several pixels for each point before giving up.
  const int tries = 12 * count;
  for (int n = 0; n < tries && static_cast<int>(points.size()) < count; ++n) {
    const cv::Point pixel = pixels(n);
    const auto counts = frame.counts.at<std::uint16_t>(pixel);
    if (counts == 0) continue;
    SamplePoint point{static_cast<std::uint16_t>(pixel.x), static_cast<std::uint16_t>(pixel.y),
                      counts, Eigen::Vector3f::Zero()};
    if (const auto normal = normal_at(frame, camera, pixel.x, pixel.y)) {
      point.normal = normal->cast<float>();
      points.push_back(point);
    } else {
      without_normal.push_back(point);
    }
  }
  for (const SamplePoint& point : without_normal) {
    if (static_cast<int>(points.size()) >= count) break;
    points.push_back(point);
  }
  return points;
}

}  // namespace rprr
