// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <optional>
#include <utility>

#include "recent_frames.hpp"
#include "rprr_pose/preview_protocol.hpp"

namespace rprr {
namespace {

constexpr std::size_t kSentKept = 8;               // frames, as references for later
constexpr double kEnoughShared = 0.5;              // of b's view, for an older reference
constexpr double kSlowFrame = 0.75;                // seconds to the station
constexpr Duration kPatience = from_seconds(0.1);  // where another frame will do
constexpr std::size_t kMostProposals = 4;  // of the prior; more would cost as much as a search

class PreviewReference final : public ExchangeRole {
 public:
  PreviewReference(PreviewOptions options, MotionPrior prior)
      : options_(std::move(options)),
        prior_(std::move(prior)),
        frames_(options_.frames_kept, options_.max_stamp_difference),
        estimator_(options_.search) {}

  void offer(const PoseFramePtr& frame, Stamp now, RoleOutput& out) override {
    frames_.add(frame);
    // Frames that do not fit do not make it wait longer.
    if (early_) answer(*std::exchange(early_, std::nullopt), early_deadline_, now, out);
  }

  void receive(const PoseMessage& message, Stamp now, RoleOutput& out) override {
    const auto* preview = std::get_if<PreviewMessage>(&message);
    if (!preview || preview->receiver != options_.self) return;
    if (preview->exchange == 0 || preview->exchange == last_answered_) return;
    answer(*preview, now + patience(), now, out);
  }

  void tick(Stamp now, RoleOutput& out) override {
    if (!early_ || now < early_deadline_) return;
    const PreviewMessage message = *std::exchange(early_, std::nullopt);
    const PoseFramePtr newest = frames_.newest();
    if (!newest) return;
    if (options_.reference_age == 0) return refuse(message, *newest, out);
    answer(message, newest, newest, now, out);
  }

  void set_radio(const RadioState& radio, Stamp, RoleOutput&) override { radio_ = radio; }

 private:
  // With a frame that is about to arrive.
  Duration patience() const {
    return options_.reference_age > 0 ? kPatience : Duration{options_.step_timeout / 2};
  }

  void answer(const PreviewMessage& message, Stamp deadline, Stamp now, RoleOutput& out) {
    const PoseFramePtr frame = choose(message.stamp);
    // What the station holds already serves at once. Meanwhile a new one is on its way.
    const PoseFramePtr held = is_slow() ? last_sent(now) : nullptr;
    if (held && frame && radio_.ready) send_whole(frame, message.exchange, now, out);
    if (held || frame) return answer(message, held ? held : frame, frame, now, out);
    early_ = message;  // its frame may be about to arrive
    early_deadline_ = deadline;
  }

  // In time for b, so that it hears why, and can tell how far clocks are apart.
  void refuse(const PreviewMessage& message, const PoseFrame& newest, RoleOutput& out) {
    last_answered_ = message.exchange;
    RelativePoseMessage pose = pose_for(newest, message);
    pose.verdict = no_frame_near(message.stamp);
    pose.bytes_spent =
        static_cast<std::uint32_t>(serialised_bytes(message) + serialised_bytes(pose));
    out.send.emplace_back(std::move(pose));
  }

  PoseVerdict no_frame_near(Stamp stamp) const {
    const PoseFramePtr nearest = frames_.nearest(stamp, std::numeric_limits<Duration>::max());
    if (!nearest) return {PoseStatus::kNoFrame};
    return make_verdict(PoseStatus::kNoFrame, PoseQuantity::kTimeApart,
                        std::abs(to_seconds(nearest->stamp - stamp)),
                        to_seconds(options_.max_stamp_difference));
  }

  RelativePoseMessage pose_for(const PoseFrame& frame, const PreviewMessage& message) const {
    RelativePoseMessage pose;
    pose.stamp = frame.stamp;
    pose.frame_id = frame.frame_id;
    pose.dependent_stamp = message.stamp;
    pose.dependent = options_.peer;
    pose.exchange = message.exchange;
    return pose;
  }

  // A frame that is sent now would be there late.
  bool is_slow() const { return !radio_.ready || radio_.frame_seconds > kSlowFrame; }

  // Null: none yet.
  PoseFramePtr choose(Stamp stamp) const {
    const PoseFramePtr near = frames_.nearest(stamp);
    const PoseFramePtr newest = frames_.newest();
    // The scene stands still, so a frame of another time is better than none.
    if (near || options_.reference_age == 0 || !newest || newest->stamp <= stamp) return near;
    return frames_.nearest(stamp, newest->stamp - stamp);
  }

  // Of the frames that were sent, the newest that the station holds, or else the newest.
  PoseFramePtr last_sent(Stamp now) {
    while (!sent_.empty() && now - sent_.front().at > options_.reference_age) sent_.pop_front();
    const auto held = std::find_if(sent_.rbegin(), sent_.rend(), [this](const Sent& sent) {
      return std::find(radio_.references.begin(), radio_.references.end(), sent.frame->stamp) !=
             radio_.references.end();
    });
    if (held != sent_.rend()) return held->frame;
    return sent_.empty() ? nullptr : sent_.back().frame;
  }

  // With the pose to `first`, or where that does not show enough of b's view, to `second`.
  void answer(const PreviewMessage& message, const PoseFramePtr& first, const PoseFramePtr& second,
              Stamp now, RoleOutput& out) {
    last_answered_ = message.exchange;
    Result<PreviewContent> content = decode_preview_content(message.data);
    PoseFramePtr frame = first;
    Attempt attempt = try_frame(*first, message, content);
    if (second && second != first && attempt.shared < kEnoughShared) {
      Attempt other = try_frame(*second, message, content);
      if (other.shared > attempt.shared) {
        attempt = std::move(other);
        frame = second;
      }
    }
    RelativePoseMessage& pose = attempt.pose;
    remember(pose, message);
    send_whole(frame, message.exchange, now, out);
    if (!attempt.wrong.empty()) out.problems.push_back(options_.peer + ": " + attempt.wrong);
    if (content && content->known_peer_hash != camera_hash(frame->camera)) {
      ByteWriter writer;
      put_camera(writer, frame->camera);
      pose.reference_camera = writer.take();
    }
    pose.bytes_spent =
        static_cast<std::uint32_t>(serialised_bytes(message) + serialised_bytes(pose));
    out.send.emplace_back(pose);
    if (!pose.verdict.accepted()) return;
    FrameDecision sparse;
    sparse.action = FrameDecision::Action::kSendSparse;
    sparse.frame = frame;
    sparse.exchange = message.exchange;
    sparse.peer = options_.peer;
    sparse.pose = pose;
    sparse.peer_camera = peer_camera_;
    sparse.peer_preview = std::move(content->preview);
    sparse.exchange_bytes = pose.bytes_spent;
    out.decisions.push_back(std::move(sparse));
  }

  struct Attempt {
    RelativePoseMessage pose;
    double shared = 0.0;  // of b's view; 0 without a pose
    std::string wrong;    // with the message
  };

  Attempt try_frame(const PoseFrame& frame, const PreviewMessage& message,
                    const Result<PreviewContent>& content) {
    Attempt attempt;
    attempt.pose = pose_for(frame, message);
    attempt.pose.verdict = {PoseStatus::kMalformed};
    attempt.wrong = content ? estimate(frame, message, *content, attempt) : content.reason();
    return attempt;
  }

  // Fills in the pose; empty, or what is wrong with the message.
  std::string estimate(const PoseFrame& frame, const PreviewMessage& message,
                       const PreviewContent& content, Attempt& attempt) {
    RelativePoseMessage& pose = attempt.pose;
    if (content.camera) peer_camera_ = *content.camera;
    if (!peer_camera_ || camera_hash(*peer_camera_) != content.camera_hash) {
      peer_camera_.reset();
      return "its camera is not known here";
    }
    const Result<BlockPreview> preview = decode_preview(content.preview);
    if (!preview) return preview.reason();
    if (preview->grid.width != peer_camera_->width ||
        preview->grid.height != peer_camera_->height) {
      return "preview of another size than its camera";
    }
    const FrameNames frames{frame.stamp, frame.frame_id, message.stamp, message.frame_id};
    const PreviewPose found =
        estimator_.estimate(frame, *preview, *peer_camera_, worth_trying(frames));
    pose.verdict = found.verdict;
    pose.motion = found.motion;
    pose.covariance = found.covariance;
    pose.iterations = found.searched ? static_cast<std::uint16_t>(1 + found.starts) : 1;
    pose.inliers = static_cast<std::uint16_t>(std::min(65535, found.b_in_a.consistent));
    if (found.sums.geometry > 0) {
      pose.residual = static_cast<float>(std::sqrt(found.sums.chi2_geometry / found.sums.geometry));
    }
    if (found.verdict.accepted()) attempt.shared = found.b_in_a.shared();
    return {};
  }

  void remember(const RelativePoseMessage& pose, const PreviewMessage& message) {
    last_is_fresh_ = pose.verdict.accepted();
    if (!last_is_fresh_) return;
    const FrameNames frames{pose.stamp, pose.frame_id, message.stamp, message.frame_id};
    last_accepted_ = KnownMotion{frames, pose.motion};
  }

  // What the prior proposes comes first: it knows how the robots moved since the last pose. That
  // itself is worth trying only while exchanges succeed.
  std::vector<Pose> worth_trying(const FrameNames& frames) const {
    std::vector<Pose> poses;
    if (prior_) poses = prior_(frames, last_accepted_);
    poses.erase(std::remove_if(poses.begin(), poses.end(),
                               [](const Pose& pose) { return !is_rigid(pose); }),
                poses.end());
    if (poses.size() > kMostProposals) poses.resize(kMostProposals);
    const auto is_last = [this](const Pose& pose) {
      return pose.isApprox(last_accepted_->motion, 1e-6);
    };
    if (last_is_fresh_ && std::none_of(poses.begin(), poses.end(), is_last)) {
      poses.push_back(last_accepted_->motion);
    }
    return poses;
  }

  void send_whole(const PoseFramePtr& frame, std::uint32_t exchange, Stamp now, RoleOutput& out) {
    const auto same = [&frame](const Sent& sent) { return sent.frame == frame; };
    if (std::any_of(sent_.begin(), sent_.end(), same)) return;  // referred to once more
    if (options_.reference_age > 0) sent_.push_back({frame, now});
    if (sent_.size() > kSentKept) sent_.pop_front();
    FrameDecision whole;
    whole.frame = frame;
    whole.exchange = exchange;
    whole.peer = options_.peer;
    whole.reason = "reference";
    out.decisions.push_back(std::move(whole));
  }

  struct Sent {
    PoseFramePtr frame;
    Stamp at = 0;
  };

  const PreviewOptions options_;
  const MotionPrior prior_;
  RadioState radio_;
  std::deque<Sent> sent_;  // oldest first
  RecentFrames frames_;
  PreviewPoseEstimator estimator_;
  std::optional<Camera> peer_camera_;
  std::optional<KnownMotion> last_accepted_;
  bool last_is_fresh_ = false;           // the last exchange was accepted
  std::optional<PreviewMessage> early_;  // a preview whose frame is not here yet
  Stamp early_deadline_ = 0;
  std::uint32_t last_answered_ = 0;
};

}  // namespace

std::unique_ptr<ExchangeRole> make_preview_reference(const PreviewOptions& options,
                                                     MotionPrior prior) {
  return std::make_unique<PreviewReference>(options, std::move(prior));
}

}  // namespace rprr
