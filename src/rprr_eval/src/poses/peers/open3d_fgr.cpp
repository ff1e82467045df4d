// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_eval/poses/peers.hpp"

#ifdef RPRR_HAVE_OPEN3D
#include <open3d/geometry/KDTreeSearchParam.h>
#include <open3d/geometry/PointCloud.h>
#include <open3d/pipelines/registration/FastGlobalRegistration.h>
#include <open3d/pipelines/registration/Feature.h>
#include <open3d/pipelines/registration/Registration.h>
#include <open3d/utility/Random.h>
#endif

namespace rprr {
#ifdef RPRR_HAVE_OPEN3D
namespace {

namespace o3d = open3d::geometry;
namespace reg = open3d::pipelines::registration;

constexpr double kVoxel = 0.05;  // [m]
constexpr int kStride = 2;
constexpr std::size_t kFewestPoints = 50;
constexpr double kFewestInliers = 0.3;  // share of a's voxels near one of b's: then converged

std::shared_ptr<o3d::PointCloud> cloud_of(const RgbdFrame& frame) {
  o3d::PointCloud cloud;
  for (int v = 0; v < frame.depth.height(); v += kStride) {
    for (int u = 0; u < frame.depth.width(); u += kStride) {
      const double z = frame.depth.metres(u, v);
      if (z > 0.0) cloud.points_.push_back(frame.camera.unproject(u, v, z));
    }
  }
  auto sparse = cloud.VoxelDownSample(kVoxel);
  if (sparse->points_.size() < kFewestPoints) return sparse;  // Open3D throws without normals
  sparse->EstimateNormals(o3d::KDTreeSearchParamHybrid(2.0 * kVoxel, 30));
  sparse->OrientNormalsTowardsCameraLocation();
  return sparse;
}

class Open3dFgr final : public Registration {
 public:
  std::string name() const override { return "open3d_fgr"; }

  RegistrationResult align(const RgbdFrame& a, const RgbdFrame& b, const Pose& start) override {
    RegistrationResult result;
    result.b_from_a = start;
    const auto cloud_a = cloud_of(a);
    const auto cloud_b = cloud_of(b);
    if (cloud_a->points_.size() < kFewestPoints || cloud_b->points_.size() < kFewestPoints) {
      return result;
    }
    const o3d::KDTreeSearchParamHybrid around(5.0 * kVoxel, 100);
    const auto features_a = reg::ComputeFPFHFeature(*cloud_a, around);
    const auto features_b = reg::ComputeFPFHFeature(*cloud_b, around);
    open3d::utility::random::Seed(1);  // the same every time
    reg::FastGlobalRegistrationOption option;
    option.maximum_correspondence_distance_ = 0.5 * kVoxel;
    const reg::RegistrationResult found = reg::FastGlobalRegistrationBasedOnFeatureMatching(
        *cloud_a, *cloud_b, *features_a, *features_b, option);
    result.b_from_a.matrix() = found.transformation_;
    result.iterations = option.iteration_number_;
    result.converged = found.fitness_ > kFewestInliers;
    result.accepted = result.converged;
    result.residual = found.inlier_rmse_;
    return result;
  }
};

}  // namespace

PeerResult make_open3d_fgr() {
  return PeerResult(std::make_unique<Open3dFgr>());
}

#else

PeerResult make_open3d_fgr() {
  return Error{"built without Open3D: install libopen3d-dev, then build again"};
}

#endif
}  // namespace rprr
