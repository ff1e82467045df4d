// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/Geometry>
#include <cmath>
#include <nanoflann.hpp>
#include <vector>

#include "rprr_pose/registration.hpp"
#include "rprr_pose/sampling.hpp"

namespace rprr {
namespace {

constexpr int kStride = 2;  // of the pixels that the tree holds
constexpr std::size_t kLeaf = 16;
constexpr std::size_t kFewestPoints = 6;

// A cloud as nanoflann wants it.
struct Cloud {
  std::vector<Eigen::Vector3d> points;

  std::size_t kdtree_get_point_count() const { return points.size(); }
  double kdtree_get_pt(std::size_t i, std::size_t axis) const {
    return points[i][static_cast<Eigen::Index>(axis)];
  }
  template <typename Box>
  bool kdtree_get_bbox(Box& /*unused*/) const {
    return false;
  }
};
using Tree =
    nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, Cloud>, Cloud, 3>;

Cloud cloud_of(const RgbdFrame& frame) {
  Cloud cloud;
  for (int v = 0; v < frame.depth.height(); v += kStride) {
    for (int u = 0; u < frame.depth.width(); u += kStride) {
      const double z = frame.depth.metres(u, v);
      if (z > 0.0) cloud.points.push_back(frame.camera.unproject(u, v, z));
    }
  }
  return cloud;
}

Eigen::Matrix3Xd points_of(const RgbdFrame& frame) {
  const auto samples = sample_points(frame.depth, frame.camera, kSampleCount, 1);
  Eigen::Matrix3Xd points(3, static_cast<Eigen::Index>(samples.size()));
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const SamplePoint& sample = samples[static_cast<std::size_t>(i)];
    points.col(i) =
        frame.camera.unproject(sample.column, sample.row, sample.counts * frame.depth.unit);
  }
  return points;
}

// The nearest point of the cloud for each; returns the RMS distance.
double match(const Eigen::Matrix3Xd& moved, const Cloud& cloud, const Tree& tree,
             Eigen::Matrix3Xd& nearest) {
  double sum = 0.0;
  for (Eigen::Index i = 0; i < moved.cols(); ++i) {
    std::size_t index = 0;
    double squared = 0.0;
    nanoflann::KNNResultSet<double> found(1);
    found.init(&index, &squared);
    tree.findNeighbors(found, moved.col(i).data(), {});
    nearest.col(i) = cloud.points[index];
    sum += squared;
  }
  return std::sqrt(sum / static_cast<double>(moved.cols()));
}

class Icp final : public Registration {
 public:
  explicit Icp(const IterationLimits& limits) : limits_(limits) {}

  std::string name() const override { return "icp"; }

  RegistrationResult align(const RgbdFrame& a, const RgbdFrame& b, const Pose& start) override {
    RegistrationResult result;
    result.b_from_a = start;
    const Eigen::Matrix3Xd points = points_of(a);
    const Cloud cloud = cloud_of(b);
    if (points.cols() < static_cast<Eigen::Index>(kFewestPoints) ||
        cloud.points.size() < kFewestPoints) {
      return result;
    }
    Tree tree(3, cloud, nanoflann::KDTreeSingleIndexAdaptorParams(kLeaf));
    tree.buildIndex();
    Eigen::Matrix3Xd nearest(3, points.cols());
    while (result.iterations < limits_.max_iterations && !result.converged) {
      ++result.iterations;
      const Eigen::Matrix3Xd moved = result.b_from_a * points;
      result.residual = match(moved, cloud, tree, nearest);
      const Pose step(Eigen::umeyama(moved, nearest, false));
      result.b_from_a = step * result.b_from_a;
      result.converged = limits_.reached_by(log_se3(step));
    }
    result.accepted = result.converged;
    return result;
  }

 private:
  const IterationLimits limits_;
};

}  // namespace

std::unique_ptr<Registration> make_icp(const IterationLimits& limits) {
  return std::make_unique<Icp>(limits);
}

}  // namespace rprr
