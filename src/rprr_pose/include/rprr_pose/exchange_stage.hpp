// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "rprr_pose/exchange.hpp"
#include "rprr_pose/pose_prior.hpp"
#include "rprr_pose/preview_protocol.hpp"
#include "rprr_pose/samples_protocol.hpp"

namespace rprr {

/// How robots find their relative poses. Defaults are those of profile `default`; the table of
/// parameters is in pose_options.hpp.
struct ExchangeOptions {
  bool use_previews = true;  ///< protocol: preview, or samples; the same on all robots
  PreviewOptions preview;
  SamplesOptions samples;
};

/// The pose stage of one robot: its exchanges with any number of peers, as the dependent of some
/// and the reference of others at once. Roles are states: every robot is always ready to answer,
/// and whom it refers to can be changed at any time.
///
/// With protocol `preview` a robot asks the peers that it refers to. With protocol `samples` it is
/// the reference that begins: a robot begins exchanges with the peers that it does not refer to.
/// Frames of several references: each of the robot's frames is asked about at one of them, in turn.
///
/// A pure state machine like the roles that it holds (`now` is any steady time in nanoseconds), but
/// for the processor time that it measures for its decisions. One thread at a time.
class ExchangeStage final : public ExchangeRole {
 public:
  /// peers: the robots to exchange with. prior may be empty.
  ExchangeStage(const std::string& robot, const ExchangeOptions& options,
                const std::vector<std::string>& peers, PosePrior prior = {});

  /// Makes the frames of a peer what this robot's frames refer to, or no longer. An exchange under
  /// way ends as it would. False: the robot is none of the peers.
  bool set_reference(const std::string& peer, bool refer);
  /// False also for robots that are none of the peers.
  bool refers_to(const std::string& peer) const;
  /// Which protocol the stage speaks: ExchangeOptions::use_previews.
  bool uses_previews() const { return use_previews_; }

  void offer(const RgbdFramePtr& frame, SteadyTime now, RoleOutput& out) override;
  void receive(const std::string& peer, const PoseMessage& message, SteadyTime now,
               RoleOutput& out) override;
  void tick(SteadyTime now, RoleOutput& out) override;
  void set_link_state(const LinkState& link, SteadyTime now, RoleOutput& out) override;

 private:
  struct Part {
    std::unique_ptr<ExchangeRole> role;  // null: this protocol has no such part
    float ms = 0.0f;                     // processor time since the part's last decision [ms]
  };
  struct Peer {
    Part as_dependent;
    Part as_reference;  // protocol samples; with previews the director is everybody's reference
    bool refer = false;
  };
  using Action = std::function<void(ExchangeRole&, RoleOutput&)>;

  void drive(Part& part, RoleOutput& out, const Action& action) const;
  void drive_all(RoleOutput& out, const Action& action);
  std::vector<Peer*> in_turn();

  const bool use_previews_;
  std::map<std::string, Peer> peers_;
  Part director_;
  std::size_t turn_ = 0;  // counts frames that were asked about
  std::uint32_t epoch_ = 0;
  std::optional<Stamp> newest_;
};

}  // namespace rprr
