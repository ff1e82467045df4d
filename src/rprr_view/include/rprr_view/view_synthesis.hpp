// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "rprr_geometry/camera.hpp"
#include "rprr_geometry/depth_frame.hpp"
#include "rprr_geometry/pixel_map.hpp"
#include "rprr_geometry/se3.hpp"
#include "rprr_geometry/warp.hpp"
#include "rprr_view/base_image.hpp"
#include "rprr_view/crack_filter.hpp"
#include "rprr_view/image_alignment.hpp"
#include "rprr_view/provenance.hpp"

namespace rprr {

enum class Synthesis {
  kForward,   // the paper: colour travels with its depth pixel; only mended pixels are fetched
  kBackward,  // every pixel's colour is fetched from the reference image, bilinearly
};

struct SynthesisOptions {
  Synthesis mode = Synthesis::kBackward;
  /// Fetched backwards, a pixel of the reference shows the same surface if its depth differs by
  /// less than this share.
  float surface_tolerance = 0.05f;
  /// Fetched backwards and with a base: fetch from where the reference looks like the base.
  bool align = true;
  CrackFilterOptions crack_filter;
};

/// The reference's frame as the dependent camera would see it: the paper's Z_b* and C_b*.
struct PredictedView {
  cv::Mat bgr;         // CV_8UC3; black where nothing is predicted
  cv::Mat metres;      // CV_32FC1; 0 where nothing is predicted
  cv::Mat provenance;  // CV_8UC1: kNothing, kPredicted or kMended
};

/// Warps depth, mends it, then finds the colours. Keeps its buffers between frames; one object
/// serves one thread.
class ViewSynthesizer {
 public:
  explicit ViewSynthesizer(SynthesisOptions options = {});

  /// a, a_bgr (CV_8UC3, continuous): the reference frame as decoded, both of a_camera's size.
  /// b_from_a maps points of a's optical frame into b's. base: b's, which must fit b_camera, or
  /// null. view is reused between calls. A frame that has not its camera's size predicts nothing.
  void synthesize(const DepthFrame& a, const cv::Mat& a_bgr, const Camera& a_camera,
                  const Camera& b_camera, const Pose& b_from_a, PredictedView& view,
                  const BaseImage* base = nullptr);

 private:
  void align(const cv::Mat& a_bgr, const PixelMap& to_a, const BaseImage& base,
             const cv::Mat& metres);
  const float* shift_row(int v, const cv::Mat& metres, float* column, float* row);
  void fetch_row(const class Fetcher& fetcher, const PixelMap& to_a, int v, PredictedView& view);

  SynthesisOptions options_;
  CrackFilter crack_filter_;
  ImageAlignment alignment_;
  WarpedDepth warped_;
  cv::Mat shifts_;                                      // empty: none
  cv::Mat a_brightness_, brightness_, valid_, wanted_;  // of a quarter of the size
  std::vector<std::uint16_t> sums_;
  cv::Mat rows_;    // CV_32FC1, a few rows of numbers
  cv::Mat places_;  // CV_32SC1, kept between calls
  cv::Mat shows_;   // CV_8UC1, a row of flags
};

}  // namespace rprr
