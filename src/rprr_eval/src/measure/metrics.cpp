// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_eval/measure/metrics.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "rprr_geometry/block_grid.hpp"
#include "rprr_geometry/block_mask.hpp"

namespace rprr {
namespace {

constexpr double kRadian = 180.0 / M_PI;

}  // namespace

std::optional<double> psnr(const cv::Mat& image, const cv::Mat& truth, const cv::Mat& mask) {
  double sum = 0.0;
  std::size_t count = 0;
  for (int v = 0; v < truth.rows; ++v) {
    const auto* p = image.ptr<std::uint8_t>(v);
    const auto* q = truth.ptr<std::uint8_t>(v);
    for (int u = 0; u < truth.cols; ++u) {
      if (!mask.empty() && mask.at<std::uint8_t>(v, u) == 0) continue;
      for (int channel = 3 * u; channel < 3 * u + 3; ++channel) {
        const int difference = p[channel] - q[channel];
        sum += difference * difference;
      }
      count += 3;
    }
  }
  if (count == 0) return std::nullopt;
  const double mse = sum / static_cast<double>(count);
  return mse > 0.0 ? std::min(99.0, 10.0 * std::log10(255.0 * 255.0 / mse)) : 99.0;
}

double ssim(const cv::Mat& image, const cv::Mat& truth) {
  constexpr double kC1 = 0.01 * 255 * 0.01 * 255;
  constexpr double kC2 = 0.03 * 255 * 0.03 * 255;
  const auto luma = [](const cv::Mat& bgr) {
    cv::Mat grey;
    cv::cvtColor(bgr, grey, cv::COLOR_BGR2GRAY);
    cv::Mat out;
    grey.convertTo(out, CV_32F);
    return out;
  };
  const auto blurred = [](const cv::Mat& in) {
    cv::Mat out;
    cv::GaussianBlur(in, out, {11, 11}, 1.5);
    return out;
  };
  const cv::Mat x = luma(image);
  const cv::Mat y = luma(truth);
  const cv::Mat mean_x = blurred(x);
  const cv::Mat mean_y = blurred(y);
  const cv::Mat var_x = blurred(x.mul(x)) - mean_x.mul(mean_x);
  const cv::Mat var_y = blurred(y.mul(y)) - mean_y.mul(mean_y);
  const cv::Mat covariance = blurred(x.mul(y)) - mean_x.mul(mean_y);
  const cv::Mat above = (2 * mean_x.mul(mean_y) + kC1).mul(2 * covariance + kC2);
  const cv::Mat below = (mean_x.mul(mean_x) + mean_y.mul(mean_y) + kC1).mul(var_x + var_y + kC2);
  cv::Mat ratio;
  cv::divide(above, below, ratio);
  return cv::mean(ratio)[0];
}

DepthQuality depth_quality(const DepthFrame& rebuilt, const DepthFrame& truth) {
  double sum = 0.0;
  std::size_t valid = 0;
  std::size_t covered = 0;
  for (int v = 0; v < truth.height(); ++v) {
    for (int u = 0; u < truth.width(); ++u) {
      const double expected = truth.metres(u, v);
      if (expected <= 0.0) continue;
      ++valid;
      const double found = rebuilt.metres(u, v);
      if (found <= 0.0) continue;
      ++covered;
      sum += (found - expected) * (found - expected);
    }
  }
  DepthQuality quality;
  if (covered > 0) quality.rmse_mm = 1e3 * std::sqrt(sum / static_cast<double>(covered));
  if (valid > 0) quality.coverage = static_cast<double>(covered) / static_cast<double>(valid);
  return quality;
}

PredictedDepthQuality predicted_depth_quality(const DepthFrame& rebuilt, const DepthFrame& truth,
                                              const BlockMask& received) {
  PredictedDepthQuality quality;
  if (received.empty()) return quality;
  double sum = 0.0;
  std::size_t off = 0;
  for (int v = 0; v < truth.height(); ++v) {
    for (int u = 0; u < truth.width(); ++u) {
      if (received[received.grid().index_of_pixel(u, v)]) continue;
      const double expected = truth.metres(u, v);
      const double found = rebuilt.metres(u, v);
      if (expected <= 0.0 || found <= 0.0) continue;
      const double relative = (found - expected) / expected;
      ++quality.pixels;
      sum += relative * relative;
      off += std::abs(relative) > 0.05 ? 1 : 0;
    }
  }
  if (quality.pixels == 0) return quality;
  quality.relative_rmse = std::sqrt(sum / static_cast<double>(quality.pixels));
  quality.share_off = static_cast<double>(off) / static_cast<double>(quality.pixels);
  return quality;
}

double overlap(const DepthFrame& a, const Camera& a_camera, const DepthFrame& b,
               const Camera& b_camera, const Pose& b_from_a) {
  int valid = 0;
  int seen = 0;
  for (int v = kBlockSide / 2; v < a.height(); v += kBlockSide) {
    for (int u = kBlockSide / 2; u < a.width(); u += kBlockSide) {
      const double z = a.metres(u, v);
      if (z <= 0.0) continue;
      ++valid;
      const Eigen::Vector3d p = b_from_a * a_camera.unproject(u, v, z);
      if (p.z() <= 0.0) continue;
      const Eigen::Vector2d pixel = b_camera.project(p);
      if (!b_camera.contains(pixel.x(), pixel.y())) continue;
      const double measured =
          b.metres(std::min(static_cast<int>(std::floor(pixel.x() + 0.5)), b_camera.width - 1),
                   std::min(static_cast<int>(std::floor(pixel.y() + 0.5)), b_camera.height - 1));
      if (measured > 0.0 && std::abs(p.z() - measured) < same_surface_within(measured)) ++seen;
    }
  }
  return valid == 0 ? 0.0 : static_cast<double>(seen) / valid;
}

PoseError pose_error(const Pose& estimate, const Pose& truth) {
  const Pose difference = estimate * truth.inverse();
  return {(estimate.inverse().translation() - truth.inverse().translation()).norm(),
          kRadian * rotation_angle(difference.linear())};
}

bool is_right(const PoseError& error) {
  return error.metres < 0.08 && error.degrees < 3.0;
}

bool is_wrong(const PoseError& error) {
  return error.metres > 0.16 || error.degrees > 6.0;
}

}  // namespace rprr
