// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_eval/pairs/pair_runner.hpp"

#include <utility>

#include "rprr_eval/exchange/exchange_registration.hpp"
#include "rprr_geometry/relative_pose.hpp"
#include "rprr_radio/frame_chunk.hpp"
#include "rprr_view/provenance.hpp"
#include "rprr_wire/bytes.hpp"
#include "rprr_wire/camera_wire.hpp"
#include "rprr_wire/mask_wire.hpp"

namespace rprr {
namespace {

const std::string kA = "eyebug_a";
const std::string kB = "eyebug_b";
const std::string kFrameA = kA + "_rgb_optical_frame";
const std::string kFrameB = kB + "_rgb_optical_frame";
constexpr Duration kLatency = from_seconds(0.005);

RgbdFramePtr frame_of(const RgbdImage& image, const Camera& camera, Stamp stamp,
                      const std::string& frame_id) {
  auto frame = std::make_shared<RgbdFrame>();
  frame->stamp = stamp;
  frame->frame_id = frame_id;
  frame->camera = camera;
  frame->depth = image.depth;
  frame->bgr = image.bgr;
  return frame;
}

bool received_depth_is_exact(const RebuiltFrame& rebuilt, const DepthFrame& truth) {
  const BlockGrid grid(truth.width(), truth.height());
  for (int v = 0; v < truth.height(); ++v) {
    for (int u = 0; u < truth.width(); ++u) {
      if (rebuilt.sparse && !rebuilt.received_depth[grid.index_of_pixel(u, v)]) continue;
      if (rebuilt.depth.counts.at<std::uint16_t>(v, u) != truth.counts.at<std::uint16_t>(v, u)) {
        return false;
      }
    }
  }
  return true;
}

}  // namespace

// Both robots and the station: of each the stages that its nodelets run.
struct PairRunner::Robots {
  Robots(const Profile& profile, FrameEncoder frame_encoder)
      : exchange(make_exchange(profile, kA, kB, kLatency)),
        a(kA, profile),
        b(kB, profile),
        encoder(std::move(frame_encoder)),
        independent_decoder(make_local_colour_decoder()),
        station(station_options(profile.station), make_isolated_colour_decoder()) {}

  static StationOptions station_options(StationOptions options) {
    options.robots = {kA, kB};
    return options;
  }

  ExchangeHarness exchange;
  Redundancy a, b;
  FrameEncoder encoder;  // both robots code alike
  FrameDecoder independent_decoder;
  Station station;
  SteadyTime now = steady_seconds(1000.0);
};

namespace {

// What goes out of both robots' frames, from what the exchange decided: a's requests reach b.
struct OutgoingFrames {
  std::vector<OutgoingFrame> of_a, of_b;
};

OutgoingFrames decide(PairResult& result, Redundancy& a, Redundancy& b, SteadyTime now) {
  RedundancyOutput at_a, at_b;
  for (const FrameDecision& decision : result.exchange.at_reference) a.take(decision, now, at_a);
  b.take(result.exchange.at_dependent, now, at_b);
  for (const BlockRequest& request : at_a.requests) {
    result.ms_predict = static_cast<double>(request.ms);
    const Bytes mask = encode_mask_pair(request.decision.send);
    b.receive({kA, request.receiver, request.exchange, request.stamp, mask, 0}, now, at_b);
  }
  return {std::move(at_a.frames), std::move(at_b.frames)};
}

Result<RebuiltFrame> send(const EncodedFrame& encoded, const RgbdFrame& frame,
                          const std::string& robot, std::uint32_t exchange, Station& station,
                          SteadyTime now) {
  const Bytes bytes = serialise(encoded);
  StationOutput output =
      station.receive({robot, frame.stamp, frame.frame_id, exchange, bytes}, now);
  if (output.frames.empty()) {
    return Error{"the station rebuilt nothing of " + robot +
                 (output.errors.empty() ? std::string() : ": " + output.errors.front().reason)};
  }
  return std::move(output.frames.front());
}

// Against ground truth, where there is some.
void judge_pose(const TumFolder& folder, PreparedPair& pair) {
  PairResult& result = pair.result;
  const auto& world_a = folder.entries[result.a].world_from_camera;
  const auto& world_b = folder.entries[result.b].world_from_camera;
  if (!world_a || !world_b) return;
  const Pose true_b_from_a = relative_pose_of(*world_a, *world_b);
  result.overlap =
      overlap(pair.a->depth, pair.a->camera, pair.b->depth, pair.b->camera, true_b_from_a);
  if (result.exchange.pose) {
    result.pose_error = pose_error(result.exchange.pose->b_from_a, true_b_from_a);
  }
}

void judge_view(const RgbdFrame& b, PairResult& result) {
  const RebuiltFrame& rebuilt = result.rebuilt;
  result.psnr = *psnr(rebuilt.bgr, b.bgr);
  result.ssim = ssim(rebuilt.bgr, b.bgr);
  result.psnr_predicted =
      psnr(rebuilt.bgr, b.bgr, rebuilt.provenance < static_cast<double>(kReceivedColour));
  result.depth = depth_quality(rebuilt.depth, b.depth);
  result.depth_exact = received_depth_is_exact(rebuilt, b.depth);
}

// The rival: b's whole frame through the same codecs. Empty, or what went wrong.
std::string judge_independent(const RgbdFrame& b, FrameEncoder& encoder, FrameDecoder& decoder,
                              PairResult& result) {
  EncodedFrame independent;
  independent.camera = b.camera;
  const Result<bool> done = encoder.encode(b.depth, b.bgr, independent);
  if (!done) return done.reason();
  const Bytes bytes = serialise(independent, &result.independent);
  result.independent.total = encoded_message_bytes(kFrameB.size(), bytes.size());
  const Result<DecodedFrame> decoded = decoder.decode(independent);
  if (!decoded) return decoded.reason();
  result.independent_psnr = *psnr(decoded->bgr, b.bgr);
  result.independent_ssim = ssim(decoded->bgr, b.bgr);
  return {};
}

}  // namespace

PairRunner::PairRunner(std::unique_ptr<Robots> robots) : robots_(std::move(robots)) {
}
PairRunner::PairRunner(PairRunner&&) noexcept = default;
PairRunner& PairRunner::operator=(PairRunner&&) noexcept = default;
PairRunner::~PairRunner() = default;

Result<PairRunner> PairRunner::create(const Profile& profile) {
  Result<FrameEncoder> encoder = FrameEncoder::create(profile.codec);
  if (!encoder) return Error{encoder.reason()};
  return PairRunner(std::make_unique<Robots>(profile, std::move(*encoder)));
}

Result<PreparedPair> PairRunner::prepare(const TumFolder& folder, std::size_t a, std::size_t b) {
  Robots& robots = *robots_;
  robots.now += from_seconds(1.0);
  const Result<RgbdImage> image_a = folder.load(a);
  if (!image_a) return Error{image_a.reason()};
  const Result<RgbdImage> image_b = folder.load(b);
  if (!image_b) return Error{image_b.reason()};
  const Camera camera = rounded_for_wire(folder.camera);
  PreparedPair pair;
  const Stamp stamp = robots.now.since_start();  // a sensor clock that began with the steady one
  pair.a = frame_of(*image_a, camera, stamp, kFrameA);
  pair.b = frame_of(*image_b, camera, stamp, kFrameB);
  pair.result.a = a;
  pair.result.b = b;

  PairResult& result = pair.result;
  result.exchange = robots.exchange.run(pair.a, pair.b);
  OutgoingFrames outgoing = decide(result, robots.a, robots.b, robots.now);
  for (const OutgoingFrame& reference : outgoing.of_a) {
    const Result<RebuiltFrame> held = send_reference(reference, robots);
    if (!held) return Error{held.reason()};
  }
  if (outgoing.of_b.empty()) return Error{"b sends nothing"};
  pair.outgoing = std::move(outgoing.of_b.front());
  result.blocks_predicted = pair.outgoing.report.blocks_predicted;
  result.blocks_validated = pair.outgoing.report.blocks_validated;
  result.ms_validate = static_cast<double>(pair.outgoing.report.ms_validate);
  judge_pose(folder, pair);
  return pair;
}

Result<RebuiltFrame> PairRunner::send_reference(const OutgoingFrame& outgoing, Robots& robots) {
  EncodedFrame encoded = frame_to_encode(outgoing);
  const RgbdFrame& frame = *outgoing.frame;
  const Result<bool> done = robots.encoder.encode(frame.depth, frame.bgr, encoded);
  if (!done) return Error{done.reason()};
  return send(encoded, frame, kA, outgoing.exchange, robots.station, robots.now);
}

Result<EncodedFrame> PairRunner::encode(const PreparedPair& pair, FrameEncoder& encoder) {
  EncodedFrame encoded = frame_to_encode(pair.outgoing);
  const Result<bool> done = encoder.encode(pair.b->depth, pair.b->bgr, encoded);
  if (!done) return Error{done.reason()};
  return encoded;
}

Result<RebuiltFrame> PairRunner::rebuild(const PreparedPair& pair, const EncodedFrame& encoded) {
  return send(encoded, *pair.b, kB, pair.outgoing.exchange, robots_->station, robots_->now);
}

Result<PairResult> PairRunner::run(const TumFolder& folder, std::size_t a, std::size_t b) {
  Result<PreparedPair> pair = prepare(folder, a, b);
  if (!pair) return Error{pair.reason()};
  const Result<EncodedFrame> encoded = encode(*pair, robots_->encoder);
  if (!encoded) return Error{encoded.reason()};
  Result<RebuiltFrame> rebuilt = rebuild(*pair, *encoded);
  if (!rebuilt) return Error{rebuilt.reason()};
  PairResult& result = pair->result;
  result.rebuilt = std::move(*rebuilt);
  judge_view(*pair->b, result);
  const std::string wrong =
      judge_independent(*pair->b, robots_->encoder, robots_->independent_decoder, result);
  if (!wrong.empty()) return Error{wrong};
  return std::move(result);
}

}  // namespace rprr
