// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core/mat.hpp>
#include <vector>

#include "rprr_view/base_fill.hpp"
#include "rprr_view/base_image.hpp"
#include "rprr_view/view_synthesis.hpp"

namespace rprr {

/// Joins a prediction with the base that the dependent sent: per frequency band and place, each
/// counts by what is known of its error.
///
/// Both are split into octaves. In a band that the base has, its difference from the prediction, D,
/// is the prediction's error plus the base's coding noise, of known variance N. The linear estimate
/// with the least squared error adds max(0, 1 - N / var(D)) D to the prediction, var(D) measured
/// around each place (Wiener's filter; steeper here, and N no larger than the octave's own strength
/// allows, so that a good base is hardly ever made worse). So where they agree within the noise the
/// prediction's clean detail stays, where they do not (light, occlusion, what moved) the base wins.
/// In finer bands there is only the prediction; it keeps as much of its detail as its finest band
/// in common agrees, in pattern and strength, with the joint estimate there.
///
/// Keeps its buffers between frames; one object serves one thread.
class BaseFusion {
 public:
  /// Replaces view.bgr by the joint estimate; pixels that were not predicted take the base alone,
  /// with provenance kBase; so do all where the base is of full size and hardly has an error. base
  /// must fit the view's size.
  void fuse(const BaseImage& base, PredictedView& view);

 private:
  struct Level {
    cv::Mat prediction;  // CV_32FC4
    cv::Mat difference;  // CV_32FC4: base minus prediction
    cv::Mat joint;       // CV_32FC4: what to add to the prediction, then the estimate itself
    cv::Mat energy;      // CV_32FC1, of the next coarser size: mean square of the octave
    cv::Mat signal;      // CV_32FC1: signal energy of prediction or base, whichever has more
    cv::Mat share;       // CV_32FC1: how much of the difference counts, 0 to 1
  };

  void compare(const BaseImage& base, std::size_t base_level, std::size_t coarsest,
               const cv::Mat& bgr);
  void join(std::size_t base_level, std::size_t coarsest, const BaseImage& base);
  void weigh(std::size_t level, float variance);
  float most_of_some(const cv::Mat& values);
  void weigh_finer_detail(std::size_t base_level);
  void rest_beyond_base(std::size_t level);
  void finish_beyond_base(cv::Mat& bgr);
  void finish_at_base(const BaseImage& base, PredictedView& view);

  BaseFill base_fill_;
  std::vector<Level> levels_;  // level k has cells of 2^k pixels; of 0 only energy and share
  cv::Mat rest_;               // CV_32FC4: what is to be added, and a weight
  cv::Mat mixed_;              // CV_32FC4, a row
  cv::Mat floats_;             // CV_32FC1, rows of colours
  cv::Mat agreement_[3];       // CV_32FC1: variances of prediction and estimate, covariance
  cv::Mat smoothed_;
  std::vector<float> sample_;
};

}  // namespace rprr
