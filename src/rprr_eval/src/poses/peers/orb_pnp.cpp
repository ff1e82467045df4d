// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "rprr_eval/poses/peers.hpp"

namespace rprr {
namespace {

constexpr int kFeatures = 500;
constexpr int kFewestInliers = 12;
constexpr std::size_t kFewestMatches = 6;
constexpr float kPixels = 3.0f;
constexpr std::size_t kBytesPerFeature = 32 + 4;

struct Features {
  std::vector<cv::KeyPoint> points;
  cv::Mat descriptors;
};

Features features_of(const cv::Mat& bgr) {
  cv::Mat grey;
  cv::cvtColor(bgr, grey, cv::COLOR_BGR2GRAY);
  Features features;
  cv::ORB::create(kFeatures)->detectAndCompute(grey, cv::noArray(), features.points,
                                               features.descriptors);
  return features;
}

// Points of a in metres, and where b saw them.
struct Matches {
  std::vector<cv::Point3d> in_a;
  std::vector<cv::Point2d> at_b;
};

Matches match(const Features& a, const Features& b, const RgbdFrame& frame_a) {
  std::vector<cv::DMatch> pairs;
  cv::BFMatcher(cv::NORM_HAMMING, true).match(a.descriptors, b.descriptors, pairs);
  Matches matches;
  for (const cv::DMatch& pair : pairs) {
    const cv::Point2f from = a.points[static_cast<std::size_t>(pair.queryIdx)].pt;
    const double z = frame_a.depth.metres(cvRound(from.x), cvRound(from.y));
    if (z <= 0.0) continue;
    const Eigen::Vector3d p = frame_a.camera.unproject(from.x, from.y, z);
    matches.in_a.emplace_back(p.x(), p.y(), p.z());
    matches.at_b.emplace_back(b.points[static_cast<std::size_t>(pair.trainIdx)].pt);
  }
  return matches;
}

double rms_pixels(const Matches& matches, const std::vector<int>& inliers, const Camera& camera,
                  const Pose& b_from_a) {
  double sum = 0.0;
  for (const int i : inliers) {
    const cv::Point3d& p = matches.in_a[static_cast<std::size_t>(i)];
    const cv::Point2d& seen = matches.at_b[static_cast<std::size_t>(i)];
    const Eigen::Vector2d expected = camera.project(b_from_a * Eigen::Vector3d(p.x, p.y, p.z));
    sum += (expected - Eigen::Vector2d(seen.x, seen.y)).squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(inliers.size()));
}

class OrbPnp final : public Registration {
 public:
  std::string name() const override { return "orb_pnp"; }

  RegistrationResult align(const RgbdFrame& a, const RgbdFrame& b, const Pose& start) override {
    RegistrationResult result;
    result.b_from_a = start;
    if (a.bgr.empty() || b.bgr.empty()) return result;
    const Features of_a = features_of(a.bgr);
    const Features of_b = features_of(b.bgr);
    result.bytes = of_b.points.size() * kBytesPerFeature;
    if (of_a.points.empty() || of_b.points.empty()) return result;
    const Matches matches = match(of_a, of_b, a);
    if (matches.in_a.size() < kFewestMatches) return result;
    const cv::Matx33d k(b.camera.fx, 0, b.camera.cx, 0, b.camera.fy, b.camera.cy, 0, 0, 1);
    cv::Vec3d turn;
    cv::Vec3d shift;
    std::vector<int> inliers;
    if (!cv::solvePnPRansac(matches.in_a, matches.at_b, k, cv::noArray(), turn, shift, false, 1000,
                            kPixels, 0.999, inliers) ||
        inliers.empty()) {
      return result;
    }
    const Eigen::Vector3d axis(turn[0], turn[1], turn[2]);
    const double angle = axis.norm();
    result.b_from_a = Pose::Identity();
    result.b_from_a.translation() = Eigen::Vector3d(shift[0], shift[1], shift[2]);
    if (angle > 1e-12) result.b_from_a.rotate(Eigen::AngleAxisd(angle, axis / angle));
    result.iterations = 1;
    result.converged = static_cast<int>(inliers.size()) >= kFewestInliers;
    result.accepted = result.converged;
    result.residual = rms_pixels(matches, inliers, b.camera, result.b_from_a);
    return result;
  }
};

}  // namespace

PeerResult make_orb_pnp() {
  return PeerResult(std::make_unique<OrbPnp>());
}

}  // namespace rprr
