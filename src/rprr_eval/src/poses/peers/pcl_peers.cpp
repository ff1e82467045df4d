// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_eval/poses/peers.hpp"

#ifdef RPRR_HAVE_PCL
#include <pcl/console/print.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>
#include <pcl/registration/gicp.h>
#include <pcl/registration/icp.h>
#include <pcl/registration/transformation_estimation_point_to_plane_lls.h>

#include <cmath>

#include "rprr_pose/normals.hpp"
#endif

namespace rprr {
#ifdef RPRR_HAVE_PCL
namespace {

constexpr int kStride = 4;
constexpr double kReach = 0.3;  // [m]
constexpr int kMaxIterations = 50;
constexpr std::size_t kFewestPoints = 50;

using PlainCloud = pcl::PointCloud<pcl::PointXYZ>;
using NormalCloud = pcl::PointCloud<pcl::PointNormal>;

template <typename Action>
void for_each_point(const RgbdFrame& frame, const Action& action) {
  for (int v = 0; v < frame.depth.height(); v += kStride) {
    for (int u = 0; u < frame.depth.width(); u += kStride) {
      const double z = frame.depth.metres(u, v);
      if (z > 0.0) action(u, v, frame.camera.unproject(u, v, z).cast<float>());
    }
  }
}

NormalCloud::Ptr cloud_with_normals(const RgbdFrame& frame) {
  auto cloud = NormalCloud::Ptr(new NormalCloud);
  for_each_point(frame, [&](int u, int v, const Eigen::Vector3f& point) {
    const auto normal = normal_at(frame.depth, frame.camera, u, v);
    if (!normal) return;
    cloud->push_back({point.x(), point.y(), point.z(), static_cast<float>(normal->x()),
                      static_cast<float>(normal->y()), static_cast<float>(normal->z())});
  });
  return cloud;
}

PlainCloud::Ptr plain_cloud(const RgbdFrame& frame) {
  auto cloud = PlainCloud::Ptr(new PlainCloud);
  for_each_point(frame, [&](int /*u*/, int /*v*/, const Eigen::Vector3f& point) {
    cloud->push_back({point.x(), point.y(), point.z()});
  });
  return cloud;
}

// Moves the cloud of a onto that of b.
template <typename Method, typename Cloud>
RegistrationResult run(Method& method, const typename Cloud::Ptr& a, const typename Cloud::Ptr& b,
                       const Pose& start) {
  RegistrationResult result;
  result.b_from_a = start;
  if (a->size() < kFewestPoints || b->size() < kFewestPoints) return result;
  // What it would print, the result says as well.
  pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS);
  method.setInputSource(a);
  method.setInputTarget(b);
  method.setMaxCorrespondenceDistance(kReach);
  Cloud moved;
  method.align(moved, start.matrix().cast<float>());
  const Eigen::Matrix4d b_from_a = method.getFinalTransformation().template cast<double>();
  if (!b_from_a.allFinite()) return result;
  result.b_from_a.matrix() = b_from_a;
  result.converged = method.hasConverged();
  result.accepted = result.converged;
  result.residual = std::sqrt(method.getFitnessScore(kReach));
  return result;
}

// PCL keeps its count of iterations to itself and to its heirs.
class CountingIcp
    : public pcl::IterativeClosestPointWithNormals<pcl::PointNormal, pcl::PointNormal> {
 public:
  int iterations() const { return nr_iterations_; }
};
class CountingGicp : public pcl::GeneralizedIterativeClosestPoint<pcl::PointXYZ, pcl::PointXYZ> {
 public:
  int iterations() const { return nr_iterations_; }
};

class PclPointToPlane final : public Registration {
 public:
  std::string name() const override { return "pcl_plane"; }
  RegistrationResult align(const RgbdFrame& a, const RgbdFrame& b, const Pose& start) override {
    CountingIcp icp;
    icp.setMaximumIterations(kMaxIterations);
    icp.setTransformationEpsilon(1e-8);
    RegistrationResult result =
        run<CountingIcp, NormalCloud>(icp, cloud_with_normals(a), cloud_with_normals(b), start);
    result.iterations = icp.iterations();
    return result;
  }
};

class PclGicp final : public Registration {
 public:
  std::string name() const override { return "pcl_gicp"; }
  RegistrationResult align(const RgbdFrame& a, const RgbdFrame& b, const Pose& start) override {
    CountingGicp gicp;
    RegistrationResult result =
        run<CountingGicp, PlainCloud>(gicp, plain_cloud(a), plain_cloud(b), start);
    result.iterations = gicp.iterations();
    return result;
  }
};

}  // namespace

PeerResult make_pcl_point_to_plane() {
  return PeerResult(std::make_unique<PclPointToPlane>());
}
PeerResult make_pcl_gicp() {
  return PeerResult(std::make_unique<PclGicp>());
}

#else

namespace {

Error absent() {
  return {"built without PCL: install libpcl-dev (scripts/setup --tests), then build again"};
}

}  // namespace

PeerResult make_pcl_point_to_plane() {
  return absent();
}
PeerResult make_pcl_gicp() {
  return absent();
}

#endif
}  // namespace rprr
