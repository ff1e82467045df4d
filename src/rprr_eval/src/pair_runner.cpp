// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_eval/pair_runner.hpp"

#include <chrono>
#include <utility>

#include "rprr_geometry/motion.hpp"
#include "rprr_radio/frame_chunk.hpp"
#include "rprr_redundancy/decision.hpp"
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

template <typename Action>
double milliseconds(const Action& action) {
  const auto start = std::chrono::steady_clock::now();
  action();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
      .count();
}

PoseFramePtr pose_frame(const RgbdImage& image, const Camera& camera, Stamp stamp,
                        const std::string& frame_id) {
  auto frame = std::make_shared<PoseFrame>();
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

struct PairRunner::Robots {
  Robots(const Profile& profile, FrameEncoder frame_encoder)
      : harness(reference_role(profile), dependent_role(profile), kLatency),
        decider(profile.decision),
        validator(profile.validation),
        outgoing(kB, profile.outgoing),
        encoder(std::move(frame_encoder)),
        independent_decoder(make_local_colour_decoder()),
        station(station_options(profile.station), make_isolated_colour_decoder()) {}

  template <typename Options>
  static Options between(Options options, const std::string& self, const std::string& peer) {
    options.self = self;
    options.peer = peer;
    return options;
  }
  static std::unique_ptr<ExchangeRole> reference_role(const Profile& profile) {
    return profile.use_previews ? make_preview_reference(between(profile.preview, kA, kB))
                                : make_samples_reference(between(profile.samples, kA, kB));
  }
  static std::unique_ptr<ExchangeRole> dependent_role(const Profile& profile) {
    return profile.use_previews ? make_preview_dependent(between(profile.preview, kB, kA))
                                : make_samples_dependent(between(profile.samples, kB, kA));
  }
  static StationOptions station_options(StationOptions options) {
    options.robots = {kA, kB};
    return options;
  }

  ExchangeHarness harness;
  Decider decider;
  Validator validator;
  Outgoing outgoing;
  FrameEncoder encoder;
  FrameDecoder independent_decoder;
  Station station;
  Stamp now = from_seconds(1000.0);
};

namespace {

// What b sends, decided by b's own state machine from the exchange and a's prediction.
OutgoingDecision decide(PairResult& result, const PoseFramePtr& a, const PoseFramePtr& b,
                        Decider& decider, Validator& validator, Outgoing& outgoing, Stamp now) {
  const FrameDecision& at_b = result.exchange.at_dependent;
  if (at_b.action != FrameDecision::Action::kSendSparse || !result.exchange.at_reference) {
    const auto decisions = outgoing.whole(b->stamp, at_b.exchange, at_b.reason);
    return decisions.empty() ? OutgoingDecision{} : decisions.front();
  }
  Bytes mask;
  result.ms_predict = milliseconds([&] {
    const FrameDecision& at_a = *result.exchange.at_reference;
    const Result<BlockPreview> preview = decode_preview(at_a.peer_preview);
    const BlockDecision decision = decider.decide(a->depth, a->bgr, a->camera, *at_a.peer_camera,
                                                  at_a.pose.motion, preview ? &*preview : nullptr);
    mask = encode_mask_pair(decision.send);
  });
  BlockMask validated;
  result.ms_validate = milliseconds([&] {
    validated = validator.validate(b->depth, b->camera, *at_b.peer_camera, at_b.pose.motion);
  });
  auto decisions = outgoing.accepted(b->stamp, at_b.exchange, validated, now);
  const auto more = outgoing.prediction({kB, at_b.exchange, b->stamp, mask, 0}, now);
  decisions.insert(decisions.end(), more.begin(), more.end());
  return decisions.empty() ? OutgoingDecision{} : decisions.front();
}

EncodedFrame frame_to_encode(const PreparedPair& pair) {
  const OutgoingDecision& decision = pair.decision;
  const PairResult& result = pair.result;
  const FrameDecision& at_b = result.exchange.at_dependent;
  EncodedFrame encoded;
  encoded.camera = pair.b->camera;
  encoded.sparse = decision.sparse;
  if (decision.sparse) {
    encoded.reference = kA;
    encoded.reference_stamp = at_b.pose.stamp;
    encoded.motion = at_b.pose.motion;
    encoded.mask = decision.mask;
    encoded.depth_mask = decision.depth_mask;
  }
  FrameReport& report = encoded.report;
  report.blocks_predicted = static_cast<std::uint16_t>(decision.blocks_predicted);
  report.blocks_validated = static_cast<std::uint16_t>(decision.blocks_validated);
  report.bytes_pose = static_cast<std::uint32_t>(result.exchange.bytes);
  report.bytes_masks = static_cast<std::uint32_t>(decision.message_bytes);
  report.ms_pose = static_cast<float>(result.exchange.seconds_compute * 1e3);
  report.ms_predict = static_cast<float>(result.ms_predict);
  report.ms_validate = static_cast<float>(result.ms_validate);
  return encoded;
}

Result<RebuiltFrame> send(const EncodedFrame& encoded, const PoseFrame& frame,
                          const std::string& robot, std::uint32_t exchange, Station& station,
                          Stamp now) {
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
  const Pose truth_ab = relative_motion(*world_a, *world_b);
  result.overlap = overlap(pair.a->depth, pair.a->camera, pair.b->depth, pair.b->camera, truth_ab);
  if (result.exchange.pose) {
    result.pose_error = pose_error(result.exchange.pose->motion, truth_ab);
  }
}

void judge_view(const PoseFrame& b, PairResult& result) {
  const RebuiltFrame& rebuilt = result.rebuilt;
  result.psnr = *psnr(rebuilt.bgr, b.bgr);
  result.ssim = ssim(rebuilt.bgr, b.bgr);
  result.psnr_predicted =
      psnr(rebuilt.bgr, b.bgr, rebuilt.provenance < static_cast<double>(kReceivedColour));
  result.depth = depth_quality(rebuilt.depth, b.depth);
  result.depth_exact = received_depth_is_exact(rebuilt, b.depth);
}

// The rival: b's whole frame through the same codecs. Empty, or what went wrong.
std::string judge_independent(const PoseFrame& b, FrameEncoder& encoder, FrameDecoder& decoder,
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
  pair.a = pose_frame(*image_a, camera, robots.now, kFrameA);
  pair.b = pose_frame(*image_b, camera, robots.now, kFrameB);
  pair.result.a = a;
  pair.result.b = b;

  // a sends its frame whole, as the reference.
  EncodedFrame whole_a;
  whole_a.camera = camera;
  const Result<bool> done = robots.encoder.encode(pair.a->depth, pair.a->bgr, whole_a);
  if (!done) return Error{done.reason()};
  const Result<RebuiltFrame> at_station = send(whole_a, *pair.a, kA, 0, robots.station, robots.now);
  if (!at_station) return Error{at_station.reason()};

  // a and b agree on their pose, a predicts, b validates.
  pair.result.exchange = robots.harness.run(pair.a, pair.b);
  pair.decision = decide(pair.result, pair.a, pair.b, robots.decider, robots.validator,
                         robots.outgoing, robots.now);
  pair.result.blocks_predicted = pair.decision.blocks_predicted;
  pair.result.blocks_validated = pair.decision.blocks_validated;
  judge_pose(folder, pair);
  return pair;
}

Result<EncodedFrame> PairRunner::encode(const PreparedPair& pair, FrameEncoder& encoder) {
  EncodedFrame encoded = frame_to_encode(pair);
  const Result<bool> done = encoder.encode(pair.b->depth, pair.b->bgr, encoded);
  if (!done) return Error{done.reason()};
  return encoded;
}

Result<RebuiltFrame> PairRunner::rebuild(const PreparedPair& pair, const EncodedFrame& encoded) {
  return send(encoded, *pair.b, kB, pair.decision.exchange, robots_->station, robots_->now);
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
