// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_codec/frame_codec.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <opencv2/core.hpp>
#include <utility>

#include "rprr_wire/bytes.hpp"
#include "rprr_wire/mask_wire.hpp"

namespace rprr {
namespace {

constexpr int kChannels = 3;

using Clock = std::chrono::steady_clock;

float milliseconds_since(Clock::time_point start) {
  return std::chrono::duration<float, std::milli>(Clock::now() - start).count();
}

bool has_size(const cv::Mat& image, const Camera& camera) {
  return image.cols == camera.width && image.rows == camera.height;
}

// Empty where the inputs fit together.
std::string mismatch(const DepthFrame& depth, const cv::Mat& bgr, const EncodedFrame& frame) {
  if (!frame.camera.valid()) return "camera is not valid";
  if (!has_size(depth.counts, frame.camera)) return "depth image is not of the camera's size";
  if (!has_size(bgr, frame.camera)) return "colour image is not of the camera's size";
  if (depth.counts.type() != CV_16UC1) return "depth image is not 16UC1";
  if (bgr.type() != CV_8UC3) return "colour image is not 8-bit BGR";
  const BlockGrid& grid = frame.mask.grid();
  if (frame.sparse && (grid.width != frame.camera.width || grid.height != frame.camera.height)) {
    return "block mask is not of the camera's size";
  }
  if (frame.sparse && !is_subset(frame.depth_blocks(), frame.mask)) {
    return "blocks with depth are not among the blocks sent";
  }
  return {};
}

// Empty, or why settings of layers do not exist.
std::string impossible(const LayerSettings& settings, const ColourLayers& layers) {
  const auto check = [](const ColourCodecInfo& info, int quality) {
    return info.has_quality(quality)
               ? std::string()
               : "quality of " + info.name + " is " + std::to_string(quality) + ", must be " +
                     std::to_string(info.best) + " (best) to " + std::to_string(info.coarsest) +
                     " (coarsest)";
  };
  if (settings.base_reduction == 0) return check(layers.info(), settings.detail_quality);
  if (!is_base_reduction(settings.base_reduction)) {
    return "the base is reduced " + std::to_string(settings.base_reduction) +
           " times, must be 0 (no base), 1, 2, 4, 8 or 16";
  }
  const std::string wrong = check(layers.info(), settings.base_quality);
  return wrong.empty() && settings.detail ? check(layers.info(), settings.detail_quality) : wrong;
}

LayerLadder ladder_of(const FrameCodecOptions& options, const ColourLayers& layers,
                      bool few_blocks) {
  const double quality = as_webp(layers.info(), options.colour_quality);
  return LayerLadder(options.objective, few_blocks, layers.info(),
                     options.objective == Objective::kView ? kViewShare * quality : quality);
}

}  // namespace

Result<FrameEncoder> FrameEncoder::create(const FrameCodecOptions& options) {
  Result<ColourLayers> layers = ColourLayers::create(options.colour_codec, options.fill);
  if (!layers) return Error{"colour_codec: " + layers.reason()};
  if (options.objective == Objective::kFixed &&
      options.sparse_colours.by != SparseColours::By::kQuality) {
    return Error{"sparse_colours: " + text_of(options.sparse_colours) +
                 " is not, allowed under objective fixed: quality"};
  }
  FrameEncoder encoder(options, std::move(*layers));
  const std::string wrong = impossible(encoder.settings(), encoder.layers_);
  if (!wrong.empty()) return Error{"colour_quality: " + wrong};
  return encoder;
}

FrameEncoder::FrameEncoder(FrameCodecOptions options, ColourLayers layers)
    : options_(std::move(options)),
      layers_(std::move(layers)),
      ladders_{ladder_of(options_, layers_, false), ladder_of(options_, layers_, true)},
      last_rung_(ladders_[0].usual()),
      depth_(std::make_unique<DhcmEncoder>(options_.depth_mode)),
      own_decoder_(make_local_colour_decoder()) {
}

LayerSettings FrameEncoder::settings() const {
  return {0, 0, options_.colour_quality, true};
}

Result<bool> FrameEncoder::encode(const DepthFrame& depth, const cv::Mat& bgr,
                                  EncodedFrame& frame) {
  return encode_within(depth, bgr, frame, 0);
}

Result<bool> FrameEncoder::encode_within(const DepthFrame& depth, const cv::Mat& bgr,
                                         EncodedFrame& frame, std::size_t limit) {
  Result<bool> done = prepare(depth, bgr, frame);
  if (!done) return done;
  if (limit > 0) {
    round_depth(depth, frame, limit);
    // Colours get a fifth of the frame.
    limit = std::max(limit, frame.depth.size() + frame.depth.size() / 4);
  }
  const EncodedFrame prepared = limit > 0 ? frame : EncodedFrame();
  done = encode_as_asked(frame);
  if (done && limit > 0 && serialise(frame).size() > limit) {
    const float ms_encode = frame.report.ms_encode;
    frame = prepared;
    frame.report.ms_encode = ms_encode;
    done = coarsen(frame, limit);
  }
  if (done && options_.measure_independent) {
    done = measure_independent(depth, options_.colour_quality, frame);
  }
  return done;
}

Result<bool> FrameEncoder::encode(const DepthFrame& depth, const cv::Mat& bgr, EncodedFrame& frame,
                                  const LayerSettings& settings) {
  Result<bool> done = prepare(depth, bgr, frame);
  if (done) done = encode_colour(frame, settings);
  if (done && options_.measure_independent) {
    done = measure_independent(depth, settings.detail_quality, frame);
  }
  return done;
}

Result<bool> FrameEncoder::prepare(const DepthFrame& depth, const cv::Mat& bgr,
                                   EncodedFrame& frame) {
  const std::string problem = mismatch(depth, bgr, frame);
  if (!problem.empty()) return Error{problem};
  const auto start = Clock::now();
  layers_.prepare(bgr, frame.sparse ? &frame.mask : nullptr);
  frame.depth_rounded = false;
  encode_depth(depth, frame);
  frame.report.ms_encode = milliseconds_since(start);
  frame.report.independent_bytes_depth = 0;
  frame.report.independent_bytes_colour = 0;
  return true;
}

void FrameEncoder::encode_depth(const DepthFrame& depth, EncodedFrame& frame) {
  frame.depth.clear();
  if (!frame.sparse) {
    frame.depth = depth_->encode(depth);
  } else if (frame.mask.count() > 0) {
    frame.depth = depth_->encode(depth, frame.depth_blocks());
  }
}

// By growing steps, until it leaves colours their share.
void FrameEncoder::round_depth(const DepthFrame& depth, EncodedFrame& frame, std::size_t limit) {
  const auto start = Clock::now();
  for (const double share : {0.25, 0.5, 1.0}) {
    if (!(options_.depth_step > 0.0) || 5 * frame.depth.size() <= 4 * limit) break;
    frame.depth_rounded = true;
    encode_depth(rounder_.round(depth, share * options_.depth_step), frame);
  }
  frame.report.ms_encode += milliseconds_since(start);
}

Result<bool> FrameEncoder::encode_colour(EncodedFrame& frame, const LayerSettings& settings) {
  const bool has_base = frame.sparse && settings.base_reduction != 0;
  const bool has_detail = settings.detail && (!frame.sparse || frame.mask.count() > 0);
  if (!settings.detail && !has_base) return Error{"neither detail nor base is to be sent"};
  const auto start = Clock::now();
  Result<Bytes> colour = has_detail ? layers_.encode_detail(settings.detail_quality) : Bytes{};
  if (!colour) return Error{colour.reason()};
  Result<Bytes> base =
      has_base ? layers_.encode_base(settings.base_reduction, settings.base_quality, has_detail)
               : Bytes{};
  if (!base) return Error{base.reason()};
  frame.colour_codec = layers_.codec();
  frame.colour = std::move(*colour);
  frame.colour_layout = has_detail ? layers_.layout() : ColourLayout::kInPlace;
  frame.base_codec = has_base ? layers_.codec() : std::string();
  frame.base = std::move(*base);
  frame.base_reduction = has_base ? settings.base_reduction : 0;
  if (has_base) {
    const Result<float> noise = noise_of_base(frame, has_detail);
    if (!noise) return Error{noise.reason()};
    frame.base_noise = *noise;
  }
  frame.report.ms_encode += milliseconds_since(start);
  return true;
}

// RMS error of the base as the station will decode it, where no detail stands for it.
Result<float> FrameEncoder::noise_of_base(const EncodedFrame& frame, bool with_detail) {
  const cv::Mat& sent = layers_.base(frame.base_reduction, with_detail);
  const Result<cv::Mat> decoded = own_decoder_.decode_base(frame);
  if (!decoded) return Error{decoded.reason()};
  const BlockGrid& grid = frame.mask.grid();
  std::uint64_t sum = 0;
  std::uint64_t count = 0;
  for (int v = 0; v < sent.rows; ++v) {
    const auto* p = sent.ptr<std::uint8_t>(v);
    const auto* q = decoded->ptr<std::uint8_t>(v);
    const int row = v * frame.base_reduction / kBlockSide;
    for (int column = 0; column < grid.columns; ++column) {
      if (with_detail && frame.mask[grid.index(column, row)]) continue;
      const auto from = [&](int c) {
        const int u = (c * kBlockSide + frame.base_reduction - 1) / frame.base_reduction;
        return kChannels * std::min(u, sent.cols);
      };
      const int end = from(column + 1);
      for (int i = from(column); i < end; ++i) {
        const int difference = p[i] - q[i];
        sum += static_cast<std::uint64_t>(difference * difference);
      }
      count += static_cast<std::uint64_t>(end - from(column));
    }
  }
  return count == 0
             ? 1.0f
             : static_cast<float>(std::sqrt(static_cast<double>(sum) / static_cast<double>(count)));
}

Result<bool> FrameEncoder::measure_independent(const DepthFrame& depth, int quality,
                                               EncodedFrame& frame) {
  std::size_t depth_bytes = frame.depth.size();
  std::size_t colour_bytes = frame.colour.size();
  if (frame.sparse) {
    const Result<Bytes> colour = layers_.encode_whole(quality);
    if (!colour) return Error{colour.reason()};
    depth_bytes = depth_->encode(depth).size();
    colour_bytes = colour->size();
  }
  frame.report.independent_bytes_depth = static_cast<std::uint32_t>(depth_bytes);
  frame.report.independent_bytes_colour = static_cast<std::uint32_t>(colour_bytes);
  return true;
}

}  // namespace rprr
