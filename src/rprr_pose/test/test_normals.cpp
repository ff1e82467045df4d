// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_pose/normals.hpp"

#include <gtest/gtest.h>

#include "synthetic_views.hpp"

namespace rprr {
namespace {

// A plane n . p = d seen by the test camera, in tenths of a millimetre.
DepthFrame plane(const Eigen::Vector3d& normal, double distance) {
  DepthFrame frame{cv::Mat(kTestCamera.height, kTestCamera.width, CV_16UC1), 0.0001};
  for (int v = 0; v < frame.height(); ++v) {
    for (int u = 0; u < frame.width(); ++u) {
      const double z = distance / normal.dot(kTestCamera.unproject(u, v, 1.0));
      frame.counts.at<std::uint16_t>(v, u) =
          z > 0.0 && z < 6.5 ? static_cast<std::uint16_t>(std::lround(z * 1e4)) : std::uint16_t{0};
    }
  }
  return frame;
}

TEST(Normals, PlanesGiveTheirNormalTowardsTheCamera) {
  for (const Eigen::Vector3d& direction :
       {Eigen::Vector3d(0, 0, 1), Eigen::Vector3d(0.5, 0.2, 1), Eigen::Vector3d(-0.3, 0.8, 1)}) {
    const Eigen::Vector3d expected = direction.normalized();
    const DepthFrame frame = plane(expected, 2.0);
    for (const int u : {20, 160, 300}) {
      const auto normal = normal_at(frame, kTestCamera, u, 120);
      ASSERT_TRUE(normal) << "column " << u;
      EXPECT_GT(-normal->dot(expected), 0.9995) << normal->transpose();
    }
  }
}

TEST(Normals, ADepthEdgeDoesNotTiltTheNormal) {
  DepthFrame frame = plane(Eigen::Vector3d::UnitZ(), 1.0);
  frame.counts(cv::Rect(0, 0, 160, 240)).setTo(30000);
  const auto normal = normal_at(frame, kTestCamera, 161, 120);
  ASSERT_TRUE(normal);
  EXPECT_LT(normal->z(), -0.999);
}

TEST(Normals, HolesAndSpecksHaveNone) {
  DepthFrame frame = plane(Eigen::Vector3d::UnitZ(), 2.0);
  frame.counts.at<std::uint16_t>(50, 50) = 0;
  EXPECT_FALSE(normal_at(frame, kTestCamera, 50, 50));
  frame.counts.at<std::uint16_t>(100, 100) = 10000;  // alone, a metre before the wall
  EXPECT_FALSE(normal_at(frame, kTestCamera, 100, 100));
}

}  // namespace
}  // namespace rprr
