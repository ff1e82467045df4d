// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_wire/preview.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

// Works on a row of blocks at a time, in loops over whole rows of small integers that compilers
// turn into vector instructions, since every robot makes a preview of every frame.

namespace rprr {
namespace {

const cv::Vec3b kNoColour(128, 128, 128);
constexpr int kFewestReadings = 16;  // of the 64 of a block
constexpr int kFewestSampled = 3;    // of the 16 that the median looks at
constexpr int kSampled = 16;
constexpr int kSameSurface = 3;  // per cent of depth from the block's median

using Count = std::uint16_t;
using Key = std::int16_t;  // a count less 32768: vector units compare signed numbers only

constexpr Key key_of(int count) {
  return static_cast<Key>(count - 32768);
}

// The image rows of a row of blocks; those that a partial block lacks are empty.
template <typename T>
class BlockRows {
 public:
  explicit BlockRows(int length) : empty_(static_cast<std::size_t>(length), T{0}) {}
  void move_to(const cv::Mat& image, int first) {
    for (int v = 0; v < kBlockSide; ++v) {
      rows_[static_cast<std::size_t>(v)] =
          first + v < image.rows ? image.ptr<T>(first + v) : empty_.data();
    }
  }
  const T* operator[](int v) const { return rows_[static_cast<std::size_t>(v)]; }

 private:
  std::vector<T> empty_;
  std::array<const T*, kBlockSide> rows_{};
};

// Medians of every second pixel in both directions, all blocks of a row at once.
class Medians {
 public:
  explicit Medians(int columns)
      : columns_(columns), samples_(static_cast<std::size_t>(columns) * kSampled) {}

  void find(const BlockRows<Count>& rows, int width, std::vector<Count>& medians) {
    for (int k = 0; k < kSampled / 4; ++k) gather(rows[2 * k] + k % 2, width - k % 2, 4 * k);
    sort();
    for (int column = 0; column < columns_; ++column) {
      int missing = 0;  // sorted to the front
      while (missing < kSampled && sample(missing)[column] == key_of(0)) ++missing;
      const int found = kSampled - missing;
      medians[static_cast<std::size_t>(column)] =
          found < kFewestSampled ? Count{0}
                                 : static_cast<Count>(sample(missing + found / 2)[column] + 32768);
    }
  }

 private:
  Key* sample(int k) { return samples_.data() + k * columns_; }

  void gather(const Count* row, int length, int first) {
    const int whole = length / kBlockSide;
    Key *out0 = sample(first), *out1 = sample(first + 1);
    Key *out2 = sample(first + 2), *out3 = sample(first + 3);
    for (int column = 0; column < whole; ++column) {
      const Count* from = row + kBlockSide * column;
      out0[column] = key_of(from[0]);
      out1[column] = key_of(from[2]);
      out2[column] = key_of(from[4]);
      out3[column] = key_of(from[6]);
    }
    for (int column = whole; column < columns_; ++column) {
      for (int s = 0; s < 4; ++s) {
        const int u = kBlockSide * column + 2 * s;
        sample(first + s)[column] = key_of(u < length ? row[u] : 0);
      }
    }
  }

  // Batcher's odd-even merge sort: the same comparisons whatever the values.
  void sort() {
    for (int p = 1; p < kSampled; p *= 2) {
      for (int k = p; k >= 1; k /= 2) {
        for (int i = k % p; i + k < kSampled; ++i) {
          const bool compared = (i - k % p) % (2 * k) < k && i / (2 * p) == (i + k) / (2 * p);
          if (compared) order(sample(i), sample(i + k));
        }
      }
    }
  }
  void order(Key* low, Key* high) const {
    for (int column = 0; column < columns_; ++column) {
      const Key a = low[column];
      const Key b = high[column];
      low[column] = a < b ? a : b;
      high[column] = a < b ? b : a;
    }
  }

  int columns_;
  std::vector<Key> samples_;
};

// Over the readings of a block near its median m: how many, and the sums of d and d^2, d = z - m.
struct Near {
  int count = 0;
  int sum = 0;
  int squares = 0;
};

class NearSums {
 public:
  explicit NearSums(int columns)
      : columns_(columns),
        median_(padded(columns)),
        nearest_(padded(columns)),
        reach_(padded(columns)),
        distance_(padded(columns)),
        count_(padded(columns)),
        sum_(padded(columns)),
        squares_(padded(columns)) {}

  void add_up(const BlockRows<Count>& rows, int width, const std::vector<Count>& medians) {
    spread(medians);
    std::fill(count_.begin(), count_.end(), Key{0});
    std::fill(sum_.begin(), sum_.end(), Key{0});
    std::fill(squares_.begin(), squares_.end(), 0);
    for (int v = 0; v < kBlockSide; ++v) add_row(rows[v], width);
  }
  Near of(int column) const {
    Near near;
    const int first = column * kBlockSide;
    for (int u = first; u < first + kBlockSide; ++u) {
      const auto i = static_cast<std::size_t>(u);
      near.count += count_[i];
      near.sum += sum_[i];
      near.squares += squares_[i];
    }
    return near;
  }

 private:
  static std::size_t padded(int columns) { return static_cast<std::size_t>(columns) * kBlockSide; }
  void spread(const std::vector<Count>& medians) {
    for (int column = 0; column < columns_; ++column) {
      const int median = medians[static_cast<std::size_t>(column)];
      const int reach = median * kSameSurface / 100;
      const int farthest = std::min(median + reach, 65535);
      const auto first = static_cast<std::ptrdiff_t>(column) * kBlockSide;
      std::fill_n(median_.begin() + first, kBlockSide, static_cast<Count>(median));
      std::fill_n(nearest_.begin() + first, kBlockSide, static_cast<Count>(median - reach));
      std::fill_n(reach_.begin() + first, kBlockSide, key_of(farthest - median + reach));
    }
  }
  void add_row(const Count* row, int width) {
    const Count* median = median_.data();
    const Count* nearest = nearest_.data();
    const Key* reach = reach_.data();
    Key* count = count_.data();
    Key* sum = sum_.data();
    int* squares = squares_.data();
    Key* distance = distance_.data();
    for (int u = 0; u < width; ++u) {  // apart from the next, so that all numbers are of 16 bits
      const auto above = static_cast<Key>(static_cast<Count>(row[u] - nearest[u]) ^ 0x8000);
      const auto mask = static_cast<Key>(above <= reach[u] ? -1 : 0);
      distance[u] = static_cast<Key>(static_cast<Key>(row[u] - median[u]) & mask);
      count[u] = static_cast<Key>(count[u] - mask);
      sum[u] = static_cast<Key>(sum[u] + distance[u]);  // at most 8 times 3% of 65535
    }
    for (int u = 0; u < width; ++u) squares[u] += distance[u] * distance[u];
  }

  int columns_;
  std::vector<Count> median_, nearest_;
  std::vector<Key> reach_, distance_, count_, sum_;
  std::vector<int> squares_;
};

// Mean of 1/z in 1/counts: 1/(m + d) = (1 - d/m + (d/m)^2 - ...)/m, where |d/m| is at most 3%.
double mean_inverse(const Near& near, double median) {
  const double n = near.count;
  return (1.0 - near.sum / (n * median) + near.squares / (n * median * median)) / median;
}

// The reading of a block that comes nearest to a depth in counts; of two, the nearer to the camera.
Count nearest_reading(const cv::Mat& counts, const cv::Rect& rect, int depth) {
  int least = std::numeric_limits<int>::max();
  for (int v = rect.y; v < rect.y + rect.height; ++v) {
    const auto* row = counts.ptr<Count>(v) + rect.x;
    for (int u = 0; u < rect.width; ++u) {
      // A hole is further from any depth than any reading: nearer readings, being within 3%, win.
      const int distance = std::min(std::abs(row[u] - depth), 32767);
      const int ranked = distance << 16 | row[u];
      least = ranked < least ? ranked : least;
    }
  }
  return static_cast<Count>(least & 0xFFFF);
}

void find_depths(const DepthFrame& frame, BlockPreview& preview) {
  const BlockGrid& grid = preview.grid;
  BlockRows<Count> rows(grid.width);
  std::vector<Count> medians(static_cast<std::size_t>(grid.columns));
  Medians finder(grid.columns);
  NearSums sums(grid.columns);
  const double steps = 1.0 / (frame.unit * preview.step);  // of 1/z, in one of 1/counts
  for (int row = 0; row < grid.rows; ++row) {
    rows.move_to(frame.counts, row * kBlockSide);
    finder.find(rows, grid.width, medians);
    sums.add_up(rows, grid.width, medians);
    auto* depths = preview.depth.ptr<Count>(row);
    for (int column = 0; column < grid.columns; ++column) {
      depths[column] = 0;
      const Count median = medians[static_cast<std::size_t>(column)];
      if (median == 0) continue;
      const Near near = sums.of(column);
      const cv::Rect rect = grid.rect(grid.index(column, row));
      if (near.count * 64 < kFewestReadings * rect.area()) continue;
      const double q = mean_inverse(near, median);
      if (preview.coding == PreviewDepth::kCounts) {
        depths[column] =
            nearest_reading(frame.counts, rect, static_cast<int>(std::lround(1.0 / q)));
      } else {
        depths[column] = static_cast<Count>(std::clamp(q * steps + 0.5, 1.0, 65535.0));
      }
    }
  }
}

void find_colours(const cv::Mat& bgr, BlockPreview& preview) {
  const BlockGrid& grid = preview.grid;
  const auto length = static_cast<std::size_t>(grid.width) * 3;
  BlockRows<std::uint8_t> rows(grid.width * 3);
  std::vector<std::uint16_t> sums(static_cast<std::size_t>(grid.columns) * kBlockSide * 3, 0);
  for (int row = 0; row < grid.rows; ++row) {
    rows.move_to(bgr, row * kBlockSide);
    const std::uint8_t *r0 = rows[0], *r1 = rows[1], *r2 = rows[2], *r3 = rows[3];
    const std::uint8_t *r4 = rows[4], *r5 = rows[5], *r6 = rows[6], *r7 = rows[7];
    std::uint16_t* sum = sums.data();
    for (std::size_t i = 0; i < length; ++i) {
      sum[i] =
          static_cast<std::uint16_t>(r0[i] + r1[i] + r2[i] + r3[i] + r4[i] + r5[i] + r6[i] + r7[i]);
    }
    auto* colours = preview.bgr.ptr<cv::Vec3b>(row);
    for (int column = 0; column < grid.columns; ++column) {
      const std::uint16_t* block = sum + static_cast<std::ptrdiff_t>(column) * kBlockSide * 3;
      std::array<unsigned, 3> total{};
      for (int u = 0; u < kBlockSide * 3; u += 3) {
        total[0] += block[u];
        total[1] += block[u + 1];
        total[2] += block[u + 2];
      }
      const auto n = static_cast<unsigned>(grid.rect(grid.index(column, row)).area());
      for (int c = 0; c < 3; ++c) {
        colours[column][c] =
            static_cast<std::uint8_t>((total[static_cast<std::size_t>(c)] + n / 2) / n);
      }
    }
  }
}

BlockPreview preview_of(const DepthFrame& depth, const cv::Mat& bgr, PreviewDepth coding,
                        double step) {
  BlockPreview preview;
  preview.grid = BlockGrid(depth.width(), depth.height());
  preview.coding = coding;
  preview.step = static_cast<double>(static_cast<float>(step));  // as it goes over the wire
  preview.depth.create(preview.grid.rows, preview.grid.columns, CV_16UC1);
  preview.bgr.create(preview.grid.rows, preview.grid.columns, CV_8UC3);
  find_depths(depth, preview);
  if (bgr.type() == CV_8UC3 && bgr.size() == depth.counts.size()) {
    find_colours(bgr, preview);
  } else {
    preview.bgr.setTo(kNoColour);
  }
  return preview;
}

}  // namespace

bool BlockPreview::well_formed() const {
  const cv::Size blocks(grid.columns, grid.rows);
  return depth.size() == blocks && depth.type() == CV_16UC1 && depth.isContinuous() &&
         bgr.size() == blocks && bgr.type() == CV_8UC3 && bgr.isContinuous() && step > 0.0;
}

BlockPreview make_preview(const DepthFrame& depth, const cv::Mat& bgr, double step) {
  return preview_of(depth, bgr, PreviewDepth::kInverse, step);
}

BlockPreview make_exact_preview(const DepthFrame& depth, const cv::Mat& bgr) {
  return preview_of(depth, bgr, PreviewDepth::kCounts, depth.unit);
}

std::vector<PreviewPoint> preview_points(const BlockPreview& preview, const Camera& camera) {
  std::vector<PreviewPoint> points;
  const BlockGrid& grid = preview.grid;
  if (camera.width != grid.width || camera.height != grid.height) return points;
  constexpr double kCentre = 0.5 * (kBlockSide - 1);
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      if (!preview.valid(column, row)) continue;
      const Eigen::Vector3d point =
          camera.unproject(kBlockSide * column + kCentre, kBlockSide * row + kCentre,
                           preview.metres(grid.index(column, row)));
      points.push_back({point.cast<float>(), preview.bgr.at<cv::Vec3b>(row, column)});
    }
  }
  return points;
}

}  // namespace rprr
