// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <vector>

namespace rprr {

/// Distrusts predicted depth beside depth edges: a pose that is off by a fraction of a degree puts
/// it on the wrong side of them, and of all that is wrong in a predicted depth image nearly all
/// lies there. Linear in the number of pixels. Keeps its buffers between frames; one object serves
/// one thread.
class DepthEdges {
 public:
  /// margin: pixels, 0 (nothing is done) to 8. jump: share of the nearer depth.
  explicit DepthEdges(int margin = 2, float jump = 0.05f);

  /// Sets those counts (CV_16UC1, 0 = none) to 0 where predicted (CV_8UC1, same size) is not 0 and
  /// depths within the margin, both ways, differ by more than the jump.
  void clear(cv::Mat& counts, const cv::Mat& predicted);

 private:
  void find_range(int v);
  void clear_row(const std::int16_t* near, const std::int16_t* far, const std::uint8_t* predicted,
                 int width, std::uint16_t* depth) const;

  int margin_;
  float jump_;
  cv::Mat nearest_, farthest_;                // CV_16SC1, within the margin along rows
  std::vector<std::int16_t> padded_, spare_;  // of a row
  std::vector<std::int16_t> near_, far_;      // of a row, in the whole window
};

}  // namespace rprr
