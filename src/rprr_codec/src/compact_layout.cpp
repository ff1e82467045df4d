// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_codec/compact_layout.hpp"

#include <algorithm>
#include <opencv2/core.hpp>

namespace rprr {
namespace {

// Where each line of blocks goes, -1 where it is taken out; returns how many stay.
int renumber(std::vector<int>& lines) {
  int next = 0;
  for (int& line : lines) line = line == 0 ? -1 : next++;
  return next;
}

}  // namespace

CompactLayout::CompactLayout(const BlockMask& mask) {
  const BlockGrid& grid = mask.grid();
  std::vector<int> columns(static_cast<std::size_t>(grid.columns), 0);
  std::vector<int> rows(static_cast<std::size_t>(grid.rows), 0);
  for (int block = 0; block < grid.count(); ++block) {
    if (!mask[block]) continue;
    columns[static_cast<std::size_t>(block % grid.columns)] = 1;
    rows[static_cast<std::size_t>(block / grid.columns)] = 1;
  }
  const int width = renumber(columns);
  const int height = renumber(rows);
  used_ = BlockMask(BlockGrid(width * kBlockSide, height * kBlockSide));
  for (int block = 0; block < grid.count(); ++block) {
    if (!mask[block]) continue;
    const int column = columns[static_cast<std::size_t>(block % grid.columns)];
    const int row = rows[static_cast<std::size_t>(block / grid.columns)];
    const int target = used_.grid().index(column, row);
    used_.set(target);
    moves_.push_back({grid.rect(block), used_.grid().rect(target)});
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
