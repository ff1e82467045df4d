// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_view/image_alignment.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>

namespace rprr {
namespace {

constexpr int kIterations = 3;
constexpr float kLargestStep = 1.0f;   // [px] in an iteration
constexpr float kLargestShift = 3.0f;  // [px]
constexpr float kPrior = 0.01f;        // of the mean square difference: shifts of about a pixel
constexpr float kLeastPrior = 0.2f;

int cells(int pixels) {
  return (pixels + ImageAlignment::kCell - 1) / ImageAlignment::kCell;
}

// Weights 1 4 6 4 1 both ways, the rim repeated.
void smooth(cv::Mat& values, cv::Mat& scratch) {
  const auto five = [](const cv::Mat& in, cv::Mat& out, int du, int dv) {
    out.create(in.size(), CV_32FC1);
    for (int v = 0; v < in.rows; ++v) {
      for (int u = 0; u < in.cols; ++u) {
        const auto at = [&](int k) {
          return in.at<float>(std::clamp(v + k * dv, 0, in.rows - 1),
                              std::clamp(u + k * du, 0, in.cols - 1));
        };
        out.at<float>(v, u) =
            (at(-2) + at(2) + 4.0f * (at(-1) + at(1)) + 6.0f * at(0)) * (1.0f / 16.0f);
      }
    }
  };
  five(values, scratch, 1, 0);
  five(scratch, values, 0, 1);
}

}  // namespace

void shifts_of_row(const cv::Mat& shifts, int scale, int row, int width, float* x, float* y) {
  const int side = ImageAlignment::kCell * scale;
  const auto cell = static_cast<float>(side);
  const float at = std::clamp((static_cast<float>(row) + 0.5f) / cell - 0.5f, 0.0f,
                              static_cast<float>(shifts.rows - 1));
  const int top = static_cast<int>(at);
  const float down = at - static_cast<float>(top);
  const auto* upper = shifts.ptr<cv::Vec2f>(top);
  const auto* lower = shifts.ptr<cv::Vec2f>(std::min(top + 1, shifts.rows - 1));
  const auto unit = static_cast<float>(scale);
  const auto mixed = [&](int column, int i) {
    const int k = std::clamp(column, 0, shifts.cols - 1);
    return unit * (upper[k][i] + down * (lower[k][i] - upper[k][i]));
  };
  // Straight lines from one cell's centre to the next.
  for (int k = -1; k < shifts.cols; ++k) {
    const int begin = std::clamp(k * side + side / 2, 0, width);
    const int end = k + 1 == shifts.cols ? width : std::clamp(begin + side, 0, width);
    const int next = k < 0 ? std::min(side / 2, width) : end;
    const float centre = (static_cast<float>(k) + 0.5f) * cell - 0.5f;
    const float x_start = mixed(k, 0), x_slope = (mixed(k + 1, 0) - x_start) / cell;
    const float y_start = mixed(k, 1), y_slope = (mixed(k + 1, 1) - y_start) / cell;
    for (int u = begin; u < next; ++u) {
      const float away = static_cast<float>(u) - centre;
      x[u] = x_start + x_slope * away;
      y[u] = y_start + y_slope * away;
    }
  }
}

const cv::Mat& ImageAlignment::align(const cv::Mat& prediction, const cv::Mat& valid,
                                     const cv::Mat& base) {
  const cv::Size grid(cells(prediction.cols), cells(prediction.rows));
  shifts_.create(grid, CV_32FC2);
  shifts_.setTo(0);
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    shift_prediction(prediction, valid, base);
    remove_offsets();
    sum_up();
    solve();
  }
  return shifts_;
}

void ImageAlignment::shift_prediction(const cv::Mat& prediction, const cv::Mat& valid,
                                      const cv::Mat& base) {
  const cv::Size size = prediction.size();
  shifted_.create(size, CV_32FC1);
  difference_.create(size, CV_32FC1);
  known_.create(size, CV_32FC1);
  scratch_.create(2, size.width, CV_32FC1);
  auto* const shift_x = scratch_.ptr<float>(0);
  auto* const shift_y = scratch_.ptr<float>(1);
  const auto right = static_cast<float>(size.width - 1);
  const auto bottom = static_cast<float>(size.height - 1);
  for (int v = 0; v < size.height; ++v) {
    shifts_of_row(shifts_, 1, v, size.width, shift_x, shift_y);
    for (int u = 0; u < size.width; ++u) {
      const float x = std::clamp(static_cast<float>(u) + shift_x[u], 0.0f, right);
      const float y = std::clamp(static_cast<float>(v) + shift_y[u], 0.0f, bottom);
      const int left = static_cast<int>(x);
      const int top = static_cast<int>(y);
      const int next = std::min(left + 1, size.width - 1);
      const int below = std::min(top + 1, size.height - 1);
      const float across = x - static_cast<float>(left);
      const float down = y - static_cast<float>(top);
      const auto* p = prediction.ptr<float>(top);
      const auto* q = prediction.ptr<float>(below);
      const auto* p_valid = valid.ptr<std::uint8_t>(top);
      const auto* q_valid = valid.ptr<std::uint8_t>(below);
      const bool all =
          p_valid[left] != 0 && p_valid[next] != 0 && q_valid[left] != 0 && q_valid[next] != 0;
      const float upper = p[left] + across * (p[next] - p[left]);
      const float lower = q[left] + across * (q[next] - q[left]);
      const float value = upper + down * (lower - upper);
      shifted_.ptr<float>(v)[u] = value;
      known_.ptr<float>(v)[u] = all ? 1.0f : 0.0f;
      difference_.ptr<float>(v)[u] = all ? base.ptr<float>(v)[u] - value : 0.0f;
    }
  }
}

// Takes the difference's mean around each cell away: exposure and light are no shifts.
void ImageAlignment::remove_offsets() {
  offsets_.create(shifts_.size(), CV_32FC1);
  counts_.create(shifts_.size(), CV_32FC1);
  offsets_.setTo(0);
  counts_.setTo(0);
  for (int v = 0; v < difference_.rows; ++v) {
    const auto* difference = difference_.ptr<float>(v);
    const auto* known = known_.ptr<float>(v);
    auto* offset = offsets_.ptr<float>(v / kCell);
    auto* count = counts_.ptr<float>(v / kCell);
    for (int u = 0; u < difference_.cols; ++u) {
      offset[u / kCell] += difference[u];
      count[u / kCell] += known[u];
    }
  }
  for (int v = 0; v < offsets_.rows; ++v) {
    auto* offset = offsets_.ptr<float>(v);
    const auto* count = counts_.ptr<float>(v);
    for (int u = 0; u < offsets_.cols; ++u) offset[u] /= std::max(count[u], 1.0f);
  }
  for (int v = 0; v < difference_.rows; ++v) {
    auto* difference = difference_.ptr<float>(v);
    const auto* known = known_.ptr<float>(v);
    const auto* offset = offsets_.ptr<float>(v / kCell);
    for (int u = 0; u < difference_.cols; ++u) difference[u] -= known[u] * offset[u / kCell];
  }
}

void ImageAlignment::sum_up() {
  for (cv::Mat& sum : sums_) {
    sum.create(shifts_.size(), CV_32FC1);
    sum.setTo(0);
  }
  const double known = std::max(1.0, cv::sum(known_)[0]);
  const auto spread = static_cast<float>(4.0 * difference_.dot(difference_) / known + 1.0);
  for (int v = 1; v + 1 < shifted_.rows; ++v) {
    const auto* above = shifted_.ptr<float>(v - 1);
    const auto* here = shifted_.ptr<float>(v);
    const auto* below = shifted_.ptr<float>(v + 1);
    const auto* known_above = known_.ptr<float>(v - 1);
    const auto* known_here = known_.ptr<float>(v);
    const auto* known_below = known_.ptr<float>(v + 1);
    const auto* difference = difference_.ptr<float>(v);
    float* sums[kSums];
    for (int i = 0; i < kSums; ++i) {
      sums[i] = sums_[static_cast<std::size_t>(i)].ptr<float>(v / kCell);
    }
    for (int u = 1; u + 1 < shifted_.cols; ++u) {
      const float e = difference[u];
      const float weight = known_here[u] * known_here[u - 1] * known_here[u + 1] * known_above[u] *
                           known_below[u] * spread / (spread + e * e);
      const float x = 0.5f * (here[u + 1] - here[u - 1]);
      const float y = 0.5f * (below[u] - above[u]);
      const int cell = u / kCell;
      sums[kXX][cell] += weight * x * x;
      sums[kXY][cell] += weight * x * y;
      sums[kYY][cell] += weight * y * y;
      sums[kXE][cell] += weight * x * e;
      sums[kYE][cell] += weight * y * e;
      sums[kEE][cell] += weight * e * e;
      sums[kWeight][cell] += weight;
    }
  }
  for (cv::Mat& sum : sums_) {
    smooth(sum, scratch_);
    smooth(sum, scratch_);
  }
}

void ImageAlignment::solve() {
  for (int v = 0; v < shifts_.rows; ++v) {
    for (int u = 0; u < shifts_.cols; ++u) {
      const auto sum = [&](Sum which) {
        return sums_[static_cast<std::size_t>(which)].at<float>(v, u);
      };
      const float prior = kPrior * sum(kEE) + kLeastPrior * sum(kWeight) + 1e-3f;
      const float xx = sum(kXX) + prior;
      const float yy = sum(kYY) + prior;
      const float xy = sum(kXY);
      const float determinant = xx * yy - xy * xy;
      const float x = (yy * sum(kXE) - xy * sum(kYE)) / determinant;
      const float y = (xx * sum(kYE) - xy * sum(kXE)) / determinant;
      auto& shift = shifts_.at<cv::Vec2f>(v, u);
      const auto moved = [](float from, float by) {
        return std::clamp(from + std::clamp(by, -kLargestStep, kLargestStep), -kLargestShift,
                          kLargestShift);
      };
      shift = {moved(shift[0], x), moved(shift[1], y)};
    }
  }
}

}  // namespace rprr
