// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_view/crack_filter.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <opencv2/core.hpp>
#include <opencv2/core/hal/intrin.hpp>

namespace rprr {
namespace {

constexpr int kLargestRadius = 4;
constexpr int kStretch = 32;  // pixels of a row that are looked at together
constexpr int kMedianCapacity = (2 * kLargestRadius + 1) * (2 * kLargestRadius + 1);
constexpr std::array<std::array<int, 2>, 4> kAxes{{{1, 0}, {0, 1}, {1, 1}, {1, -1}}};  // du, dv

bool same_surface(float p, float q, float range) {
  return std::abs(p - q) < range * std::min(p, q);
}

// A few values on the stack.
struct Values {
  std::array<float, kMedianCapacity> value{};
  int count = 0;

  void add(float v) { value[static_cast<std::size_t>(count++)] = v; }
  float median() {
    if (count == 0) return 0.0f;
    auto* const middle = value.data() + count / 2;
    std::nth_element(value.data(), middle, value.data() + count);
    return *middle;
  }
};

// Depth image with rays and windows clipped to it.
class Neighbourhood {
 public:
  explicit Neighbourhood(const cv::Mat& metres)
      : data_(metres.ptr<float>()), width_(metres.cols), height_(metres.rows) {}

  // Distance to the first valid pixel from (u, v) in a direction, 0 if there is none within reach.
  int first_valid(int u, int v, int du, int dv, int reach, float& depth) const {
    for (int distance = 1; distance <= reach; ++distance) {
      u += du;
      v += dv;
      if (u < 0 || v < 0 || u >= width_ || v >= height_) return 0;
      depth = data_[v * width_ + u];
      if (depth > 0.0f) return distance;
    }
    return 0;
  }

  // Radius of the smallest window in which two axes close the pixel in, 0 if none does up to the
  // reach.
  int closing_radius(int u, int v, int reach, float range) const {
    const int none = reach + 1;
    int smallest = none;
    int second = none;
    for (const auto& [du, dv] : kAxes) {
      float ahead = 0.0f;
      float behind = 0.0f;
      const int far_ahead = first_valid(u, v, du, dv, reach, ahead);
      if (far_ahead == 0) continue;
      const int far_behind = first_valid(u, v, -du, -dv, reach, behind);
      if (far_behind == 0 || !same_surface(ahead, behind, range)) continue;
      const int radius = std::max(far_ahead, far_behind);
      second = std::min(second, std::max(radius, smallest));
      smallest = std::min(smallest, radius);
    }
    return second == none ? 0 : second;
  }

  float window_median(int u, int v, int radius) const {
    Values values;
    const int u_end = std::min(u + radius, width_ - 1);
    const int v_end = std::min(v + radius, height_ - 1);
    for (int y = std::max(v - radius, 0); y <= v_end; ++y) {
      for (int x = std::max(u - radius, 0); x <= u_end; ++x) {
        const float depth = data_[y * width_ + x];
        if (depth > 0.0f) values.add(depth);
      }
    }
    return values.median();
  }

 private:
  const float* data_;
  int width_;
  int height_;
};

// Flags the invalid pixels of a row that may be closed in: along two axes there is something valid
// on both sides, of whatever surface. Most pixels of large holes are settled here, without
// branches. valid points into an image of 0 and 1 with a rim of zeros as wide as the reach.
template <int kReach>
void flag_candidates(const std::uint8_t* __restrict valid, std::ptrdiff_t stride, int width,
                     std::uint8_t* __restrict candidate) {
  for (int u = 0; u < width; ++u) {
    const std::uint8_t* at = valid + u;
    // In bytes all along: compilers then take sixteen pixels at once.
    std::uint8_t ahead[4] = {0, 0, 0, 0};
    std::uint8_t behind[4] = {0, 0, 0, 0};
    for (int d = 1; d <= kReach; ++d) {
      const std::ptrdiff_t steps[4] = {d, d * stride, d * stride + d, d * stride - d};
      for (int axis = 0; axis < 4; ++axis) {
        ahead[axis] = static_cast<std::uint8_t>(ahead[axis] | at[steps[axis]]);
        behind[axis] = static_cast<std::uint8_t>(behind[axis] | at[-steps[axis]]);
      }
    }
    const auto closed = [&](int axis) {
      return static_cast<std::uint8_t>(ahead[axis] & behind[axis]);
    };
    const std::uint8_t c0 = closed(0), c1 = closed(1), c2 = closed(2), c3 = closed(3);
    // Two of the four at least.
    const auto two = static_cast<std::uint8_t>((c0 & c1) | (c2 & c3) | ((c0 | c1) & (c2 | c3)));
    candidate[u] = static_cast<std::uint8_t>(two & (at[0] ^ 1));
  }
}

using FlagCandidates = void (*)(const std::uint8_t*, std::ptrdiff_t, int, std::uint8_t*);
constexpr std::array<FlagCandidates, kLargestRadius> kFlagCandidates{
    flag_candidates<1>, flag_candidates<2>, flag_candidates<3>, flag_candidates<4>};

// Flags the pixels of a row of whose eight neighbours more than half are valid and out of range.
// Without branches, so that the compiler can vectorise it.
void flag_suspects(const float* __restrict above, const float* __restrict row,
                   const float* __restrict below, int width, float range,
                   std::uint8_t* __restrict suspect) {
  for (int u = 1; u < width - 1; ++u) {
    const float centre = row[u];
    const float nearer = centre * (1.0f / (1.0f + range));
    const float farther = centre * (1.0f + range);
    const auto votes = [=](float depth) {
      return static_cast<int>(depth > farther) |
             (static_cast<int>(depth > 0.0f) & static_cast<int>(depth < nearer));
    };
    const int out = votes(above[u - 1]) + votes(above[u]) + votes(above[u + 1]) +
                    votes(row[u - 1]) + votes(row[u + 1]) + votes(below[u - 1]) + votes(below[u]) +
                    votes(below[u + 1]);
    suspect[u] =
        static_cast<std::uint8_t>(static_cast<int>(centre > 0.0f) & static_cast<int>(out > 4));
  }
}

// Whether all depths around a stretch of a row, in the rows above and below and a pixel beyond
// either end too, are so close that none is out of any other's range.
bool all_in_range(const float* const (&rows)[3], int begin, int end, float range) {
  constexpr float kNone = std::numeric_limits<float>::max();
  constexpr int kLanes = 4;
  if (end - begin < kLanes) return false;
  const cv::v_float32x4 none = cv::v_setall_f32(kNone);
  const cv::v_float32x4 zero = cv::v_setzero_f32();
  cv::v_float32x4 lowest = none;
  cv::v_float32x4 highest = zero;
  for (const float* row : rows) {
    for (int u = begin; u < end; u += kLanes) {
      const cv::v_float32x4 depth = cv::v_load(row + std::min(u, end - kLanes));
      highest = cv::v_max(highest, depth);
      // No depth is 0, and no bits.
      lowest = cv::v_min(lowest, depth | (none & (depth == zero)));
    }
  }
  const float low = cv::v_reduce_min(lowest);
  const float high = cv::v_reduce_max(highest);
  return low >= high || (high <= low * (1.0f + range) && low >= high * (1.0f / (1.0f + range)));
}

// What the surface around a ghost has at its place; 0 if the neighbours are of no one surface.
float surface_around(const cv::Mat& metres, int u, int v, float range) {
  Values all;
  for (int dv = -1; dv <= 1; ++dv) {
    const auto* row = metres.ptr<float>(v + dv);
    for (int du = -1; du <= 1; ++du) {
      if ((du != 0 || dv != 0) && row[u + du] > 0.0f) all.add(row[u + du]);
    }
  }
  const float middle = all.median();
  Values surface;
  for (int i = 0; i < all.count; ++i) {
    const float depth = all.value[static_cast<std::size_t>(i)];
    if (same_surface(depth, middle, range)) surface.add(depth);
  }
  return surface.count > 4 ? surface.median() : 0.0f;
}

}  // namespace

CrackFilter::CrackFilter(CrackFilterOptions options) : options_(options) {
  options_.largest_window = std::clamp(options_.largest_window, 3, 2 * kLargestRadius + 1);
}

void CrackFilter::mend(cv::Mat& metres, cv::Mat& mended) {
  mended.create(metres.size(), CV_8UC1);
  mended.setTo(0);
  if (options_.cracks) close_cracks(metres, mended);
  if (options_.ghosts) remove_ghosts(metres, mended);
}

void CrackFilter::close_cracks(cv::Mat& metres, cv::Mat& mended) {
  metres.copyTo(before_);  // mended values must not mend others: the result knows no direction
  const Neighbourhood neighbourhood(before_);
  const int reach = options_.largest_window / 2;
  const cv::Rect inner(kLargestRadius, kLargestRadius, metres.cols, metres.rows);
  valid_.create(metres.rows + 2 * kLargestRadius, metres.cols + 2 * kLargestRadius, CV_8UC1);
  valid_.setTo(0);
  for (int v = 0; v < metres.rows; ++v) {
    const auto* depth = before_.ptr<float>(v);
    auto* valid = valid_(inner).ptr<std::uint8_t>(v);
    for (int u = 0; u < metres.cols; ++u) valid[u] = depth[u] > 0.0f ? 1 : 0;
  }
  flags_.create(1, metres.cols, CV_8UC1);
  auto* const candidates = flags_.ptr<std::uint8_t>();
  for (int v = 0; v < metres.rows; ++v) {
    const auto* valid = valid_(inner).ptr<std::uint8_t>(v);
    for (int begin = 0; begin < metres.cols; begin += kStretch) {
      const int count = std::min(kStretch, metres.cols - begin);
      if (std::memchr(valid + begin, 0, static_cast<std::size_t>(count)) == nullptr) {
        std::memset(candidates + begin, 0, static_cast<std::size_t>(count));
        continue;
      }
      kFlagCandidates[static_cast<std::size_t>(reach - 1)](
          valid + begin, static_cast<std::ptrdiff_t>(valid_.step[0]), count, candidates + begin);
    }
    for (int u = 0; u < metres.cols; ++u) {
      if (candidates[u] == 0) continue;
      const int radius = neighbourhood.closing_radius(u, v, reach, options_.range);
      if (radius == 0) continue;
      metres.at<float>(v, u) = neighbourhood.window_median(u, v, radius);
      mended.at<std::uint8_t>(v, u) = 255;
    }
  }
}

void CrackFilter::remove_ghosts(cv::Mat& metres, cv::Mat& mended) {
  metres.copyTo(before_);
  flags_.create(1, std::max(metres.cols, kStretch + 2), CV_8UC1);
  auto* suspects = flags_.ptr<std::uint8_t>();
  for (int v = 1; v < metres.rows - 1; ++v) {
    const float* const rows[3] = {before_.ptr<float>(v - 1), before_.ptr<float>(v),
                                  before_.ptr<float>(v + 1)};
    for (int begin = 0; begin + 2 < metres.cols; begin += kStretch) {
      const int end = std::min(begin + kStretch + 2, metres.cols);
      if (all_in_range(rows, begin, end, options_.range)) continue;
      flag_suspects(rows[0] + begin, rows[1] + begin, rows[2] + begin, end - begin, options_.range,
                    suspects);
      for (int i = 1; i < end - begin - 1; ++i) {
        if (suspects[i] == 0) continue;
        const float depth = surface_around(before_, begin + i, v, options_.range);
        if (depth == 0.0f) continue;
        metres.at<float>(v, begin + i) = depth;
        mended.at<std::uint8_t>(v, begin + i) = 255;
      }
    }
  }
}

}  // namespace rprr
