// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core/mat.hpp>

namespace rprr {

struct CrackFilterOptions {
  /// Two depths belong to one surface if they differ by less than this share of the nearer one.
  float range = 0.05f;
  /// Side of the largest window, pixels, odd, 3 to 9: cracks are narrower than this.
  int largest_window = 7;
  bool cracks = true;
  bool ghosts = true;
};

/// The paper's "Post-Processing at the Decoder Side", for a warped depth image.
///
/// Cracks (adaptive median on invalid pixels only): a window of 3x3 pixels grows until the pixel is
/// closed in, that is, until along two of the four axes through it (horizontal, vertical, both
/// diagonals) the nearest valid pixels on both sides are within the window and belong to one
/// surface. Then it takes the median of the window's valid pixels. What is not closed in even
/// by the largest window is a disocclusion or lies beside one and stays open.
///
/// Ghosts (background seen through the foreground, or a stray pixel before it): a pixel is wrong if
/// more than half of its 3x3 neighbours are out of its range. The paper then takes "the median of
/// the neighbours which are not out of the range"; read as the range of the wrong centre that would
/// keep what is wrong, so here it is the range of the median of all valid neighbours: those within
/// it are one surface, and if they are more than half of all eight, their median replaces the
/// centre. Otherwise, and at the image's rim, the pixel stays. Neighbours without depth do not
/// vote.
///
/// Linear in the number of pixels. Keeps its buffers between frames; one object serves one thread.
class CrackFilter {
 public:
  explicit CrackFilter(CrackFilterOptions options = {});

  /// metres: CV_32FC1, 0 = nothing; mended in place. mended: CV_8UC1 of the same size, 255 where a
  /// value was replaced, else 0.
  void mend(cv::Mat& metres, cv::Mat& mended);

 private:
  void close_cracks(cv::Mat& metres, cv::Mat& mended);
  void remove_ghosts(cv::Mat& metres, cv::Mat& mended);

  CrackFilterOptions options_;
  cv::Mat before_;
  cv::Mat valid_;
  cv::Mat flags_;  // of one row
};

}  // namespace rprr
