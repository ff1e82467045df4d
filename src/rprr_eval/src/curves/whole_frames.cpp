// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "rprr_eval/curves/pair_curves.hpp"
#include "rprr_radio/frame_chunk.hpp"
#include "rprr_wire/bytes.hpp"

namespace rprr {
namespace {

FrameEncoder plain_encoder(DhcmMode depth_mode) {
  FrameCodecOptions options;
  options.depth_mode = depth_mode;
  return std::move(*FrameEncoder::create(options));  // its own defaults are never refused
}

}  // namespace

WholeFrames::WholeFrames(const std::map<std::string, double>& also, DhcmMode depth_mode)
    : also_(also), codecs_(make_whole_colours()), encoder_(plain_encoder(depth_mode)) {
}

Result<const std::vector<MethodCurve>*> WholeFrames::of(const std::string& key,
                                                        const RgbdFrame& b) {
  if (key == key_) return &curves_;
  key_.clear();
  curves_.clear();
  for (const auto& codec : codecs_) {
    Result<MethodCurve> curve = measure(*codec, b);
    if (!curve) return Error{curve.reason()};
    curves_.push_back(std::move(*curve));
  }
  key_ = key;
  return &curves_;
}

Result<MethodCurve> WholeFrames::measure(WholeColour& codec, const RgbdFrame& b) {
  MethodCurve curve{codec.name(), {}, {}};
  std::vector<double> settings = codec.settings();
  const auto also = also_.find(curve.method);
  const bool is_known = also == also_.end() ||
                        std::find(settings.begin(), settings.end(), also->second) != settings.end();
  if (!is_known) settings.push_back(also->second);

  EncodedFrame frame;
  frame.camera = b.camera;
  const Result<bool> prepared = encoder_.prepare(b.depth, b.bgr, frame);
  if (!prepared) return Error{prepared.reason()};
  set_usual_times(frame.report);
  const Result<DepthFrame> decoded_depth = DhcmDecoder().decode(frame.depth);
  if (!decoded_depth) return Error{decoded_depth.reason()};
  frame.colour_codec = curve.method;
  for (const double setting : settings) {
    Result<Bytes> payload = codec.encode(b.bgr, setting);
    if (!payload) return Error{payload.reason()};
    frame.colour = std::move(*payload);
    const Result<cv::Mat> bgr = codec.decode(frame.colour, b.bgr.size());
    if (!bgr) return Error{bgr.reason()};
    RatePoint point;
    point.setting = setting;
    point.bytes = encoded_message_bytes(b.frame_id.size(), serialise(frame).size());
    point.bytes_depth = frame.depth.size();
    point.bytes_colour = frame.colour.size();
    point.bgr = *bgr;
    point.psnr = *psnr(point.bgr, b.bgr);
    point.ssim = ssim(point.bgr, b.bgr);
    point.depth = depth_quality(*decoded_depth, b.depth);
    if (also != also_.end() && setting == also->second) curve.at_profile = point;
    curve.points.push_back(std::move(point));
  }
  std::sort(curve.points.begin(), curve.points.end(),
            [](const RatePoint& one, const RatePoint& other) { return one.bytes < other.bytes; });
  return curve;
}

}  // namespace rprr
