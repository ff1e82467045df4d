// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <optional>
#include <utility>

#include "peer_cameras.hpp"
#include "rprr_pose/icp_bd.hpp"
#include "rprr_pose/local_alignment.hpp"
#include "rprr_pose/samples_protocol.hpp"
#include "rprr_pose/samples_wire.hpp"
#include "rprr_pose/update_wire.hpp"
#include "rprr_wire/camera_wire.hpp"

namespace rprr {
namespace {

constexpr std::size_t kFewestPoints = 30;

// The exchange under way.
struct Exchange {
  std::uint32_t number = 0;
  RgbdFramePtr frame;
  SteadyTime deadline;
  std::uint8_t iteration = 0;
  Pose b_from_a = Pose::Identity();  // M_ab, as it crossed the wire
  double c = 0.0;
  std::optional<SampledSurface> b_points;  // of this iteration (resample) or of the exchange
  std::optional<NormalEquations> b_half;   // of this iteration
  std::optional<Camera> b_camera;
  Stamp b_stamp = 0;
  NormalEquations last_b, last_a;  // both halves of the last iteration
  std::size_t bytes = 0;
};

PoseVerdict too_few(std::size_t points) {
  return make_verdict(PoseStatus::kTooFewPoints, PoseQuantity::kValidPoints,
                      static_cast<double>(points), static_cast<double>(kFewestPoints));
}

// Translation or rotation of the last step decides, whichever is further from its limit.
PoseVerdict not_converged(const Twist& step, const SamplesOptions& options) {
  const double metres = step.head<3>().norm();
  const double radians = step.tail<3>().norm();
  if (radians * options.converged_translation > metres * options.converged_rotation) {
    return make_verdict(PoseStatus::kNotConverged, PoseQuantity::kRotationStep, radians,
                        options.converged_rotation);
  }
  return make_verdict(PoseStatus::kNotConverged, PoseQuantity::kTranslationStep, metres,
                      options.converged_translation);
}

class SamplesReference final : public ExchangeRole {
 public:
  SamplesReference(std::string self, std::string peer, const SamplesOptions& options)
      : self_(std::move(self)),
        peer_(std::move(peer)),
        options_(options),
        next_number_(options_.first_exchange) {}

  void offer(const RgbdFramePtr& frame, SteadyTime now, RoleOutput& out) override {
    if (!active_ || exchange_ || (started_once_ && now - last_start_ < options_.min_period)) return;
    start(frame, now, out);
  }

  void receive(const std::string& peer, const PoseMessage& message, SteadyTime now,
               RoleOutput& out) override {
    if (peer != peer_ || !exchange_ || receiver_of(message) != self_) return;
    if (const auto* samples = std::get_if<SamplesMessage>(&message)) {
      if (samples->exchange == exchange_->number) on_samples(*samples, now, out);
    } else if (const auto* update = std::get_if<UpdateMessage>(&message)) {
      if (update->exchange == exchange_->number) on_half(*update, now, out);
    }
  }

  void set_active(bool active) override { active_ = active; }

  void tick(SteadyTime now, RoleOutput& out) override {
    if (!exchange_ || now < exchange_->deadline) return;
    const Duration silence = now - exchange_->deadline + options_.step_timeout;
    finish(make_verdict(PoseStatus::kTimedOut, PoseQuantity::kSilence, to_seconds(silence),
                        to_seconds(options_.step_timeout)),
           out);
  }

 private:
  void start(const RgbdFramePtr& frame, SteadyTime now, RoleOutput& out) {
    started_once_ = true;
    last_start_ = now;
    exchange_.emplace();
    exchange_->number = next_number_++;
    if (next_number_ == 0) next_number_ = 1;  // 0 stands for no exchange
    exchange_->frame = frame;
    exchange_->deadline = now + options_.step_timeout;
    FrameDecision whole;
    whole.frame = frame;
    whole.exchange = exchange_->number;
    whole.peer = peer_;
    whole.action = FrameDecision::Action::kSendReference;
    whole.reason = "reference";
    out.decisions.push_back(whole);
    if (send_samples(out) && !options_.local_start) send_request(out);
  }

  // Returns false if there are too few points; the exchange has then ended.
  bool send_samples(RoleOutput& out) {
    const RgbdFrame& frame = *exchange_->frame;
    SamplesContent content;
    content.iteration = exchange_->iteration;
    cameras_.describe(frame.camera, content);
    content.unit = frame.depth.unit;
    content.points = sample_points(frame.depth, frame.camera, options_.sample_count,
                                   exchange_->number * 64 + exchange_->iteration);
    if (content.points.size() < kFewestPoints) {
      finish(too_few(content.points.size()), out);
      return false;
    }
    send(SamplesMessage{frame.stamp, frame.frame_id, peer_, exchange_->number,
                        encode_samples(content, frame.camera.width, frame.camera.height)},
         out);
    return true;
  }

  void send_request(RoleOutput& out) {
    exchange_->b_from_a = rounded_for_wire(exchange_->b_from_a);
    const std::uint8_t points_iteration =
        options_.resample ? exchange_->iteration : std::uint8_t{0};
    const PoseRequest request{exchange_->iteration, exchange_->b_from_a, exchange_->c,
                              options_.by_noise, points_iteration};
    send(UpdateMessage{exchange_->frame->stamp, peer_, exchange_->number, encode_request(request)},
         out);
  }

  void send(PoseMessage message, RoleOutput& out) {
    exchange_->bytes += serialised_bytes(message);
    out.send.push_back(std::move(message));
  }

  void on_samples(const SamplesMessage& message, SteadyTime now, RoleOutput& out) {
    Result<SamplesContent> content = decode_samples(message.data);
    if (!content) return refuse(content.reason(), out);
    if (content->iteration != exchange_->iteration || exchange_->b_points) return;
    exchange_->bytes += serialised_bytes(message);
    cameras_.learn(*content);
    const std::optional<Camera> camera = cameras_.find(content->camera_hash);
    if (!camera) return refuse("the dependent's camera is not known here", out);
    if (!cameras_.known_at_peer(exchange_->frame->camera)) {
      return refuse("this camera is not known at the dependent", out);
    }
    std::optional<SampledSurface> surface = surface_of(*content, *camera);
    if (!surface) return refuse("samples outside of their image", out);
    if (surface->points.size() < kFewestPoints) {
      return finish(too_few(surface->points.size()), out);
    }
    exchange_->b_points = std::move(surface);
    exchange_->b_camera = camera;
    exchange_->b_stamp = message.stamp;
    exchange_->deadline = now + options_.step_timeout;
    if (options_.local_start && exchange_->iteration == 0) {
      exchange_->b_from_a =
          align_locally(*exchange_->b_points, exchange_->frame->depth, exchange_->frame->camera)
              .b_from_a;
      return send_request(out);
    }
    iterate(now, out);
  }

  void on_half(const UpdateMessage& message, SteadyTime now, RoleOutput& out) {
    const Result<PoseHalf> half = decode_half(message.data);
    if (!half) return refuse(half.reason(), out);
    if (half->iteration != exchange_->iteration || exchange_->b_half) return;
    exchange_->bytes += serialised_bytes(message);
    exchange_->b_half = half->equations;
    exchange_->deadline = now + options_.step_timeout;
    iterate(now, out);
  }

  // One step of the paper's eqs. 2-6, once both of b's answers are here.
  void iterate(SteadyTime now, RoleOutput& out) {
    Exchange& exchange = *exchange_;
    if (!exchange.b_points || !exchange.b_half) return;
    const IcpWeights weights{exchange.c, options_.by_noise};
    exchange.last_b = *exchange.b_half;
    exchange.last_a = half_at_reference(*exchange.b_points, exchange.frame->depth,
                                        exchange.frame->camera, exchange.b_from_a, weights);
    NormalEquations both = exchange.last_b;
    both += exchange.last_a;
    ++exchange.iteration;
    Twist step = Twist::Zero();
    if (!solve(both, step)) {
      const std::optional<PoseVerdict> why = why_unsolved(both, options_.limits);
      return finish(why ? *why : not_converged(step, options_), out);
    }
    exchange.b_from_a = exp_se3(step) * exchange.b_from_a;
    exchange.c = both.sum_abs_dz / both.matched;
    if (step.head<3>().norm() < options_.converged_translation &&
        step.tail<3>().norm() < options_.converged_rotation) {
      return finish(verify(exchange.last_b, exchange.last_a, options_.limits), out);
    }
    if (exchange.iteration >= options_.max_iterations) {
      return finish(not_converged(step, options_), out);
    }
    ask_again(now, out);
  }

  void ask_again(SteadyTime now, RoleOutput& out) {
    exchange_->deadline = now + options_.step_timeout;
    exchange_->b_half.reset();
    if (options_.resample) {
      exchange_->b_points.reset();
      if (!send_samples(out)) return;
    }
    send_request(out);
  }

  void refuse(const std::string& why, RoleOutput& out) {
    out.problems.push_back({peer_, why});
    finish({PoseStatus::kMalformed}, out);
  }

  void finish(const PoseVerdict& verdict, RoleOutput& out) {
    const Exchange exchange = std::move(*exchange_);
    exchange_.reset();
    NormalEquations both = exchange.last_b;
    both += exchange.last_a;
    RelativePoseMessage pose;
    pose.stamp = exchange.frame->stamp;
    pose.frame_id = exchange.frame->frame_id;
    pose.dependent_stamp = exchange.b_stamp;
    pose.dependent = peer_;
    pose.exchange = exchange.number;
    pose.verdict = verdict;
    pose.b_from_a = exchange.b_from_a;
    pose.covariance = covariance_of(both);
    pose.iterations = exchange.iteration;
    pose.inliers = static_cast<std::uint16_t>(both.consistent);
    if (both.sum_weight > 0.0) {
      pose.residual = static_cast<float>(std::sqrt(both.sum_residual2 / both.sum_weight));
    }
    pose.bytes_spent = static_cast<std::uint32_t>(exchange.bytes + serialised_bytes(pose));
    out.send.emplace_back(pose);
    if (!verdict.accepted()) return;
    FrameDecision predict;
    predict.action = FrameDecision::Action::kPredict;
    predict.frame = exchange.frame;
    predict.exchange = exchange.number;
    predict.peer = peer_;
    predict.pose = pose;
    predict.peer_camera = exchange.b_camera;
    predict.exchange_bytes = pose.bytes_spent;
    out.decisions.push_back(predict);
  }

  const std::string self_;
  const std::string peer_;
  const SamplesOptions options_;
  PeerCameras cameras_;
  bool active_ = true;
  std::optional<Exchange> exchange_;
  std::uint32_t next_number_;
  SteadyTime last_start_;
  bool started_once_ = false;
};

}  // namespace

std::unique_ptr<ExchangeRole> make_samples_reference(const std::string& self,
                                                     const std::string& peer,
                                                     const SamplesOptions& options) {
  return std::make_unique<SamplesReference>(self, peer, options);
}

}  // namespace rprr
