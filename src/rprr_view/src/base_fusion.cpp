// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_view/base_fusion.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <opencv2/core.hpp>

#include "float4.hpp"

namespace rprr {
namespace {

constexpr std::size_t kOctaves = 5;  // octaves that are weighed; coarser ones count fully
constexpr int kSmallest = 8;         // [px] the pyramid ends at the first level that is no larger

// How the power of a base's coding noise spreads over octaves, the finest first: rounded shares of
// the mean square that 2x2 cells hold. Measured with WebP at several qualities on a kitchen and a
// rendered room. Other codecs take the same numbers.
constexpr std::array<float, kOctaves> kNoiseReduced{0.50f, 0.28f, 0.13f, 0.06f, 0.02f};
constexpr std::array<float, kOctaves> kNoiseFull{0.24f, 0.29f, 0.25f, 0.12f, 0.06f};

// A base of full size with less coding noise than this [grey levels] is taken as it is: below, a
// prediction lowers the mean PSNR of a kitchen, a rendered room, an office and a household.
constexpr float kFine = 4.5f;

// Coding noise is at most this share of the signal that an octave holds at a place: where there is
// no signal, coding lost none.
constexpr float kNoiseOfSignal = 0.3f;

// The noise is multiplied by the trust in the prediction: kTrust times the base's noise over the
// difference that this share of places stays below, within bounds. So where the prediction is good
// at most places, the estimate leans to it, and to the base otherwise.
constexpr float kMostly = 0.9f;
constexpr float kTrust = 4.0f;
constexpr float kLeastTrust = 0.3f;
constexpr float kMostTrust = 2.0f;
// The share is steeper than Wiener's. What a codec loses is part of the signal: where the
// prediction lacks the same detail, the difference looks smaller than the prediction's error.
constexpr float kSteepness = 1.3f;

std::size_t level_of(int reduction) {
  std::size_t level = 0;
  while ((1 << level) < reduction) ++level;
  return level;
}

std::size_t coarsest_level(cv::Size size, std::size_t base_level) {
  std::size_t level = 0;
  for (; level < base_level + kOctaves; ++level) {
    if (level > base_level && std::min(size.width, size.height) <= kSmallest) break;
    size = half(size);
  }
  return level;
}

void reduce(const cv::Mat& fine, cv::Mat& coarse) {
  coarse.create(half(fine.size()), CV_32FC4);
  for_cells(
      fine.size(), [&](int u, int v) { return row4(fine, v)[u]; },
      [&](int u, int v, Float4 a, Float4 b, Float4 c, Float4 d) {
        row4(coarse, v)[u] = all4(0.25f) * ((a + b) + (c + d));
      });
}

// Halves an image in both directions. scratch: CV_32FC1, two rows of the image's colours.
void reduce_bgr(const cv::Mat& bgr, cv::Mat& coarse, cv::Mat& scratch) {
  coarse.create(half(bgr.size()), CV_32FC4);
  float* const rows[2] = {scratch.ptr<float>(0), scratch.ptr<float>(1)};
  for_row_pairs(bgr.rows, [&](int v, int upper, int lower) {
    to_floats(bgr.ptr<std::uint8_t>(upper), 3 * bgr.cols, rows[0]);
    to_floats(bgr.ptr<std::uint8_t>(lower), 3 * bgr.cols, rows[1]);
    Float4* const to = row4(coarse, v);
    for_cells_of_row(
        bgr.cols, [&](int u, int i) { return load_pixel(rows[i], u); },
        [&](int u, Float4 a, Float4 b, Float4 c, Float4 d) {
          Float4 mean = all4(0.25f) * ((a + b) + (c + d));
          mean[3] = 0.0f;
          to[u] = mean;
        });
  });
}

// Means over 3x3 values; values at the rim count again where the window goes beyond the image.
void smooth(const cv::Mat& in, cv::Mat& out) {
  out.create(in.size(), CV_32FC1);
  for (int v = 0; v < in.rows; ++v) {
    const float* rows[3] = {in.ptr<float>(std::max(v - 1, 0)), in.ptr<float>(v),
                            in.ptr<float>(std::min(v + 1, in.rows - 1))};
    auto* to = out.ptr<float>(v);
    float before = rows[0][0] + rows[1][0] + rows[2][0];
    float here = before;
    for (int u = 0; u < in.cols; ++u) {
      const int next = std::min(u + 1, in.cols - 1);
      const float after = rows[0][next] + rows[1][next] + rows[2][next];
      to[u] = (before + here + after) * (1.0f / 9.0f);
      before = here;
      here = after;
    }
  }
}

float sum_of(Float4 x) {
  return x[0] + x[1] + x[2];
}

// Mean square of the difference between four pixels and their mean, over the three colours.
float octave_energy(Float4 a, Float4 b, Float4 c, Float4 d, Float4 mean) {
  const Float4 all = (a * a + b * b) + (c * c + d * d);
  return (1.0f / 3.0f) * sum_of(all4(0.25f) * all - mean * mean);
}

// A pixel of the difference and the same pixel of the prediction.
struct Both {
  Float4 difference;
  Float4 prediction;
};

// Returns the mean difference of a 2x2 cell. energy: mean square of the difference in the cell's
// octave. signal: mean square of the prediction or of the base there, whichever is more.
Float4 measure(const Both& a, const Both& b, const Both& c, const Both& d, float& energy,
               float& signal) {
  const Float4 quarter = all4(0.25f);
  const Float4 difference =
      quarter * ((a.difference + b.difference) + (c.difference + d.difference));
  const Float4 prediction =
      quarter * ((a.prediction + b.prediction) + (c.prediction + d.prediction));
  energy = octave_energy(a.difference, b.difference, c.difference, d.difference, difference);
  const float predicted =
      octave_energy(a.prediction, b.prediction, c.prediction, d.prediction, prediction);
  const float sent = octave_energy(a.prediction + a.difference, b.prediction + b.difference,
                                   c.prediction + c.difference, d.prediction + d.difference,
                                   prediction + difference);
  signal = std::max(predicted, sent);
  return difference;
}

// out = E(q) + E(w) x, where w is the fourth number of q's pixels and E enlarges to x's size.
void expand(const cv::Mat& q, const cv::Mat& x, cv::Mat& out, Float4* mixed) {
  out.create(x.size(), CV_32FC4);
  for (int v = 0; v < x.rows; ++v) {
    const Float4* from = row4(x, v);
    Float4* to = row4(out, v);
    for_enlarged_row(q, v, x.cols, mixed,
                     [&](int u, Float4 value) { to[u] = value + all4(value[3]) * from[u]; });
  }
}

// The colours of q are whole - weight * part; the fourth number of its pixels is the weight.
void weighted_rest(const cv::Mat& whole, const cv::Mat& part, const cv::Mat& weight, cv::Mat& q) {
  q.create(whole.size(), CV_32FC4);
  for (int v = 0; v < q.rows; ++v) {
    const Float4* w = row4(whole, v);
    const Float4* p = row4(part, v);
    const auto* share = weight.ptr<float>(v);
    Float4* to = row4(q, v);
    for (int u = 0; u < q.cols; ++u) {
      to[u] = w[u] - all4(share[u]) * p[u];
      to[u][3] = share[u];
    }
  }
}

}  // namespace

void BaseFusion::fuse(const BaseImage& base, PredictedView& view) {
  if (base.reduction == 1 && base.noise < kFine) {
    base.bgr.copyTo(view.bgr);
    view.provenance.setTo(kBase);
    return;
  }
  const std::size_t base_level = level_of(base.reduction);
  const std::size_t coarsest = coarsest_level(view.bgr.size(), base_level);
  if (levels_.size() < coarsest + 1) levels_.resize(coarsest + 1);
  mixed_.create(1, view.bgr.cols / 2 + 4, CV_32FC4);
  floats_.create(4, 3 * view.bgr.cols + 1, CV_32FC1);

  base_fill_.fill(base, view);
  reduce_bgr(view.bgr, levels_[1].prediction, floats_);
  for (std::size_t level = 1; level < coarsest; ++level) {
    reduce(levels_[level].prediction, levels_[level + 1].prediction);
  }
  compare(base, base_level, coarsest, view.bgr);
  join(base_level, coarsest, base);
  if (base_level == 0) {
    weighted_rest(levels_[1].joint, levels_[1].difference, levels_[0].share, rest_);
    finish_at_base(base, view);
    return;
  }
  weigh_finer_detail(base_level);
  for (std::size_t level = base_level; level-- > 1;) {
    rest_beyond_base(level + 1);
    expand(rest_, levels_[level].prediction, levels_[level].joint, row4(mixed_, 0));
  }
  rest_beyond_base(1);
  finish_beyond_base(view.bgr);
}

// Differences at the base's level and coarser ones, and how much each octave of them holds.
void BaseFusion::compare(const BaseImage& base, std::size_t base_level, std::size_t coarsest,
                         const cv::Mat& bgr) {
  if (base_level == 0) {
    Level& next = levels_[1];
    next.difference.create(half(bgr.size()), CV_32FC4);
    cv::Mat& energy = levels_[0].energy;
    energy.create(next.difference.size(), CV_32FC1);
    cv::Mat& signal = levels_[0].signal;
    signal.create(next.difference.size(), CV_32FC1);
    float* const sent[2] = {floats_.ptr<float>(0), floats_.ptr<float>(1)};
    float* const predicted[2] = {floats_.ptr<float>(2), floats_.ptr<float>(3)};
    for_row_pairs(bgr.rows, [&](int v, int upper, int lower) {
      const int rows[2] = {upper, lower};
      for (int i = 0; i < 2; ++i) {
        to_floats(base.bgr.ptr<std::uint8_t>(rows[i]), 3 * bgr.cols, sent[i]);
        to_floats(bgr.ptr<std::uint8_t>(rows[i]), 3 * bgr.cols, predicted[i]);
      }
      Float4* const difference = row4(next.difference, v);
      auto* const to_energy = energy.ptr<float>(v);
      auto* const to_signal = signal.ptr<float>(v);
      for_cells_of_row(
          bgr.cols,
          [&](int u, int i) {
            const Float4 prediction = load_pixel(predicted[i], u);
            return Both{load_pixel(sent[i], u) - prediction, prediction};
          },
          [&](int u, const Both& a, const Both& b, const Both& c, const Both& d) {
            difference[u] = measure(a, b, c, d, to_energy[u], to_signal[u]);
          });
    });
  } else {
    Level& own = levels_[base_level];
    own.difference.create(base.bgr.size(), CV_32FC4);
    for (int v = 0; v < base.bgr.rows; ++v) {
      const auto* from = base.bgr.ptr<std::uint8_t>(v);
      const Float4* prediction = row4(own.prediction, v);
      Float4* to = row4(own.difference, v);
      for (int u = 0; u < base.bgr.cols; ++u) to[u] = load_bgr(from + 3 * u) - prediction[u];
    }
  }
  for (std::size_t i = std::max<std::size_t>(base_level, 1); i < coarsest; ++i) {
    Level& fine = levels_[i];
    Level& next = levels_[i + 1];
    next.difference.create(half(fine.difference.size()), CV_32FC4);
    fine.energy.create(next.difference.size(), CV_32FC1);
    fine.signal.create(next.difference.size(), CV_32FC1);
    for_cells(
        fine.difference.size(),
        [&](int u, int v) {
          return Both{row4(fine.difference, v)[u], row4(fine.prediction, v)[u]};
        },
        [&](int u, int v, Both a, Both b, Both c, Both d) {
          row4(next.difference, v)[u] =
              measure(a, b, c, d, fine.energy.ptr<float>(v)[u], fine.signal.ptr<float>(v)[u]);
        });
  }
}

// Goes from the coarsest level down to the base's and finds what to add to the prediction.
void BaseFusion::join(std::size_t base_level, std::size_t coarsest, const BaseImage& base) {
  const auto& noise = base_level == 0 ? kNoiseFull : kNoiseReduced;
  levels_[coarsest].difference.copyTo(levels_[coarsest].joint);
  for (std::size_t level = coarsest; level-- > base_level;) {
    weigh(level, base.noise * base.noise * noise[std::min(level - base_level, kOctaves - 1)]);
    if (level == 0) break;
    const Level& coarse = levels_[level + 1];
    weighted_rest(coarse.joint, coarse.difference, levels_[level].share, rest_);
    expand(rest_, levels_[level].difference, levels_[level].joint, row4(mixed_, 0));
  }
  if (base_level == 0) return;
  Level& own = levels_[base_level];
  for (int v = 0; v < own.joint.rows; ++v) {
    Float4* joint = row4(own.joint, v);
    const Float4* prediction = row4(own.prediction, v);
    for (int u = 0; u < own.joint.cols; ++u) joint[u] += prediction[u];
  }
}

// Finds how much of the difference counts in an octave. variance: of the base's noise there.
void BaseFusion::weigh(std::size_t level, float variance) {
  Level& own = levels_[level];
  smooth(own.energy, own.share);
  smooth(own.signal, smoothed_);
  const float mostly = most_of_some(own.share);
  const float trust =
      std::clamp(kTrust * variance / std::max(mostly, 1e-6f), kLeastTrust, kMostTrust);
  for (int v = 0; v < own.share.rows; ++v) {
    auto* share = own.share.ptr<float>(v);
    const auto* signal = smoothed_.ptr<float>(v);
    for (int u = 0; u < own.share.cols; ++u) {
      const float noise = trust * std::min(variance, kNoiseOfSignal * signal[u]);
      const float wiener = 1.0f - noise / std::max(share[u], 1e-3f);
      share[u] = std::clamp(kSteepness * wiener, 0.0f, 1.0f);
    }
  }
}

// The value that the share kMostly of all values stays below, from every third row and column.
float BaseFusion::most_of_some(const cv::Mat& values) {
  constexpr int kEvery = 3;
  sample_.clear();
  for (int v = 0; v < values.rows; v += kEvery) {
    for (int u = 0; u < values.cols; u += kEvery) sample_.push_back(values.at<float>(v, u));
  }
  const float last = static_cast<float>(sample_.size() - 1);
  const auto place = sample_.begin() + static_cast<std::ptrdiff_t>(kMostly * last);
  std::nth_element(sample_.begin(), place, sample_.end());
  return *place;
}

// Finds how much of the prediction's detail beyond the base to keep. In the finest octave that both
// have, that is the covariance of prediction and joint estimate over the larger of their variances.
void BaseFusion::weigh_finer_detail(std::size_t base_level) {
  const Level& own = levels_[base_level];
  const cv::Size cells = half(own.joint.size());
  for (cv::Mat& sums : agreement_) sums.create(cells, CV_32FC1);
  for (int v = 0; v < cells.height; ++v) {
    const int rows[2] = {2 * v, std::min(2 * v + 1, own.joint.rows - 1)};
    for (int u = 0; u < cells.width; ++u) {
      const int columns[2] = {2 * u, std::min(2 * u + 1, own.joint.cols - 1)};
      Float4 p = all4(0), j = all4(0), pp = all4(0), jj = all4(0), pj = all4(0);
      for (const int row : rows) {
        for (const int column : columns) {
          const Float4 prediction = row4(own.prediction, row)[column];
          const Float4 joint = row4(own.joint, row)[column];
          p += prediction;
          j += joint;
          pp += prediction * prediction;
          jj += joint * joint;
          pj += prediction * joint;
        }
      }
      const Float4 quarter = all4(0.25f);
      agreement_[0].ptr<float>(v)[u] = sum_of(pp - quarter * p * p);
      agreement_[1].ptr<float>(v)[u] = sum_of(jj - quarter * j * j);
      agreement_[2].ptr<float>(v)[u] = sum_of(pj - quarter * p * j);
    }
  }
  for (cv::Mat& sums : agreement_) {
    smooth(sums, smoothed_);
    cv::swap(sums, smoothed_);
  }
  // Added to sums over four pixels and three colours, so that flat places count as agreeing.
  constexpr float kFlat = 12.0f;
  Level& weights = levels_[base_level + 1];
  weights.joint.create(cells, CV_32FC4);
  for (int v = 0; v < cells.height; ++v) {
    for (int u = 0; u < cells.width; ++u) {
      const float largest =
          std::max(agreement_[0].ptr<float>(v)[u], agreement_[1].ptr<float>(v)[u]);
      row4(weights.joint, v)[u] = all4(
          std::clamp((agreement_[2].ptr<float>(v)[u] + kFlat) / (largest + kFlat), 0.0f, 1.0f));
    }
  }
  Level& base = levels_[base_level];
  for (int v = 0; v < base.joint.rows; ++v) {
    Float4* joint = row4(base.joint, v);
    for_enlarged_row(weights.joint, v, base.joint.cols, row4(mixed_, 0),
                     [&](int u, Float4 weight) { joint[u][3] = weight[3]; });
  }
}

// The joint estimate of a level minus the weighted prediction; the weight is the fourth number of
// the pixels.
void BaseFusion::rest_beyond_base(std::size_t level) {
  const Level& own = levels_[level];
  rest_.create(own.joint.size(), CV_32FC4);
  for (int v = 0; v < rest_.rows; ++v) {
    const Float4* joint = row4(own.joint, v);
    const Float4* prediction = row4(own.prediction, v);
    Float4* to = row4(rest_, v);
    for (int u = 0; u < rest_.cols; ++u) {
      const float weight = joint[u][3];
      to[u] = joint[u] - all4(weight) * prediction[u];
      to[u][3] = weight;
    }
  }
}

void BaseFusion::finish_beyond_base(cv::Mat& bgr) {
  float* const from = floats_.ptr<float>(0);
  float* const to = floats_.ptr<float>(1);
  for (int v = 0; v < bgr.rows; ++v) {
    auto* colours = bgr.ptr<std::uint8_t>(v);
    to_floats(colours, 3 * bgr.cols, from);
    for_enlarged_row(rest_, v, bgr.cols, row4(mixed_, 0), [&](int u, Float4 rest) {
      store_pixel(rest + all4(rest[3]) * load_pixel(from, u), to, u);
    });
    to_bytes(to, 3 * bgr.cols, colours);
  }
}

void BaseFusion::finish_at_base(const BaseImage& base, PredictedView& view) {
  float* const predicted = floats_.ptr<float>(0);
  float* const sent = floats_.ptr<float>(1);
  float* const to = floats_.ptr<float>(2);
  for (int v = 0; v < view.bgr.rows; ++v) {
    auto* colours = view.bgr.ptr<std::uint8_t>(v);
    to_floats(colours, 3 * view.bgr.cols, predicted);
    to_floats(base.bgr.ptr<std::uint8_t>(v), 3 * view.bgr.cols, sent);
    for_enlarged_row(rest_, v, view.bgr.cols, row4(mixed_, 0), [&](int u, Float4 rest) {
      const Float4 prediction = load_pixel(predicted, u);
      const Float4 difference = load_pixel(sent, u) - prediction;
      store_pixel(prediction + rest + all4(rest[3]) * difference, to, u);
    });
    to_bytes(to, 3 * view.bgr.cols, colours);
  }
}

}  // namespace rprr
