// SPDX-License-Identifier: BSD-3-Clause
#include <opencv2/core.hpp>
#include <utility>

#include "rprr_codec/frame_codec.hpp"
#include "rprr_wire/mask_wire.hpp"

namespace rprr {
namespace {

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

}  // namespace

FrameDecoder::FrameDecoder(std::unique_ptr<ColourDecoder> colour)
    : colour_(std::move(colour)), depth_(std::make_unique<DhcmDecoder>()) {
}

Result<DecodedFrame> FrameDecoder::decode(const EncodedFrame& frame) {
  const std::string wrong = inconsistency(frame);
  if (!wrong.empty()) return Error{wrong};
  DecodedFrame decoded;
  Result<bool> done = decode_depth(frame, decoded);
  if (done) done = decode_layers(frame, decoded);
  if (!done) return Error{done.reason()};
  return decoded;
}

Result<DecodedFrame> FrameDecoder::decode_colours(const EncodedFrame& frame) {
  const std::string wrong = inconsistency(frame);
  if (!wrong.empty()) return Error{wrong};
  DecodedFrame decoded;
  const Result<bool> done = decode_layers(frame, decoded);
  if (!done) return Error{done.reason()};
  return decoded;
}

Result<bool> FrameDecoder::decode_layers(const EncodedFrame& frame, DecodedFrame& decoded) {
  Result<bool> done = decode_detail(frame, decoded);
  if (!done || frame.base_reduction == 0) return done;
  Result<cv::Mat> base = decode_base(frame);
  if (!base) return Error{base.reason()};
  decoded.base = std::move(*base);
  return true;
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

Result<cv::Mat> FrameDecoder::decode_base(const EncodedFrame& frame) {
  if (!is_base_reduction(frame.base_reduction)) return Error{"frame with an impossible base"};
  const cv::Size size = base_size({frame.camera.width, frame.camera.height}, frame.base_reduction);
  Result<cv::Mat> base = colour_->decode(frame.base_codec, frame.base, size);
  if (!base) return Error{"base: " + base.reason()};
  return base;
}

}  // namespace rprr
