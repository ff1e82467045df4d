// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_pose/director.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "rprr_wire/camera_wire.hpp"

namespace rprr {
namespace {

constexpr std::size_t kSentKept = 8;               // frames, as references for later
constexpr double kEnoughOverlap = 0.5;             // share of b's view, for an older reference
constexpr double kSlowFrame = 0.75;                // to the station [s]
constexpr Duration kPatience = from_seconds(0.1);  // where another frame will do
constexpr std::size_t kMostProposals = 4;  // of the prior; more would cost as much as a search

RelativePoseMessage pose_for(const RgbdFrame& frame, const std::string& peer,
                             const PreviewMessage& message) {
  RelativePoseMessage pose;
  pose.stamp = frame.stamp;
  pose.frame_id = frame.frame_id;
  pose.dependent_stamp = message.stamp;
  pose.dependent = peer;
  pose.exchange = message.exchange;
  return pose;
}

std::uint32_t bytes_of(const PreviewMessage& message, const RelativePoseMessage& pose) {
  return static_cast<std::uint32_t>(serialised_bytes(message) + serialised_bytes(pose));
}

// Null: malformed, or there is no content.
std::shared_ptr<const ReceivedPreview> decode(const Result<PreviewContent>& content,
                                              std::string& wrong) {
  if (!content) {
    wrong = content.reason();
    return nullptr;
  }
  Result<BlockPreview> preview = decode_preview(content->preview);
  if (!preview) {
    wrong = preview.reason();
    return nullptr;
  }
  return std::make_shared<ReceivedPreview>(ReceivedPreview{content->preview, std::move(*preview)});
}

}  // namespace

Director::Director(std::string name, const PreviewOptions& options, PosePrior prior)
    : name_(std::move(name)),
      options_(options),
      prior_(std::move(prior)),
      frames_(options_.frames_kept, options_.max_stamp_difference),
      estimator_(options_.search) {
}

void Director::offer(const RgbdFramePtr& frame, SteadyTime now, RoleOutput& out) {
  frames_.add(frame);
  for (auto& [peer, dependent] : dependents_) {
    if (!dependent.early) continue;
    const PreviewMessage message = *std::exchange(dependent.early, std::nullopt);
    // Frames that do not fit do not make it wait longer.
    answer({peer, dependent, message}, dependent.early_deadline, now, out);
  }
}

void Director::receive(const std::string& peer, const PoseMessage& message, SteadyTime now,
                       RoleOutput& out) {
  const auto* preview = std::get_if<PreviewMessage>(&message);
  const auto found = dependents_.find(peer);
  if (!preview || preview->receiver != name_ || found == dependents_.end()) return;
  if (preview->exchange == 0 || preview->exchange == found->second.last_answered) return;
  answer({found->first, found->second, *preview}, now + patience(), now, out);
}

void Director::tick(SteadyTime now, RoleOutput& out) {
  for (auto& [peer, dependent] : dependents_) {
    if (!dependent.early || now < dependent.early_deadline) continue;
    const PreviewMessage message = *std::exchange(dependent.early, std::nullopt);
    const RgbdFramePtr newest = frames_.newest();
    if (!newest) continue;
    const Question question{peer, dependent, message};
    if (options_.reference_age == 0) {
      refuse(question, *newest, out);
    } else {
      answer_with(question, newest, newest, now, out);
    }
  }
}

void Director::set_link_state(const LinkState& link, SteadyTime, RoleOutput&) {
  link_ = link;
}

// How long to wait for a frame that is about to arrive.
Duration Director::patience() const {
  return options_.reference_age > 0 ? kPatience : Duration{options_.step_timeout / 2};
}

// A frame that is sent now would be at the station late.
bool Director::is_slow() const {
  return !link_.has_room || link_.frame_seconds > kSlowFrame;
}

// The frame for a preview of that stamp; null if there is none yet.
RgbdFramePtr Director::choose(Stamp stamp) const {
  const RgbdFramePtr near = frames_.nearest(stamp);
  const RgbdFramePtr newest = frames_.newest();
  // The scene stands still, so a frame of another time is better than none.
  if (near || options_.reference_age == 0 || !newest || newest->stamp <= stamp) return near;
  return frames_.nearest(stamp, newest->stamp - stamp);
}

// Of the frames that were sent, the newest that the station holds, or else the newest.
RgbdFramePtr Director::last_sent(SteadyTime now) {
  while (!sent_.empty() && now - sent_.front().at > options_.reference_age) sent_.pop_front();
  const auto held = std::find_if(sent_.rbegin(), sent_.rend(), [this](const Sent& sent) {
    return std::find(link_.references.begin(), link_.references.end(), sent.frame->stamp) !=
           link_.references.end();
  });
  if (held != sent_.rend()) return held->frame;
  return sent_.empty() ? nullptr : sent_.back().frame;
}

void Director::answer(const Question& question, SteadyTime deadline, SteadyTime now,
                      RoleOutput& out) {
  const RgbdFramePtr frame = choose(question.message.stamp);
  // What the station holds already serves at once. Meanwhile a new one is on its way.
  const RgbdFramePtr held = is_slow() ? last_sent(now) : nullptr;
  if (held && frame && link_.has_room) send_whole(question, frame, now, out);
  if (held || frame) return answer_with(question, held ? held : frame, frame, now, out);
  question.dependent.early_deadline = deadline;
  question.dependent.early = question.message;
}

// In time for the dependent, so that it hears why, and can tell how far clocks are apart.
void Director::refuse(const Question& question, const RgbdFrame& newest, RoleOutput& out) {
  question.dependent.last_answered = question.message.exchange;
  RelativePoseMessage pose = pose_for(newest, question.peer, question.message);
  pose.verdict = no_frame_near(question.message.stamp);
  pose.bytes_spent = bytes_of(question.message, pose);
  out.send.emplace_back(std::move(pose));
}

PoseVerdict Director::no_frame_near(Stamp stamp) const {
  const RgbdFramePtr nearest = frames_.nearest(stamp, std::numeric_limits<Duration>::max());
  if (!nearest) return {PoseStatus::kNoFrame};
  return make_verdict(PoseStatus::kNoFrame, PoseQuantity::kTimeApart,
                      std::abs(to_seconds(nearest->stamp - stamp)),
                      to_seconds(options_.max_stamp_difference));
}

// With the pose to `first`, or where that does not show enough of the dependent's view, to
// `second`. The prediction is asked for first: the dependent waits for it.
void Director::answer_with(const Question& question, const RgbdFramePtr& first,
                           const RgbdFramePtr& second, SteadyTime now, RoleOutput& out) {
  question.dependent.last_answered = question.message.exchange;
  const Result<PreviewContent> content = decode_preview_content(question.message.data);
  std::string wrong;
  const auto preview = decode(content, wrong);
  RgbdFramePtr frame = first;
  Attempt attempt = try_frame(question, *first, content, preview);
  if (second && second != first && attempt.overlap < kEnoughOverlap) {
    Attempt other = try_frame(question, *second, content, preview);
    if (other.overlap > attempt.overlap) {
      attempt = std::move(other);
      frame = second;
    }
  }
  if (!wrong.empty()) attempt.wrong = wrong;
  RelativePoseMessage& pose = attempt.pose;
  remember(question, pose);
  if (!attempt.wrong.empty()) out.problems.push_back({question.peer, attempt.wrong});
  if (content && content->known_peer_hash != camera_hash(frame->camera)) {
    ByteWriter writer;
    put_camera(writer, frame->camera);
    pose.reference_camera = writer.take();
  }
  pose.bytes_spent = bytes_of(question.message, pose);
  out.send.emplace_back(pose);
  if (pose.verdict.accepted()) {
    FrameDecision predict;
    predict.action = FrameDecision::Action::kPredict;
    predict.frame = frame;
    predict.exchange = question.message.exchange;
    predict.peer = question.peer;
    predict.pose = pose;
    predict.peer_camera = question.dependent.camera;
    predict.peer_preview = preview;
    predict.exchange_bytes = pose.bytes_spent;
    out.decisions.push_back(std::move(predict));
  }
  send_whole(question, frame, now, out);
}

Director::Attempt Director::try_frame(const Question& question, const RgbdFrame& frame,
                                      const Result<PreviewContent>& content,
                                      const std::shared_ptr<const ReceivedPreview>& preview) {
  Attempt attempt;
  attempt.pose = pose_for(frame, question.peer, question.message);
  attempt.pose.verdict = {PoseStatus::kMalformed};
  attempt.preview = preview;
  if (content) attempt.wrong = estimate(question, frame, *content, attempt);
  return attempt;
}

// Fills in the pose; empty, or what is wrong with the message.
std::string Director::estimate(const Question& question, const RgbdFrame& frame,
                               const PreviewContent& content, Attempt& attempt) {
  std::optional<Camera>& camera = question.dependent.camera;
  if (content.camera) camera = *content.camera;
  if (!camera || camera_hash(*camera) != content.camera_hash) {
    camera.reset();
    return "its camera is not known here";
  }
  if (!attempt.preview) return {};  // the caller knows why
  const BlockPreview& preview = attempt.preview->preview;
  if (preview.grid.width != camera->width || preview.grid.height != camera->height) {
    return "preview of another size than its camera";
  }
  const FrameNames frames{frame.stamp, frame.frame_id, question.message.stamp,
                          question.message.frame_id};
  const PreviewPose found =
      estimator_.estimate(frame, preview, *camera, worth_trying(question, frames));
  RelativePoseMessage& pose = attempt.pose;
  pose.verdict = found.verdict;
  pose.b_from_a = found.b_from_a;
  pose.covariance = found.covariance;
  pose.iterations = found.searched ? static_cast<std::uint16_t>(1 + found.starts) : 1;
  pose.inliers = static_cast<std::uint16_t>(std::min(65535, found.b_in_a.consistent));
  if (found.sums.geometry > 0) {
    pose.residual = static_cast<float>(std::sqrt(found.sums.chi2_geometry / found.sums.geometry));
  }
  if (found.verdict.accepted()) attempt.overlap = found.b_in_a.overlap();
  return {};
}

void Director::remember(const Question& question, const RelativePoseMessage& pose) {
  Dependent& dependent = question.dependent;
  dependent.last_is_fresh = pose.verdict.accepted();
  if (!dependent.last_is_fresh) return;
  const FrameNames frames{pose.stamp, pose.frame_id, question.message.stamp,
                          question.message.frame_id};
  dependent.last_accepted = KnownPose{frames, pose.b_from_a};
}

// What the prior proposes comes first: it knows how the robots moved since the last pose. The last
// pose itself is worth trying only while exchanges succeed.
std::vector<Pose> Director::worth_trying(const Question& question, const FrameNames& frames) const {
  const std::optional<KnownPose>& last = question.dependent.last_accepted;
  std::vector<Pose> poses;
  if (prior_) poses = prior_(question.peer, frames, last);
  poses.erase(
      std::remove_if(poses.begin(), poses.end(), [](const Pose& pose) { return !is_rigid(pose); }),
      poses.end());
  if (poses.size() > kMostProposals) poses.resize(kMostProposals);
  const auto is_last = [&last](const Pose& pose) { return pose.isApprox(last->b_from_a, 1e-6); };
  if (question.dependent.last_is_fresh && std::none_of(poses.begin(), poses.end(), is_last)) {
    poses.push_back(last->b_from_a);
  }
  return poses;
}

void Director::send_whole(const Question& question, const RgbdFramePtr& frame, SteadyTime now,
                          RoleOutput& out) {
  const auto same = [&frame](const Sent& sent) { return sent.frame == frame; };
  if (std::any_of(sent_.begin(), sent_.end(), same)) return;  // referred to once more
  if (options_.reference_age > 0) sent_.push_back({frame, now});
  if (sent_.size() > kSentKept) sent_.pop_front();
  FrameDecision whole;
  whole.frame = frame;
  whole.exchange = question.message.exchange;
  whole.peer = question.peer;
  whole.action = FrameDecision::Action::kSendReference;
  whole.reason = "reference";
  out.decisions.push_back(std::move(whole));
}

std::unique_ptr<ExchangeRole> make_preview_reference(const std::string& self,
                                                     const std::string& peer,
                                                     const PreviewOptions& options,
                                                     PosePrior prior) {
  auto director = std::make_unique<Director>(self, options, std::move(prior));
  director->add_dependent(peer);
  return director;
}

}  // namespace rprr
