// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core/mat.hpp>
#include <optional>

#include "rprr_geometry/block_mask.hpp"
#include "rprr_geometry/camera.hpp"
#include "rprr_geometry/depth_frame.hpp"
#include "rprr_geometry/se3.hpp"

namespace rprr {

/// Peak signal-to-noise ratio of two CV_8UC3 images over all channels, dB, at most 99; over the
/// pixels where mask (CV_8UC1) is not 0, if one is given. Nothing if no pixel counts.
std::optional<double> psnr(const cv::Mat& image, const cv::Mat& truth, const cv::Mat& mask = {});

/// Structural similarity (Wang et al. 2004) of the luma: Gaussian window of sigma 1.5, mean over
/// the image.
double ssim(const cv::Mat& image, const cv::Mat& truth);

/// Rebuilt depth against b's own, over pixels where b has depth.
struct DepthQuality {
  double rmse_mm = 0.0;   // over pixels where both have depth
  double coverage = 0.0;  // share of b's valid pixels that are rebuilt
};
DepthQuality depth_quality(const DepthFrame& rebuilt, const DepthFrame& truth);

/// Depth that a station derived instead of receiving it, against b's own: over pixels outside of
/// the received blocks where both have depth.
struct PredictedDepthQuality {
  std::size_t pixels = 0;
  double relative_rmse = 0.0;  // of the difference over b's depth
  double share_off = 0.0;      // off by more than 5%
};
/// received: the blocks whose depth is b's own; an empty mask: all of them.
PredictedDepthQuality predicted_depth_quality(const DepthFrame& rebuilt, const DepthFrame& truth,
                                              const BlockMask& received);

/// Two depths [m] that differ by less are taken for one surface: 2 cm for the truth's error, and
/// 1.5% for what the sensor's noise grows to.
constexpr double same_surface_within(double metres) {
  return 0.02 + 0.015 * metres;
}

/// Share of a's valid block-centre pixels whose surface b sees under the true pose: they project
/// into b on a valid depth that differs by less than same_surface_within().
double overlap(const DepthFrame& a, const Camera& a_camera, const DepthFrame& b,
               const Camera& b_camera, const Pose& b_from_a);

/// How far an estimate of M_ab is off.
struct PoseError {
  double metres = 0.0;  // between the two positions of camera b in a's frame
  double degrees = 0.0;
};
PoseError pose_error(const Pose& estimate, const Pose& truth);

/// Poses count as right (under 8 cm and 3 deg) and as wrong (over 16 cm or 6 deg) with a gap
/// between, since the ground truth has its own error.
bool is_right(const PoseError& error);
bool is_wrong(const PoseError& error);

}  // namespace rprr
