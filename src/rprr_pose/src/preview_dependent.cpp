// SPDX-License-Identifier: BSD-3-Clause
#include <optional>
#include <utility>

#include "rprr_pose/preview_protocol.hpp"
#include "rprr_wire/bytes.hpp"
#include "rprr_wire/camera_wire.hpp"

namespace rprr {
namespace {

// The exchange under way.
struct Exchange {
  std::uint32_t number = 0;
  RgbdFramePtr frame;
  SteadyTime deadline;
  std::uint32_t bytes = 0;
};

class PreviewDependent final : public ExchangeRole {
 public:
  PreviewDependent(std::string self, std::string peer, const PreviewOptions& options)
      : self_(std::move(self)),
        peer_(std::move(peer)),
        options_(options),
        next_number_(options_.first_exchange) {}

  void offer(const RgbdFramePtr& frame, SteadyTime now, RoleOutput& out) override {
    if (!active_ || exchange_ || (last_start_ && now - *last_start_ < options_.min_period)) return;
    if (!has_room_) {
      waiting_ = frame;
      return;
    }
    begin(frame, now, out);
  }

  void set_active(bool active) override {
    active_ = active;
    if (!active_) waiting_.reset();
  }

  void set_link_state(const LinkState& link, SteadyTime now, RoleOutput& out) override {
    has_room_ = link.has_room;
    if (has_room_ && waiting_ && !exchange_) begin(waiting_, now, out);
  }

  void receive(const std::string& peer, const PoseMessage& message, SteadyTime,
               RoleOutput& out) override {
    const auto* pose = std::get_if<RelativePoseMessage>(&message);
    if (peer != peer_ || !pose || pose->dependent != self_ || !exchange_ ||
        pose->exchange != exchange_->number) {
      return;
    }
    exchange_->bytes += static_cast<std::uint32_t>(serialised_bytes(*pose));
    learn_camera(*pose, out);
    if (!pose->verdict.accepted()) {
      // A reference that could not read the preview may have forgotten this camera.
      if (pose->verdict.status == PoseStatus::kMalformed) camera_sent_ = 0;
      return send_whole("pose rejected by " + peer_ + ": " + describe(pose->verdict), out,
                        pose->verdict);
    }
    if (!is_rigid(pose->b_from_a) || !pose->covariance.allFinite() || !peer_camera_) {
      out.problems.push_back({peer_, "accepted pose that is not a pose, or no camera"});
      return send_whole("pose could not be read", out);
    }
    camera_sent_ = camera_hash(exchange_->frame->camera);
    FrameDecision sparse;
    sparse.action = FrameDecision::Action::kSendSparse;
    sparse.frame = exchange_->frame;
    sparse.exchange = exchange_->number;
    sparse.peer = peer_;
    sparse.pose = *pose;
    sparse.verdict = pose->verdict;
    sparse.peer_camera = peer_camera_;
    sparse.exchange_bytes = exchange_->bytes;
    out.decisions.push_back(std::move(sparse));
    exchange_.reset();
  }

  void tick(SteadyTime now, RoleOutput& out) override {
    if (exchange_ && now >= exchange_->deadline) {
      camera_sent_ = 0;  // who does not answer may not have heard it
      send_whole("no answer from " + peer_, out);
    }
  }

 private:
  void begin(RgbdFramePtr frame, SteadyTime now, RoleOutput& out) {
    waiting_.reset();
    last_start_ = now;
    exchange_.emplace();
    exchange_->number = next_number_++;
    if (next_number_ == 0) next_number_ = 1;  // 0 stands for no exchange
    exchange_->frame = frame;
    exchange_->deadline = now + options_.step_timeout;
    PreviewMessage message{frame->stamp, frame->frame_id, peer_, exchange_->number,
                           encode_preview_content(content_of(*frame))};
    exchange_->bytes = static_cast<std::uint32_t>(serialised_bytes(message));
    out.send.emplace_back(std::move(message));
  }

  PreviewContent content_of(const RgbdFrame& frame) const {
    PreviewContent content;
    content.camera_hash = camera_hash(frame.camera);
    content.known_peer_hash = peer_camera_ ? camera_hash(*peer_camera_) : 0;
    if (camera_sent_ != content.camera_hash) content.camera = frame.camera;
    content.preview = encode_preview(options_.lossless_depth
                                         ? make_exact_preview(frame.depth, frame.bgr)
                                         : make_preview(frame.depth, frame.bgr, options_.step),
                                     options_.colour_quality);
    return content;
  }

  void learn_camera(const RelativePoseMessage& pose, RoleOutput& out) {
    if (pose.reference_camera.empty()) return;
    ByteReader reader(pose.reference_camera);
    const Result<Camera> camera = get_camera(reader);
    if (camera) {
      peer_camera_ = *camera;
    } else {
      out.problems.push_back({peer_, camera.reason()});
    }
  }

  void send_whole(const std::string& reason, RoleOutput& out,
                  const std::optional<PoseVerdict>& verdict = std::nullopt) {
    FrameDecision whole;
    whole.frame = exchange_->frame;
    whole.exchange = exchange_->number;
    whole.peer = peer_;
    whole.reason = reason;
    whole.verdict = verdict;
    whole.exchange_bytes = exchange_->bytes;
    out.decisions.push_back(std::move(whole));
    exchange_.reset();
  }

  const std::string self_;
  const std::string peer_;
  const PreviewOptions options_;
  std::optional<Exchange> exchange_;
  bool active_ = true;
  bool has_room_ = true;
  RgbdFramePtr waiting_;  // the newest frame, for when the radio is ready
  std::optional<Camera> peer_camera_;
  std::uint32_t camera_sent_ = 0;  // hash of the own camera that the reference is known to know
  std::uint32_t next_number_;
  std::optional<SteadyTime> last_start_;
};

}  // namespace

std::unique_ptr<ExchangeRole> make_preview_dependent(const std::string& self,
                                                     const std::string& peer,
                                                     const PreviewOptions& options) {
  return std::make_unique<PreviewDependent>(self, peer, options);
}

}  // namespace rprr
