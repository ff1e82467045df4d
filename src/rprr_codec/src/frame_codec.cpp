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

}  // namespace

Result<FrameEncoder> FrameEncoder::create(const FrameCodecOptions& options) {
  Result<std::unique_ptr<ColourEncoder>> colour =
      make_colour_encoder(options.colour_codec, options.colour_quality);
  if (!colour) return Error{colour.reason()};
  return FrameEncoder(options, std::move(*colour));
}

FrameEncoder::FrameEncoder(FrameCodecOptions options, std::unique_ptr<ColourEncoder> colour)
    : options_(std::move(options)),
      colour_(std::move(colour)),
      depth_(std::make_unique<DhcmEncoder>()) {
}

cv::Mat FrameEncoder::fill_unsent(const cv::Mat& bgr, const BlockMask& sent) {
  return options_.fill == UnsentFill::kSmooth ? smooth_.fill(bgr, sent) : black_fill(bgr, sent);
}

Result<bool> FrameEncoder::encode(const DepthFrame& depth, const cv::Mat& bgr,
                                  EncodedFrame& frame) {
  const std::string problem = mismatch(depth, bgr, frame);
  if (!problem.empty()) return Error{problem};
  const auto start = Clock::now();
  frame.colour_codec = colour_->name();
  frame.depth.clear();
  frame.colour.clear();
  if (!frame.sparse || frame.mask.count() > 0) {
    frame.depth =
        frame.sparse ? depth_->encode(depth, frame.depth_blocks()) : depth_->encode(depth);
    Result<Bytes> colour = colour_->encode(frame.sparse ? fill_unsent(bgr, frame.mask) : bgr);
    if (!colour) return Error{colour.reason()};
    frame.colour = std::move(*colour);
  }
  frame.report.ms_encode = milliseconds_since(start);
  frame.report.independent_bytes_depth = 0;
  frame.report.independent_bytes_colour = 0;
  return options_.measure_independent ? measure_independent(depth, bgr, frame) : Result<bool>(true);
}

Result<bool> FrameEncoder::measure_independent(const DepthFrame& depth, const cv::Mat& bgr,
                                               EncodedFrame& frame) {
  std::size_t depth_bytes = frame.depth.size();
  std::size_t colour_bytes = frame.colour.size();
  if (frame.sparse) {
    const Result<Bytes> colour = colour_->encode(bgr);
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
  if (!frame.camera.valid()) return Error{"camera is not valid"};
  const cv::Size size(frame.camera.width, frame.camera.height);
  const BlockGrid& grid = frame.mask.grid();
  if (frame.sparse && (grid.width != size.width || grid.height != size.height)) {
    return Error{"block mask is not of the camera's size"};
  }
  if (frame.sparse && !is_subset(frame.depth_blocks(), frame.mask)) {
    return Error{"blocks with depth are not among the blocks sent"};
  }
  if (frame.sparse && frame.mask.count() == 0) {
    if (!frame.depth.empty() || !frame.colour.empty()) {
      return Error{"frame without blocks has payloads"};
    }
    return DecodedFrame{{cv::Mat::zeros(size, CV_16UC1), DepthFrame{}.unit},
                        cv::Mat::zeros(size, CV_8UC3)};
  }
  Result<DepthFrame> depth = frame.sparse ? depth_->decode(frame.depth, frame.depth_blocks())
                                          : depth_->decode(frame.depth, size);
  if (!depth) return Error{depth.reason()};
  Result<cv::Mat> bgr = colour_->decode(frame.colour_codec, frame.colour, size);
  if (!bgr) return Error{bgr.reason()};
  return DecodedFrame{std::move(*depth), std::move(*bgr)};
}

}  // namespace rprr
