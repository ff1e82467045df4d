// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_codec/fill.hpp"
#include "rprr_geometry/block_mask.hpp"

#include <algorithm>
#include <cstddef>
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

// Unsent cells start as bilinear samples of the level above. Stretches begin at even cells.
void enlarge(const cv::Mat& coarse, cv::Mat& fine, int shift, const BlockMask& sent,
             std::vector<std::uint16_t>& blend) {
  blend.resize(static_cast<std::size_t>(coarse.cols + 2) * kChannels);
  std::uint16_t* const mixed = blend.data() + kChannels;  // a cell of margin on both sides
  for_each_unsent(fine, shift, sent, [&](int v, int first, int end) {
    const int near_v = v / 2;
    const int far_v = std::clamp(near_v + (v % 2 != 0 ? 1 : -1), 0, coarse.rows - 1);
    const auto* near_row = coarse.ptr<std::uint8_t>(near_v);
    const auto* far_row = coarse.ptr<std::uint8_t>(far_v);
    const int from = std::max(first / 2 - 1, 0) * kChannels;
    const int to = std::min(end / 2 + 1, coarse.cols) * kChannels;
    for (int i = from; i < to; ++i) {
      mixed[i] = static_cast<std::uint16_t>(3 * near_row[i] + far_row[i]);
    }
    for (int c = 0; c < kChannels; ++c) {
      mixed[c - kChannels] = mixed[c];
      mixed[coarse.cols * kChannels + c] = mixed[(coarse.cols - 1) * kChannels + c];
    }
    auto* out = fine.ptr<std::uint8_t>(v) + kChannels * first;
    for (int u = first; u + 1 < end; u += 2, out += 2 * kChannels) {
      const std::uint16_t* at = mixed + kChannels * (u / 2);
      for (int c = 0; c < kChannels; ++c) {
        const int centre = 3 * at[c] + 8;
        out[c] = static_cast<std::uint8_t>((centre + at[c - kChannels]) >> 4);
        out[c + kChannels] = static_cast<std::uint8_t>((centre + at[c + kChannels]) >> 4);
      }
    }
    if ((end - first) % 2 == 0) return;
    const std::uint16_t* at = mixed + kChannels * (end / 2);
    for (int c = 0; c < kChannels; ++c) {
      out[c] = static_cast<std::uint8_t>((3 * at[c] + at[c - kChannels] + 8) >> 4);
    }
  });
}

// One sweep of the Laplace equation over unsent cells; sent cells and the image's rim hold. The
// means are of two, one rounded up and one down, so that sixteen fit into a register.
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
      const int vertical = (north[i] + south[i] + 1) >> 1;
      const int horizontal = (row[i - kChannels] + row[i + kChannels]) >> 1;
      line[i] = static_cast<std::uint8_t>((vertical + horizontal + 1) >> 1);
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

// The block level in fixed point, with a rim of one cell that repeats the outermost.
struct BlockField {
  int columns = 0;
  int rows = 0;
  std::vector<std::int16_t> colour;
  std::vector<std::int16_t> held;  // all bits set where the colour holds
  std::vector<std::int16_t> line;

  BlockField(int columns_wanted, int rows_wanted)
      : columns(columns_wanted),
        rows(rows_wanted),
        colour(static_cast<std::size_t>(stride()) * (rows + 2)),
        held(colour.size()),
        line(static_cast<std::size_t>(stride())) {}

  int stride() const { return (columns + 2) * kChannels; }
  std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row + 1) * stride() + (column + 1) * kChannels;
  }

  void repeat_rim(int row) {
    for (std::size_t c = 0; c < kChannels; ++c) {
      colour[index(-1, row) + c] = colour[index(0, row) + c];
      colour[index(columns, row) + c] = colour[index(columns - 1, row) + c];
    }
    const auto from = colour.begin() + static_cast<std::ptrdiff_t>(index(-1, row));
    if (row == 0) std::copy_n(from, stride(), colour.begin());
    if (row == rows - 1) std::copy_n(from, stride(), from + stride());
  }

  // Each cell that does not hold becomes the mean of its four neighbours, of which the row before
  // is new already.
  void relax_row(int row) {
    repeat_rim(row);
    std::int16_t* const here = colour.data() + index(0, row);
    const std::int16_t* const hold = held.data() + index(0, row);
    const std::int16_t* const north = here - stride();
    const std::int16_t* const south = here + stride();
    std::int16_t* const mean = line.data();
    const int count = columns * kChannels;
    for (int i = 0; i < count; ++i) {
      mean[i] = static_cast<std::int16_t>(
          (north[i] + south[i] + here[i - kChannels] + here[i + kChannels] + 2) >> 2);
    }
    for (int i = 0; i < count; ++i) {
      here[i] = static_cast<std::int16_t>((here[i] & hold[i]) | (mean[i] & ~hold[i]));
    }
  }

  void relax() {
    for (int row = 0; row < rows; ++row) repeat_rim(row);
    for (int sweep = 0; sweep < kBlockSweeps; ++sweep) {
      for (int i = 0; i < rows; ++i) relax_row(sweep % 2 == 0 ? i : rows - 1 - i);
    }
  }
};

// Colours the unsent cells of the block level.
void fill_blocks(cv::Mat& blocks, const BlockMask& sent) {
  constexpr int kFraction = 16;  // 255 * 16 * 4 is below 2^15
  FloatLevel level;
  level.columns = blocks.cols;
  level.rows = blocks.rows;
  for (int v = 0; v < blocks.rows; ++v) {
    const auto* row = blocks.ptr<std::uint8_t>(v);
    level.colour.insert(level.colour.end(), row, row + kChannels * blocks.cols);
  }
  for (int block = 0; block < sent.grid().count(); ++block) {
    level.weight.push_back(sent[block] ? 1.0f : 0.0f);
  }
  push_pull(level);
  BlockField field(blocks.cols, blocks.rows);
  for (int v = 0, block = 0; v < blocks.rows; ++v) {
    for (int u = 0; u < blocks.cols; ++u, ++block) {
      for (std::size_t c = 0; c < kChannels; ++c) {
        const std::size_t at = static_cast<std::size_t>(block) * kChannels + c;
        field.colour[field.index(u, v) + c] =
            static_cast<std::int16_t>(level.colour[at] * kFraction + 0.5f);
        field.held[field.index(u, v) + c] = sent[block] ? -1 : 0;
      }
    }
  }
  field.relax();
  for (int v = 0; v < blocks.rows; ++v) {
    auto* row = blocks.ptr<std::uint8_t>(v);
    const std::int16_t* from = field.colour.data() + field.index(0, v);
    for (int i = 0; i < blocks.cols * kChannels; ++i) {
      row[i] = static_cast<std::uint8_t>((from[i] + kFraction / 2) / kFraction);
    }
  }
}

// Each unsent block in the one colour that the block level has for it.
void paint(const cv::Mat& blocks, cv::Mat& bgr, int side, const BlockMask& sent) {
  const cv::Rect whole({0, 0}, bgr.size());
  for (int v = 0, block = 0; v < blocks.rows; ++v) {
    for (int u = 0; u < blocks.cols; ++u, ++block) {
      if (sent[block]) continue;
      const auto& colour = blocks.at<cv::Vec3b>(v, u);
      bgr(cv::Rect(u * side, v * side, side, side) & whole) =
          cv::Scalar(colour[0], colour[1], colour[2]);
    }
  }
}

}  // namespace

void SmoothFill::fill_in_place(cv::Mat& bgr, const BlockMask& known, int reduction, bool flat) {
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
  if (flat) paint(levels_[kBlockLevel], bgr, kBlockSide / reduction, known);
  for (int k = kBlockLevel - 1; k >= finest && !flat; --k) {
    cv::Mat& level = levels_[static_cast<std::size_t>(k)];
    enlarge(levels_[static_cast<std::size_t>(k) + 1], level, k, known, blend_);
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
