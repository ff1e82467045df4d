// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_codec/compact_layout.hpp"

#include <algorithm>
#include <opencv2/core.hpp>

#include "block_packing.hpp"
#include "rprr_geometry/block_mask.hpp"

namespace rprr {

CompactLayout::CompactLayout(const BlockMask& mask) {
  const BlockPacking packing = packed(mask);
  used_ = BlockMask(BlockGrid(packing.size.width * kBlockSide, packing.size.height * kBlockSide));
  moves_.reserve(packing.blocks.size());
  for (std::size_t i = 0; i < packing.blocks.size(); ++i) {
    const int target = used_.grid().index(packing.to[i].x, packing.to[i].y);
    used_.set(target);
    moves_.push_back({mask.grid().rect(packing.blocks[i]), used_.grid().rect(target)});
  }
}

void CompactLayout::gather(const cv::Mat& bgr, cv::Mat& compact) const {
  compact.create(size(), CV_8UC3);
  for (const Move& move : moves_) {
    for (int v = 0; v < kBlockSide; ++v) {
      const auto* from = bgr.ptr<cv::Vec3b>(move.whole.y + std::min(v, move.whole.height - 1));
      auto* to = compact.ptr<cv::Vec3b>(move.compact.y + v) + move.compact.x;
      std::copy_n(from + move.whole.x, move.whole.width, to);
      std::fill(to + move.whole.width, to + kBlockSide, to[move.whole.width - 1]);
    }
  }
}

void CompactLayout::scatter(const cv::Mat& compact, cv::Mat& bgr) const {
  for (const Move& move : moves_) {
    for (int v = 0; v < move.whole.height; ++v) {
      const auto* from = compact.ptr<cv::Vec3b>(move.compact.y + v) + move.compact.x;
      std::copy_n(from, move.whole.width, bgr.ptr<cv::Vec3b>(move.whole.y + v) + move.whole.x);
    }
  }
}

}  // namespace rprr
