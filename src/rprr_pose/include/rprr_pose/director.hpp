// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "rprr_pose/exchange.hpp"
#include "rprr_pose/pose_prior.hpp"
#include "rprr_pose/preview_pose.hpp"
#include "rprr_pose/preview_protocol.hpp"
#include "rprr_pose/recent_frames.hpp"

namespace rprr {

/// Holds frames and answers previews: finds the pose of a dependent's frame to one that it holds,
/// and says so, or why there is none. The reference's part of protocol `preview`, for any number of
/// dependents. Nothing in it depends on where it runs: it answers to a name, and holds the frames
/// that it is offered.
///
/// Memory is bounded: PreviewOptions::frames_kept frames, a few kilobytes for each dependent. One
/// thread at a time.
class Director final : public ExchangeRole {
 public:
  /// name: whom previews are addressed to. prior may be empty.
  Director(std::string name, const PreviewOptions& options, PosePrior prior = {});

  /// Only previews of robots added here are answered.
  void add_dependent(const std::string& robot) { dependents_[robot]; }

  void offer(const RgbdFramePtr& frame, SteadyTime now, RoleOutput& out) override;
  void receive(const std::string& peer, const PoseMessage& message, SteadyTime now,
               RoleOutput& out) override;
  void tick(SteadyTime now, RoleOutput& out) override;
  void set_link_state(const LinkState& link, SteadyTime now, RoleOutput& out) override;

 private:
  /// What the director knows of one robot that asks it.
  struct Dependent {
    std::optional<Camera> camera;
    std::optional<KnownPose> last_accepted;
    bool last_is_fresh = false;           // the last exchange was accepted
    std::optional<PreviewMessage> early;  // a preview whose frame is not here yet
    SteadyTime early_deadline;
    std::uint32_t last_answered = 0;
  };
  struct Question {
    const std::string& peer;
    Dependent& dependent;
    const PreviewMessage& message;
  };
  struct Attempt {
    RelativePoseMessage pose;
    double overlap = 0.0;  // of the dependent's view; 0 without a pose
    std::string wrong;     // with the message
    std::shared_ptr<const ReceivedPreview> preview;
  };
  struct Sent {
    RgbdFramePtr frame;
    SteadyTime at;
  };

  Duration patience() const;
  bool is_slow() const;
  RgbdFramePtr choose(Stamp stamp) const;
  RgbdFramePtr last_sent(SteadyTime now);
  void answer(const Question& question, SteadyTime deadline, SteadyTime now, RoleOutput& out);
  void answer_with(const Question& question, const RgbdFramePtr& first, const RgbdFramePtr& second,
                   SteadyTime now, RoleOutput& out);
  void refuse(const Question& question, const RgbdFrame& newest, RoleOutput& out);
  PoseVerdict no_frame_near(Stamp stamp) const;
  Attempt try_frame(const Question& question, const RgbdFrame& frame,
                    const Result<PreviewContent>& content,
                    const std::shared_ptr<const ReceivedPreview>& preview);
  std::string estimate(const Question& question, const RgbdFrame& frame,
                       const PreviewContent& content, Attempt& attempt);
  void remember(const Question& question, const RelativePoseMessage& pose);
  std::vector<Pose> worth_trying(const Question& question, const FrameNames& frames) const;
  void send_whole(const Question& question, const RgbdFramePtr& frame, SteadyTime now,
                  RoleOutput& out);

  const std::string name_;
  const PreviewOptions options_;
  const PosePrior prior_;
  LinkState link_;
  std::deque<Sent> sent_;  // oldest first
  RecentFrames frames_;
  PreviewPoseEstimator estimator_;
  std::map<std::string, Dependent> dependents_;
};

}  // namespace rprr
