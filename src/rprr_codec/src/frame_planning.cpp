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

Result<bool> FrameEncoder::encode_as_asked(EncodedFrame& frame) {
  if (frame.sparse && options_.objective != Objective::kFixed) return plan(frame);
  return encode_colour(frame, settings());
}

// Sparse frames, objectives kView and kMap: what sparse_colours asks for.
Result<bool> FrameEncoder::plan(EncodedFrame& frame) {
  const LayerLadder& ladder = ladder_for(frame);
  const SparseColours& goal = options_.sparse_colours;
  if (goal.by == SparseColours::By::kBytes) {
    const auto short_enough = [&goal](const EncodedFrame& trial) {
      return static_cast<double>(serialise(trial).size()) <= goal.amount;
    };
    return search(ladder.all(), true, short_enough, last_rung_, frame);
  }
  if (goal.by == SparseColours::By::kPsnr) {
    const auto good_enough = [this, &goal](const EncodedFrame& trial) {
      const Result<double> psnr = sent_psnr(trial);  // what cannot be told counts as no
      return psnr && *psnr >= goal.amount;
    };
    return search(ladder.all(), false, good_enough, last_rung_, frame);
  }
  return try_settings(ladder.at(ladder.usual()), frame);
}

// For what is longer as the options ask for it.
Result<bool> FrameEncoder::coarsen(EncodedFrame& frame, std::size_t limit) {
  const std::vector<LayerSettings> rungs = coarser_settings(frame);
  if (rungs.empty()) return encode_as_asked(frame);
  const auto short_enough = [limit](const EncodedFrame& trial) {
    return serialise(trial).size() <= limit;
  };
  return search(rungs, true, short_enough, last_coarse_rung_, frame);
}

std::vector<LayerSettings> FrameEncoder::coarser_settings(const EncodedFrame& frame) const {
  if (frame.sparse && options_.objective != Objective::kFixed) {
    const LayerLadder& ladder = ladder_for(frame);
    const bool usual = options_.sparse_colours.by == SparseColours::By::kQuality;
    return {ladder.all().begin(), ladder.all().begin() + (usual ? ladder.usual() : ladder.rungs())};
  }
  std::vector<LayerSettings> rungs;
  for (const int quality : coarser_qualities(layers_.info(), options_.colour_quality)) {
    rungs.push_back(settings());
    rungs.back().detail_quality = quality;
  }
  return rungs;
}

// The finest rung that is good (bytes rise with the rungs), or the coarsest that is (quality does).
// From where the last search ended it goes up or down by growing strides, then by halving.
Result<bool> FrameEncoder::search(const std::vector<LayerSettings>& rungs, bool finest,
                                  const Judge& good, int& last, EncodedFrame& frame) {
  const int count = static_cast<int>(rungs.size());
  // Rungs up to `low` are on the one side (short enough; not good enough), from `high` on the
  // other.
  int low = -1;
  int high = count;
  int rung = std::min(last, count - 1);
  int stride = 1;
  std::optional<EncodedFrame> best;
  int best_rung = finest ? 0 : count - 1;
  while (high - low > 1) {
    EncodedFrame trial = frame;
    Result<bool> done = try_settings(rungs[static_cast<std::size_t>(rung)], trial);
    if (!done) return done;
    frame.report.ms_encode = trial.report.ms_encode;
    const bool is_good = good(trial);
    (is_good == finest ? low : high) = rung;
    if (is_good || (!best && rung == best_rung)) {
      best = std::move(trial);
      best_rung = rung;
    }
    const bool bracketed = low >= 0 && high < count;
    rung = bracketed ? (low + high) / 2
                     : std::clamp(is_good == finest ? rung + stride : rung - stride, low + 1,
                                  std::max(high - 1, low + 1));
    stride *= 2;
  }
  last = best_rung;
  if (!best) return try_settings(rungs[static_cast<std::size_t>(best_rung)], frame);
  const float ms_encode = frame.report.ms_encode;
  frame = std::move(*best);
  frame.report.ms_encode = ms_encode;
  return true;
}

const LayerLadder& FrameEncoder::ladder_for(const EncodedFrame& frame) const {
  const bool few = frame.mask.count() < kFewBlocksShare * frame.mask.grid().count();
  return ladders_[few ? 1 : 0];
}

Result<bool> FrameEncoder::try_settings(const LayerSettings& settings, EncodedFrame& frame) {
  Result<bool> done = encode_colour(frame, settings);
  const bool some_depth = !frame.depth_mask.empty() && frame.depth_mask.count() > 0;
  if (done && !settings.detail && some_depth) frame.mask = frame.depth_mask;
  return done;
}

// PSNR [dB] against the frame of what is sent: the detail where there is some, and the enlarged
// base elsewhere.
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
