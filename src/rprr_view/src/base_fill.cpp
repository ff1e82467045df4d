// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_view/base_fill.hpp"

#include <algorithm>
#include <cstring>
#include <opencv2/core.hpp>

#include "float4.hpp"

namespace rprr {
namespace {

constexpr int kOffsetCell = 16;  // [px]

// Where a pixel lies in an image of `scale` times the size, in its pixels.
float place_of(int pixel, float scale, int count) {
  return std::clamp((static_cast<float>(pixel) + 0.5f) * scale - 0.5f, 0.0f,
                    static_cast<float>(count - 1));
}

Float4 sample4(const cv::Mat& image, float x, float y) {
  const int left = static_cast<int>(x);
  const int top = static_cast<int>(y);
  const int right = std::min(left + 1, image.cols - 1);
  const Float4* upper = row4(image, top);
  const Float4* lower = row4(image, std::min(top + 1, image.rows - 1));
  const Float4 across = all4(x - static_cast<float>(left));
  const Float4 above = upper[left] + across * (upper[right] - upper[left]);
  const Float4 below = lower[left] + across * (lower[right] - lower[left]);
  return above + all4(y - static_cast<float>(top)) * (below - above);
}

// Turns sums of values, with their number as the fourth number of a pixel, into means. Where there
// are few values or none, the mean comes from around (push-pull, as in smooth_fill.hpp).
void spread(std::vector<cv::Mat>& levels) {
  std::size_t count = 1;
  for (cv::Size size = levels[0].size(); size.area() > 1; size = half(size)) ++count;
  levels.resize(count);
  constexpr float kEnough = 4.0f;
  for (std::size_t k = 0; k + 1 < count; ++k) {
    levels[k + 1].create(half(levels[k].size()), CV_32FC4);
    for_cells(
        levels[k].size(), [&](int u, int v) { return row4(levels[k], v)[u]; },
        [&](int u, int v, Float4 a, Float4 b, Float4 c, Float4 d) {
          row4(levels[k + 1], v)[u] = (a + b) + (c + d);
        });
  }
  for (std::size_t k = count; k-- > 0;) {
    for (int v = 0; v < levels[k].rows; ++v) {
      Float4* at = row4(levels[k], v);
      for (int u = 0; u < levels[k].cols; ++u) {
        const float here = at[u][3];
        const float missing = std::max(0.0f, kEnough - here);
        Float4 around = all4(0.0f);
        if (k + 1 < count) {
          around = sample4(levels[k + 1], place_of(u, 0.5f, levels[k + 1].cols),
                           place_of(v, 0.5f, levels[k + 1].rows));
        }
        at[u] = (at[u] + all4(missing) * around) * all4(1.0f / (here + missing));
      }
    }
  }
}

// Places of the frame's columns or rows in an image of so much smaller size.
void find_places(int count, int reduction, int small_count, std::vector<SmallerPlace>& places) {
  places.resize(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    const float at = place_of(i, 1.0f / static_cast<float>(reduction), small_count);
    const int first = static_cast<int>(at);
    places[static_cast<std::size_t>(i)] = {first, std::min(first + 1, small_count - 1),
                                           at - static_cast<float>(first)};
  }
}

Float4 between(Float4 a, Float4 b, float share) {
  return a + all4(share) * (b - a);
}

}  // namespace

// Unknown pixels take the base in the light of the prediction around them: a prediction without
// edges where it begins and ends. The light comes back with the difference to the base.
void BaseFill::fill(const BaseImage& base, PredictedView& view) {
  find_places(view.bgr.cols, base.reduction, base.bgr.cols, columns_);
  find_places(view.bgr.rows, base.reduction, base.bgr.rows, rows_);
  measure_offsets(base, view);
  spread(offsets_);
  const cv::Mat& offsets = offsets_[0];
  find_places(view.bgr.cols, kOffsetCell, offsets.cols, offset_columns_);
  find_places(view.bgr.rows, kOffsetCell, offsets.rows, offset_rows_);
  for (int v = 0; v < view.bgr.rows; ++v) {
    auto* provenance = view.provenance.ptr<std::uint8_t>(v);
    if (std::memchr(provenance, kNothing, static_cast<std::size_t>(view.bgr.cols)) == nullptr) {
      continue;
    }
    take_rows(base, v);
    auto* colours = view.bgr.ptr<std::uint8_t>(v);
    const SmallerPlace& row = offset_rows_[static_cast<std::size_t>(v)];
    const Float4* const upper = row4(offsets, row.first);
    const Float4* const lower = row4(offsets, row.second);
    for (int u = 0; u < view.bgr.cols; ++u) {
      if (provenance[u] != kNothing) continue;
      provenance[u] = kBase;
      const SmallerPlace& at = offset_columns_[static_cast<std::size_t>(u)];
      const Float4 offset =
          between(between(upper[at.first], upper[at.second], at.share),
                  between(lower[at.first], lower[at.second], at.share), row.share);
      store_bgr(sample_base(u) - offset, colours + 3 * u);
    }
  }
}

// Takes the mean of base minus prediction over some pixels of each cell, and their number.
void BaseFill::measure_offsets(const BaseImage& base, const PredictedView& view) {
  const auto cells = [](int pixels) { return (pixels + kOffsetCell - 1) / kOffsetCell; };
  cv::Mat& offsets = offsets_[0];
  offsets.create(cells(view.bgr.rows), cells(view.bgr.cols), CV_32FC4);
  offsets.setTo(0);
  constexpr int kEvery = 4;
  for (int v = kEvery / 2; v < view.bgr.rows; v += kEvery) {
    take_rows(base, v);
    const auto* provenance = view.provenance.ptr<std::uint8_t>(v);
    const auto* colours = view.bgr.ptr<std::uint8_t>(v);
    Float4* const to = row4(offsets, v / kOffsetCell);
    for (int u = kEvery / 2; u < view.bgr.cols; u += kEvery) {
      if (provenance[u] == kNothing) continue;
      Float4 offset = sample_base(u) - load_bgr(colours + 3 * u);
      offset[3] = 1.0f;
      to[u / kOffsetCell] += offset;
    }
  }
}

// For sample_base: those rows of the base between which a row of the frame lies.
void BaseFill::take_rows(const BaseImage& base, int v) {
  const SmallerPlace& row = rows_[static_cast<std::size_t>(v)];
  const int count = 3 * base.bgr.cols;
  taken_.create(2, count + 1, CV_32FC1);
  to_floats(base.bgr.ptr<std::uint8_t>(row.first), count, taken_.ptr<float>(0));
  to_floats(base.bgr.ptr<std::uint8_t>(row.second), count, taken_.ptr<float>(1));
  taken_share_ = row.share;
}

Float4 BaseFill::sample_base(int u) const {
  const SmallerPlace& at = columns_[static_cast<std::size_t>(u)];
  const auto across = [&](const float* row) {
    return between(load_pixel(row, at.first), load_pixel(row, at.second), at.share);
  };
  return between(across(taken_.ptr<float>(0)), across(taken_.ptr<float>(1)), taken_share_);
}

}  // namespace rprr
