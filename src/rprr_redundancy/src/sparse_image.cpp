// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_redundancy/sparse_image.hpp"
#include "rprr_geometry/block_mask.hpp"

#include <opencv2/core.hpp>

namespace rprr {

Result<cv::Mat> keep_blocks(const cv::Mat& image, const BlockMask& mask) {
  const BlockGrid& grid = mask.grid();
  if (image.cols != grid.width || image.rows != grid.height) {
    return Error{"the image has not the size of the block mask"};
  }
  cv::Mat kept = cv::Mat::zeros(image.size(), image.type());
  for (int block = 0; block < grid.count(); ++block) {
    if (!mask[block]) continue;
    const cv::Rect rect = grid.rect(block);
    image(rect).copyTo(kept(rect));
  }
  return kept;
}

}  // namespace rprr
