// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_codec/frame_codec.hpp"

#include <chrono>
#include <opencv2/core.hpp>
#include <utility>

#include "rprr_geometry/block_mask_pair.hpp"

namespace rprr {
namespace {

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

// Empty, or why a frame from elsewhere cannot be decoded.
std::string inconsistency(const EncodedFrame& frame) {
  if (!frame.camera.valid()) return "camera is not valid";
  const BlockGrid& grid = frame.mask.grid();
  if (frame.sparse && (grid.width != frame.camera.width || grid.height != frame.camera.height)) {
    return "block mask is not of the camera's size";
  }
  if (frame.sparse && !is_subset(frame.depth_blocks(), frame.mask)) {
    return "blocks with depth are not among the blocks sent";
  }
  if (frame.base_reduction != 0 && !(frame.sparse && is_base_reduction(frame.base_reduction))) {
    return "frame with an impossible base";
  }
  if (!frame.sparse && frame.colour_layout != ColourLayout::kInPlace) {
    return "whole frame in the layout of a sparse one";
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
           " times, must be 0 (no base), 1, 2, 4 or 8";
  }
  const std::string wrong = check(layers.base_info(), settings.base_quality);
  return wrong.empty() && settings.detail ? check(layers.info(), settings.detail_quality) : wrong;
}

}  // namespace

Result<FrameEncoder> FrameEncoder::create(const FrameCodecOptions& options) {
  Result<ColourLayers> layers =
      ColourLayers::create(options.colour_codec, options.base_codec, options.fill);
  if (!layers) return Error{layers.reason()};
  FrameEncoder encoder(options, std::move(*layers));
  const std::string wrong = impossible(encoder.settings(), encoder.layers_);
  if (!wrong.empty()) return Error{wrong};
  return encoder;
}

FrameEncoder::FrameEncoder(FrameCodecOptions options, ColourLayers layers)
    : options_(std::move(options)),
      layers_(std::move(layers)),
      depth_(std::make_unique<DhcmEncoder>()) {
}

LayerSettings FrameEncoder::settings() const {
  return {options_.base_reduction, options_.base_quality, options_.colour_quality, true};
}

Result<bool> FrameEncoder::encode(const DepthFrame& depth, const cv::Mat& bgr,
                                  EncodedFrame& frame) {
  return encode(depth, bgr, frame, settings());
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
  frame.depth.clear();
  if (!frame.sparse) {
    frame.depth = depth_->encode(depth);
  } else if (frame.mask.count() > 0) {
    frame.depth = depth_->encode(depth, frame.depth_blocks());
  }
  frame.report.ms_encode = milliseconds_since(start);
  frame.report.independent_bytes_depth = 0;
  frame.report.independent_bytes_colour = 0;
  return true;
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
  frame.base_codec = has_base ? layers_.base_codec() : std::string();
  frame.base = std::move(*base);
  frame.base_reduction = has_base ? settings.base_reduction : 0;
  frame.report.ms_encode += milliseconds_since(start);
  return true;
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

FrameDecoder::FrameDecoder(std::unique_ptr<ColourDecoder> colour)
    : colour_(std::move(colour)), depth_(std::make_unique<DhcmDecoder>()) {
}

Result<DecodedFrame> FrameDecoder::decode(const EncodedFrame& frame) {
  const std::string wrong = inconsistency(frame);
  if (!wrong.empty()) return Error{wrong};
  DecodedFrame decoded;
  Result<bool> done = decode_depth(frame, decoded);
  if (done) done = decode_detail(frame, decoded);
  if (done) done = decode_base(frame, decoded);
  if (!done) return Error{done.reason()};
  return decoded;
}

Result<bool> FrameDecoder::decode_depth(const EncodedFrame& frame, DecodedFrame& decoded) {
  const cv::Size size(frame.camera.width, frame.camera.height);
  if (frame.sparse && frame.mask.count() == 0) {
    if (!frame.depth.empty()) return Error{"frame without blocks has depth"};
    decoded.depth = {cv::Mat::zeros(size, CV_16UC1), DepthFrame{}.unit};
    return true;
  }
  Result<DepthFrame> depth = frame.sparse ? depth_->decode(frame.depth, frame.depth_blocks())
                                          : depth_->decode(frame.depth, size);
  if (!depth) return Error{depth.reason()};
  decoded.depth = std::move(*depth);
  return true;
}

Result<bool> FrameDecoder::decode_detail(const EncodedFrame& frame, DecodedFrame& decoded) {
  const cv::Size size(frame.camera.width, frame.camera.height);
  const bool no_block = frame.sparse && frame.mask.count() == 0;
  if (no_block && !frame.colour.empty()) return Error{"frame without blocks has colour"};
  decoded.has_detail = !no_block && !(frame.base_reduction != 0 && frame.colour.empty());
  if (!decoded.has_detail) {
    decoded.bgr = cv::Mat::zeros(size, CV_8UC3);
    return true;
  }
  const Result<int> coarse = colour_payload_coarse(frame.colour_codec, frame.colour);
  decoded.coarse = coarse ? *coarse : 0;  // what is damaged fails below
  if (frame.colour_layout == ColourLayout::kCompact) {
    const CompactLayout layout(frame.mask);
    const Result<cv::Mat> compact =
        colour_->decode(frame.colour_codec, frame.colour, layout.size());
    if (!compact) return Error{compact.reason()};
    decoded.bgr = cv::Mat::zeros(size, CV_8UC3);
    layout.scatter(*compact, decoded.bgr);
    return true;
  }
  Result<cv::Mat> bgr = colour_->decode(frame.colour_codec, frame.colour, size);
  if (!bgr) return Error{bgr.reason()};
  decoded.bgr = std::move(*bgr);
  if (frame.sparse) black_out(decoded.bgr, frame.mask);
  return true;
}

Result<bool> FrameDecoder::decode_base(const EncodedFrame& frame, DecodedFrame& decoded) {
  if (frame.base_reduction == 0) return true;
  const cv::Size size = base_size({frame.camera.width, frame.camera.height}, frame.base_reduction);
  Result<cv::Mat> base = colour_->decode(frame.base_codec, frame.base, size);
  if (!base) return Error{"base: " + base.reason()};
  decoded.base = std::move(*base);
  return true;
}

}  // namespace rprr
