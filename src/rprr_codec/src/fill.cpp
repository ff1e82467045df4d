// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_codec/fill.hpp"

#include <algorithm>
#include <opencv2/core.hpp>

namespace rprr {
namespace {

constexpr int kBlockLevel = 3;  // cells of this level are blocks
constexpr int kChannels = 3;
constexpr int kBlockSweeps = 24;
constexpr int kPixelSweeps = 2;  // at each level below

int half(int size) {
  return (size + 1) / 2;
}

// Means of 2x2 cells, all of them: unsent ones are overwritten later.
void reduce(const cv::Mat& fine, cv::Mat& coarse) {
  coarse.create(half(fine.rows), half(fine.cols), CV_8UC3);
  for (int v = 0; v < coarse.rows; ++v) {
    const auto* upper = fine.ptr<std::uint8_t>(2 * v);
    const auto* lower = fine.ptr<std::uint8_t>(std::min(2 * v + 1, fine.rows - 1));
    auto* out = coarse.ptr<std::uint8_t>(v);
    const int pairs = fine.cols / 2;
    for (int u = 0; u < pairs; ++u) {
      for (int c = 0; c < kChannels; ++c) {
        const int i = 2 * kChannels * u + c;
        out[kChannels * u + c] = static_cast<std::uint8_t>(
            (upper[i] + upper[i + kChannels] + lower[i] + lower[i + kChannels] + 2) >> 2);
      }
    }
    if (pairs < coarse.cols) {
      for (int c = 0; c < kChannels; ++c) {
        const int i = 2 * kChannels * pairs + c;
        out[kChannels * pairs + c] = static_cast<std::uint8_t>((upper[i] + lower[i] + 1) >> 1);
      }
    }
  }
}

// Calls visit(row, first, end) for stretches of unsent cells of a level, in row order.
template <typename Visit>
void for_each_unsent(const cv::Mat& level, int shift, const BlockMask& sent, const Visit& visit) {
  const BlockGrid& grid = sent.grid();
  const int side = kBlockSide >> shift;
  for (int v = 0; v < level.rows; ++v) {
    const int row = v / side;
    for (int column = 0; column < grid.columns;) {
      if (sent[grid.index(column, row)]) {
        ++column;
        continue;
      }
      const int first = column;
      while (column < grid.columns && !sent[grid.index(column, row)]) ++column;
      visit(v, first * side, std::min(column * side, level.cols));
    }
  }
}

// Unsent cells start as bilinear samples of the level above.
void enlarge(const cv::Mat& coarse, cv::Mat& fine, int shift, const BlockMask& sent) {
  for_each_unsent(fine, shift, sent, [&](int v, int first, int end) {
    const int near_v = v / 2;
    const int far_v = std::clamp(near_v + (v % 2 != 0 ? 1 : -1), 0, coarse.rows - 1);
    const auto* near_row = coarse.ptr<std::uint8_t>(near_v);
    const auto* far_row = coarse.ptr<std::uint8_t>(far_v);
    auto* out = fine.ptr<std::uint8_t>(v);
    for (int u = first; u < end; ++u) {
      const int near_u = kChannels * (u / 2);
      const int far_u = kChannels * std::clamp(u / 2 + (u % 2 != 0 ? 1 : -1), 0, coarse.cols - 1);
      for (int c = 0; c < kChannels; ++c) {
        out[kChannels * u + c] = static_cast<std::uint8_t>(
            (9 * near_row[near_u + c] + 3 * (near_row[far_u + c] + far_row[near_u + c]) +
             far_row[far_u + c] + 8) >>
            4);
      }
    }
  });
}

// One sweep of the Laplace equation over unsent cells; sent cells and the image's rim hold.
void relax(cv::Mat& level, int shift, const BlockMask& sent, std::vector<std::uint8_t>& scratch) {
  scratch.resize(static_cast<std::size_t>(level.cols) * kChannels);
  std::uint8_t* const line = scratch.data();
  for_each_unsent(level, shift, sent, [&](int v, int first, int end) {
    auto* const row = level.ptr<std::uint8_t>(v);
    const auto* const north = level.ptr<std::uint8_t>(std::max(v - 1, 0));
    const auto* const south = level.ptr<std::uint8_t>(std::min(v + 1, level.rows - 1));
    const int begin_inner = std::max(first, 1) * kChannels;
    const int end_inner = std::min(end, level.cols - 1) * kChannels;
    for (int i = begin_inner; i < end_inner; ++i) {
      line[i] = static_cast<std::uint8_t>(
          (north[i] + south[i] + row[i - kChannels] + row[i + kChannels] + 2) >> 2);
    }
    if (begin_inner < end_inner) std::copy(line + begin_inner, line + end_inner, row + begin_inner);
  });
}

// Colours of unsent blocks of a float grid from a grid of half its size, recursively; weight 0
// marks a block without colour.
struct FloatLevel {
  int columns = 0;
  int rows = 0;
  std::vector<float> colour;
  std::vector<float> weight;
};

void push_pull(FloatLevel& fine) {
  if (fine.columns == 1 && fine.rows == 1) return;
  FloatLevel coarse;
  coarse.columns = half(fine.columns);
  coarse.rows = half(fine.rows);
  const auto cells = static_cast<std::size_t>(coarse.columns) * coarse.rows;
  coarse.colour.assign(cells * kChannels, 0.0f);
  coarse.weight.assign(cells, 0.0f);
  const auto parent = [&](int u, int v) {
    return static_cast<std::size_t>(v / 2) * coarse.columns + u / 2;
  };
  for (int v = 0, i = 0; v < fine.rows; ++v) {
    for (int u = 0; u < fine.columns; ++u, ++i) {
      const auto cell = static_cast<std::size_t>(i);
      coarse.weight[parent(u, v)] += fine.weight[cell];
      for (std::size_t c = 0; c < kChannels; ++c) {
        coarse.colour[parent(u, v) * kChannels + c] +=
            fine.weight[cell] * fine.colour[cell * kChannels + c];
      }
    }
  }
  for (std::size_t cell = 0; cell < cells; ++cell) {
    if (coarse.weight[cell] == 0.0f) continue;
    for (std::size_t c = 0; c < kChannels; ++c) {
      coarse.colour[cell * kChannels + c] /= coarse.weight[cell];
    }
    coarse.weight[cell] = std::min(coarse.weight[cell], 1.0f);
  }
  push_pull(coarse);
  for (int v = 0, i = 0; v < fine.rows; ++v) {
    for (int u = 0; u < fine.columns; ++u, ++i) {
      const auto cell = static_cast<std::size_t>(i);
      if (fine.weight[cell] > 0.0f) continue;
      for (std::size_t c = 0; c < kChannels; ++c) {
        fine.colour[cell * kChannels + c] = coarse.colour[parent(u, v) * kChannels + c];
      }
    }
  }
}

void relax_blocks(FloatLevel& level) {
  const int columns = level.columns;
  for (int v = 0; v < level.rows; ++v) {
    for (int u = 0; u < columns; ++u) {
      const auto at = [&](int x, int y) {
        return (static_cast<std::size_t>(std::clamp(y, 0, level.rows - 1)) * columns +
                static_cast<std::size_t>(std::clamp(x, 0, columns - 1)));
      };
      if (level.weight[at(u, v)] > 0.0f) continue;
      for (std::size_t c = 0; c < kChannels; ++c) {
        const auto colour = [&](int x, int y) { return level.colour[at(x, y) * kChannels + c]; };
        level.colour[at(u, v) * kChannels + c] =
            0.25f * (colour(u - 1, v) + colour(u + 1, v) + colour(u, v - 1) + colour(u, v + 1));
      }
    }
  }
}

// Colours the unsent cells of the block level.
void fill_blocks(cv::Mat& blocks, const BlockMask& sent) {
  FloatLevel level;
  level.columns = blocks.cols;
  level.rows = blocks.rows;
  const auto cells = static_cast<std::size_t>(blocks.cols) * blocks.rows;
  level.weight.resize(cells);
  level.colour.resize(cells * kChannels);
  for (std::size_t cell = 0; cell < cells; ++cell) {
    level.weight[cell] = sent[static_cast<int>(cell)] ? 1.0f : 0.0f;
    for (std::size_t c = 0; c < kChannels; ++c) {
      level.colour[cell * kChannels + c] = blocks.data[cell * kChannels + c];
    }
  }
  push_pull(level);
  for (int sweep = 0; sweep < kBlockSweeps; ++sweep) relax_blocks(level);
  for (std::size_t i = 0; i < cells * kChannels; ++i) {
    blocks.data[i] = cv::saturate_cast<std::uint8_t>(level.colour[i]);
  }
}

}  // namespace

void SmoothFill::fill_in_place(cv::Mat& bgr, const BlockMask& known, int reduction) {
  const int count = known.count();
  if (count == 0) bgr.setTo(cv::Scalar::all(0));
  if (count == 0 || count == known.grid().count()) return;
  int finest = 0;
  while (1 << finest < reduction) ++finest;
  levels_[static_cast<std::size_t>(finest)] = bgr;
  for (auto k = static_cast<std::size_t>(finest); k < kBlockLevel; ++k) {
    reduce(levels_[k], levels_[k + 1]);
  }
  fill_blocks(levels_[kBlockLevel], known);
  for (int k = kBlockLevel - 1; k >= finest; --k) {
    cv::Mat& level = levels_[static_cast<std::size_t>(k)];
    enlarge(levels_[static_cast<std::size_t>(k) + 1], level, k, known);
    for (int sweep = 0; sweep < kPixelSweeps; ++sweep) relax(level, k, known, scratch_);
  }
  levels_[static_cast<std::size_t>(finest)].release();
}

cv::Mat SmoothFill::fill(const cv::Mat& bgr, const BlockMask& sent) {
  cv::Mat filled = bgr.clone();
  fill_in_place(filled, sent);
  return filled;
}

void black_out(cv::Mat& bgr, const BlockMask& known, int reduction) {
  int shift = 0;
  while (1 << shift < reduction) ++shift;
  for_each_unsent(bgr, shift, known, [&](int v, int first, int end) {
    auto* row = bgr.ptr<std::uint8_t>(v);
    std::fill(row + kChannels * first, row + kChannels * end, std::uint8_t{0});
  });
}

cv::Mat black_fill(const cv::Mat& bgr, const BlockMask& sent) {
  cv::Mat filled = bgr.clone();
  black_out(filled, sent);
  return filled;
}

}  // namespace rprr
