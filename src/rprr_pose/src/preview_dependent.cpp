// SPDX-License-Identifier: BSD-3-Clause
#include <optional>
#include <utility>

#include "rprr_pose/preview_protocol.hpp"

namespace rprr {
namespace {

// The exchange under way.
struct Exchange {
  std::uint32_t number = 0;
  PoseFramePtr frame;
  Stamp deadline = 0;
  std::uint32_t bytes = 0;
};

class PreviewDependent final : public ExchangeRole {
 public:
  explicit PreviewDependent(PreviewOptions options)
      : options_(std::move(options)), next_number_(options_.first_exchange) {}

  void offer(const PoseFramePtr& frame, Stamp now, RoleOutput& out) override {
    if (exchange_ || (last_start_ && now - *last_start_ < options_.min_period)) return;
    if (!radio_ready_) {
      waiting_ = frame;
      return;
    }
    begin(frame, now, out);
  }

  void set_radio(const RadioState& radio, Stamp now, RoleOutput& out) override {
    radio_ready_ = radio.ready;
    if (radio_ready_ && waiting_ && !exchange_) begin(waiting_, now, out);
  }

  void receive(const PoseMessage& message, Stamp, RoleOutput& out) override {
    const auto* pose = std::get_if<RelativePoseMessage>(&message);
    if (!pose || pose->dependent != options_.self || !exchange_ ||
        pose->exchange != exchange_->number) {
      return;
    }
    exchange_->bytes += static_cast<std::uint32_t>(serialised_bytes(*pose));
    learn_camera(*pose, out);
    if (!pose->verdict.accepted()) {
      // A reference that could not read the preview may have forgotten this camera.
      if (pose->verdict.status == PoseStatus::kMalformed) camera_sent_ = 0;
      return send_whole("pose rejected by " + options_.peer + ": " + describe(pose->verdict), out,
                        pose->verdict);
    }
    if (!is_rigid(pose->motion) || !pose->covariance.allFinite() || !peer_camera_) {
      out.problems.push_back(options_.peer + ": accepted pose that is not a pose, or no camera");
      return send_whole("pose could not be read", out);
    }
    camera_sent_ = camera_hash(exchange_->frame->camera);
    FrameDecision sparse;
    sparse.action = FrameDecision::Action::kSendSparse;
    sparse.frame = exchange_->frame;
    sparse.exchange = exchange_->number;
    sparse.peer = options_.peer;
    sparse.pose = *pose;
    sparse.verdict = pose->verdict;
    sparse.peer_camera = peer_camera_;
    sparse.exchange_bytes = exchange_->bytes;
    out.decisions.push_back(std::move(sparse));
    exchange_.reset();
  }

  void tick(Stamp now, RoleOutput& out) override {
    if (exchange_ && now >= exchange_->deadline) {
      camera_sent_ = 0;  // who does not answer may not have heard it
      send_whole("no answer from " + options_.peer, out);
    }
  }

 private:
  void begin(PoseFramePtr frame, Stamp now, RoleOutput& out) {
    waiting_.reset();
    last_start_ = now;
    exchange_.emplace();
    exchange_->number = next_number_++;
    if (next_number_ == 0) next_number_ = 1;  // 0 stands for no exchange
    exchange_->frame = frame;
    exchange_->deadline = now + options_.step_timeout;
    PreviewMessage message{frame->stamp, frame->frame_id, options_.peer, exchange_->number,
                           encode_preview_content(content_of(*frame))};
    exchange_->bytes = static_cast<std::uint32_t>(serialised_bytes(message));
    out.send.emplace_back(std::move(message));
  }

  PreviewContent content_of(const PoseFrame& frame) const {
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
      out.problems.push_back(options_.peer + ": " + camera.reason());
    }
  }

  void send_whole(const std::string& reason, RoleOutput& out,
                  const std::optional<PoseVerdict>& verdict = std::nullopt) {
    FrameDecision whole;
    whole.frame = exchange_->frame;
    whole.exchange = exchange_->number;
    whole.peer = options_.peer;
    whole.reason = reason;
    whole.verdict = verdict;
    whole.exchange_bytes = exchange_->bytes;
    out.decisions.push_back(std::move(whole));
    exchange_.reset();
  }

  const PreviewOptions options_;
  std::optional<Exchange> exchange_;
  bool radio_ready_ = true;
  PoseFramePtr waiting_;  // the newest frame, for when the radio is ready
  std::optional<Camera> peer_camera_;
  std::uint32_t camera_sent_ = 0;  // hash of the own camera that the reference is known to know
  std::uint32_t next_number_;
  std::optional<Stamp> last_start_;
};

}  // namespace

std::unique_ptr<ExchangeRole> make_preview_dependent(const PreviewOptions& options) {
  return std::make_unique<PreviewDependent>(options);
}

}  // namespace rprr
