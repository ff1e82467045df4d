// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_station/frustum.hpp"

#include <array>

namespace rprr {

std::vector<Eigen::Vector3d> frustum_lines(const Camera& camera, double length) {
  // Outer edges of the rim's pixels.
  const double right = camera.width - 0.5;
  const double bottom = camera.height - 0.5;
  const std::array<Eigen::Vector3d, 4> corners = {
      camera.unproject(-0.5, -0.5, length), camera.unproject(right, -0.5, length),
      camera.unproject(right, bottom, length), camera.unproject(-0.5, bottom, length)};
  std::vector<Eigen::Vector3d> lines;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    lines.push_back(Eigen::Vector3d::Zero());
    lines.push_back(corners[i]);
    lines.push_back(corners[i]);
    lines.push_back(corners[(i + 1) % corners.size()]);
  }
  const Eigen::Vector3d side = corners[1] - corners[0];
  const Eigen::Vector3d down = corners[3] - corners[0];
  const Eigen::Vector3d ridge = corners[0] + 0.5 * side - 0.25 * down;
  for (const std::size_t i : {0u, 1u}) {
    lines.push_back(corners[i]);
    lines.push_back(ridge);
  }
  return lines;
}

}  // namespace rprr
