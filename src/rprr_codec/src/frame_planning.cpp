// SPDX-License-Identifier: BSD-3-Clause
// How FrameEncoder chooses its layers.
#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <optional>
#include <utility>

#include "rprr_codec/frame_codec.hpp"

namespace rprr {
namespace {

constexpr int kChannels = 3;

}  // namespace

// Climbs or descends from the last frame's rung to the finest that is within the budget, or the
// coarsest that reaches the target.
Result<bool> FrameEncoder::plan(EncodedFrame& frame) {
  const bool few = frame.mask.count() < kFewBlocksShare * frame.mask.grid().count();
  const LayerLadder& ladder = ladders_[few ? 1 : 0];
  const bool budget = options_.byte_budget > 0;
  if (!budget && !(options_.target_psnr > 0.0))
    return try_settings(ladder.at(ladder.usual()), frame);
  // Rungs up to `low` are on the one side (short enough; not good enough), from `high` on the
  // other.
  int low = -1;
  int high = ladder.rungs();
  int rung = std::min(last_rung_, high - 1);
  int stride = 1;
  std::optional<EncodedFrame> best;
  int best_rung = budget ? 0 : high - 1;
  while (high - low > 1) {
    EncodedFrame trial = frame;
    Result<bool> done = try_settings(ladder.at(rung), trial);
    if (!done) return done;
    frame.report.ms_encode = trial.report.ms_encode;
    const bool enough = good_enough(trial);
    (enough == budget ? low : high) = rung;
    if (enough || (!best && rung == best_rung)) {
      best = std::move(trial);
      best_rung = rung;
    }
    const bool bracketed = low >= 0 && high < ladder.rungs();
    rung = bracketed ? (low + high) / 2
                     : std::clamp(enough == budget ? rung + stride : rung - stride, low + 1,
                                  std::max(high - 1, low + 1));
    stride *= 2;
  }
  last_rung_ = best_rung;
  if (!best) return try_settings(ladder.at(best_rung), frame);
  const float ms_encode = frame.report.ms_encode;
  frame = std::move(*best);
  frame.report.ms_encode = ms_encode;
  return true;
}

Result<bool> FrameEncoder::try_settings(const LayerSettings& settings, EncodedFrame& frame) {
  Result<bool> done = encode_colour(frame, settings);
  const bool some_depth = !frame.depth_mask.empty() && frame.depth_mask.count() > 0;
  if (done && !settings.detail && some_depth) frame.mask = frame.depth_mask;
  return done;
}

// Within the budget, or at the target. What cannot be told counts as no.
bool FrameEncoder::good_enough(const EncodedFrame& frame) {
  if (options_.byte_budget > 0) return serialise(frame).size() <= options_.byte_budget;
  const Result<double> psnr = sent_psnr(frame);
  return psnr && *psnr >= options_.target_psnr;
}

// Of detail where there is some and the enlarged base elsewhere, against the frame's colours.
Result<double> FrameEncoder::sent_psnr(const EncodedFrame& frame) {
  Result<DecodedFrame> sent = own_decoder_.decode_colours(frame);
  if (!sent) return Error{sent.reason()};
  const cv::Mat& truth = layers_.image();
  double sum = 0.0;
  cv::Mat row(1, truth.cols, CV_8UC3);
  const BlockGrid& grid = frame.mask.grid();
  for (int v = 0; v < truth.rows; ++v) {
    enlarge_row(sent->base, frame.base_reduction, v, row);
    const auto* base = row.ptr<std::uint8_t>();
    const auto* detail = sent->bgr.ptr<std::uint8_t>(v);
    const auto* wanted = truth.ptr<std::uint8_t>(v);
    for (int column = 0; column < grid.columns; ++column) {
      const bool received = sent->has_detail && frame.mask[grid.index(column, v / kBlockSide)];
      const auto* from = received ? detail : base;
      const int end = kChannels * std::min((column + 1) * kBlockSide, truth.cols);
      for (int i = kChannels * column * kBlockSide; i < end; ++i) {
        const double difference = from[i] - wanted[i];
        sum += difference * difference;
      }
    }
  }
  const double mean = sum / (kChannels * static_cast<double>(truth.total()));
  return mean > 0.0 ? 10.0 * std::log10(255.0 * 255.0 / mean) : 99.0;
}

}  // namespace rprr
