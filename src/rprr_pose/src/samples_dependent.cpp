// SPDX-License-Identifier: BSD-3-Clause
#include <optional>
#include <utility>

#include "peer_cameras.hpp"
#include "rprr_pose/icp_bd.hpp"
#include "rprr_pose/recent_frames.hpp"
#include "rprr_pose/samples_protocol.hpp"
#include "rprr_pose/samples_wire.hpp"
#include "rprr_pose/update_wire.hpp"
#include "rprr_wire/camera_wire.hpp"

namespace rprr {
namespace {

// The exchange under way.
struct Exchange {
  std::uint32_t number = 0;
  RgbdFramePtr frame;
  SteadyTime deadline;
  std::uint8_t iteration = 0;
  std::optional<SampledSurface> a_points;  // of this iteration (resample) or of the exchange
  std::optional<Camera> a_camera;
  std::uint32_t bytes = 0;
};

class SamplesDependent final : public ExchangeRole {
 public:
  SamplesDependent(std::string self, std::string peer, const SamplesOptions& options)
      : self_(std::move(self)),
        peer_(std::move(peer)),
        options_(options),
        frames_(options_.frames_kept, options_.max_stamp_difference) {}

  void offer(const RgbdFramePtr& frame, SteadyTime now, RoleOutput& out) override {
    frames_.add(frame);
    if (active_ && !unclaimed_since_) unclaimed_since_ = now;
    // Frames that do not fit do not make it wait longer.
    if (early_ && !exchange_) {
      begin(*std::exchange(early_, std::nullopt), early_deadline_, now, out);
    }
  }

  void receive(const std::string& peer, const PoseMessage& message, SteadyTime now,
               RoleOutput& out) override {
    if (peer != peer_ || receiver_of(message) != self_) return;
    if (const auto* samples = std::get_if<SamplesMessage>(&message)) {
      on_samples(*samples, now, out);
    } else if (const auto* update = std::get_if<UpdateMessage>(&message)) {
      on_request(*update, now, out);
    } else if (const auto* pose = std::get_if<RelativePoseMessage>(&message)) {
      on_pose(*pose, now, out);
    }
  }

  void set_active(bool active) override {
    active_ = active;
    if (!active_) unclaimed_since_.reset();
  }

  void tick(SteadyTime now, RoleOutput& out) override {
    if (exchange_ && now >= exchange_->deadline) {
      send_whole("exchange with " + peer_ + " timed out", now, out);
    }
    if (early_ && now >= early_deadline_) {
      early_.reset();
      unpaired_ = true;
    }
    if (!exchange_ && unclaimed_since_ && now - *unclaimed_since_ >= options_.silence_timeout) {
      FrameDecision alone;
      alone.frame = frames_.newest();
      alone.reason = unpaired_ ? "no frame near that of " + peer_ +
                                     " in time: clocks differ, or a camera is stuck"
                               : peer_ + " is silent";
      unpaired_ = false;
      out.decisions.push_back(alone);
      unclaimed_since_.reset();
    }
  }

 private:
  void on_samples(const SamplesMessage& message, SteadyTime now, RoleOutput& out) {
    if (exchange_ && message.exchange == exchange_->number)
      return on_more_samples(message, now, out);
    if (message.exchange == 0 || message.exchange == last_finished_) return;
    begin(message, now + options_.step_timeout, now, out);
  }

  // A new exchange: find the frame that was taken when a's was, answer with its points.
  void begin(const SamplesMessage& message, SteadyTime deadline, SteadyTime now, RoleOutput& out) {
    Result<SamplesContent> content = decode_samples(message.data);
    if (!content || content->iteration != 0) {
      if (!content) out.problems.push_back({peer_, content.reason()});
      return;
    }
    const RgbdFramePtr frame = frames_.nearest(message.stamp);
    if (!frame) {  // it may be about to arrive
      early_ = message;
      early_deadline_ = deadline;
      return;
    }
    if (exchange_) send_whole("a newer exchange with " + peer_ + " began", now, out);
    cameras_.learn(*content);
    exchange_.emplace();
    exchange_->number = message.exchange;
    exchange_->frame = frame;
    exchange_->a_camera = cameras_.find(content->camera_hash);
    if (exchange_->a_camera) exchange_->a_points = surface_of(*content, *exchange_->a_camera);
    if (!exchange_->a_points) {
      out.problems.push_back({peer_, "camera not known, or samples outside of its image"});
    }
    exchange_->bytes += static_cast<std::uint32_t>(serialised_bytes(message));
    exchange_->deadline = now + options_.step_timeout;
    unclaimed_since_.reset();
    unpaired_ = false;
    send_samples(out);
    if (early_request_) on_request(*std::exchange(early_request_, std::nullopt), now, out);
  }

  void on_more_samples(const SamplesMessage& message, SteadyTime now, RoleOutput& out) {
    Result<SamplesContent> content = decode_samples(message.data);
    if (!content) return send_whole(content.reason(), now, out);
    if (content->iteration != exchange_->iteration + 1) return;
    exchange_->bytes += static_cast<std::uint32_t>(serialised_bytes(message));
    exchange_->iteration = content->iteration;
    exchange_->deadline = now + options_.step_timeout;
    if (exchange_->a_camera) exchange_->a_points = surface_of(*content, *exchange_->a_camera);
    send_samples(out);
    if (early_request_) on_request(*std::exchange(early_request_, std::nullopt), now, out);
  }

  void on_request(const UpdateMessage& message, SteadyTime now, RoleOutput& out) {
    if (!exchange_ || message.exchange != exchange_->number) {
      early_request_ = message;  // topics may overtake each other
      return;
    }
    const Result<PoseRequest> request = decode_request(message.data);
    if (!request) {
      out.problems.push_back({peer_, request.reason()});
      return send_whole(request.reason(), now, out);
    }
    if (request->points_iteration > exchange_->iteration) {
      early_request_ = message;
      return;
    }
    if (!exchange_->a_points) return;
    exchange_->bytes += static_cast<std::uint32_t>(serialised_bytes(message));
    exchange_->deadline = now + options_.step_timeout;
    const RgbdFrame& frame = *exchange_->frame;
    PoseHalf half;
    half.iteration = request->iteration;
    half.equations = half_at_dependent(*exchange_->a_points, frame.depth, frame.camera,
                                       request->b_from_a, {request->c, request->by_noise});
    send(UpdateMessage{frame.stamp, peer_, exchange_->number, encode_half(half)}, out);
  }

  void on_pose(const RelativePoseMessage& pose, SteadyTime now, RoleOutput& out) {
    if (!exchange_ || pose.exchange != exchange_->number) return;
    exchange_->bytes += static_cast<std::uint32_t>(serialised_bytes(pose));
    if (!pose.verdict.accepted()) {
      return send_whole("pose rejected: " + describe(pose.verdict), now, out, pose.verdict);
    }
    if (!is_rigid(pose.b_from_a) || !pose.covariance.allFinite() || !exchange_->a_camera) {
      out.problems.push_back({peer_, "accepted pose that is not a pose"});
      return send_whole("pose could not be read", now, out);
    }
    FrameDecision sparse;
    sparse.action = FrameDecision::Action::kSendSparse;
    sparse.frame = exchange_->frame;
    sparse.exchange = exchange_->number;
    sparse.peer = peer_;
    sparse.pose = pose;
    sparse.verdict = pose.verdict;
    sparse.exchange_bytes = exchange_->bytes;
    sparse.peer_camera = exchange_->a_camera;
    out.decisions.push_back(sparse);
    close(now);
  }

  void send_samples(RoleOutput& out) {
    const RgbdFrame& frame = *exchange_->frame;
    SamplesContent content;
    content.iteration = exchange_->iteration;
    cameras_.describe(frame.camera, content);
    content.with_normals = true;
    content.unit = frame.depth.unit;
    content.points = sample_points(frame.depth, frame.camera, options_.sample_count,
                                   exchange_->number * 64 + exchange_->iteration + 32);
    send(SamplesMessage{frame.stamp, frame.frame_id, peer_, exchange_->number,
                        encode_samples(content, frame.camera.width, frame.camera.height)},
         out);
  }

  void send(PoseMessage message, RoleOutput& out) {
    exchange_->bytes += static_cast<std::uint32_t>(serialised_bytes(message));
    out.send.push_back(std::move(message));
  }

  void send_whole(const std::string& reason, SteadyTime now, RoleOutput& out,
                  const std::optional<PoseVerdict>& verdict = std::nullopt) {
    FrameDecision whole;
    whole.frame = exchange_->frame;
    whole.exchange = exchange_->number;
    whole.peer = peer_;
    whole.reason = reason;
    whole.verdict = verdict;
    whole.exchange_bytes = exchange_->bytes;
    out.decisions.push_back(whole);
    close(now);
  }

  void close(SteadyTime now) {
    last_finished_ = exchange_->number;
    // Frames that came after the claimed one are still unclaimed.
    unclaimed_since_.reset();
    const bool more = frames_.newest() && frames_.newest()->stamp > exchange_->frame->stamp;
    if (active_ && more) unclaimed_since_ = now;
    exchange_.reset();
  }

  const std::string self_;
  const std::string peer_;
  const SamplesOptions options_;
  PeerCameras cameras_;
  RecentFrames frames_;
  bool active_ = true;
  std::optional<Exchange> exchange_;
  std::optional<SamplesMessage> early_;  // a new exchange whose frame is not here yet
  SteadyTime early_deadline_;
  bool unpaired_ = false;  // an exchange came to nothing for want of such a frame
  std::optional<UpdateMessage> early_request_;  // a request that overtook its samples
  std::optional<SteadyTime> unclaimed_since_;  // when the first frame came that no exchange claimed
  std::uint32_t last_finished_ = 0;
};

}  // namespace

std::unique_ptr<ExchangeRole> make_samples_dependent(const std::string& self,
                                                     const std::string& peer,
                                                     const SamplesOptions& options) {
  return std::make_unique<SamplesDependent>(self, peer, options);
}

}  // namespace rprr
