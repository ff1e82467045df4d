// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_pose/exchange_stage.hpp"

#include <gtest/gtest.h>

#include <deque>
#include <map>

#include "textured_views.hpp"

namespace rprr {
namespace {

using Action = FrameDecision::Action;

// Robots side by side in the corner, on a channel that loses nothing: what each says reaches all
// others in the order in which it was said.
class Team {
 public:
  Team(const std::vector<std::string>& names, const ExchangeOptions& options) {
    for (const std::string& name : names) {
      std::vector<std::string> peers;
      for (const std::string& other : names) {
        if (other != name) peers.push_back(other);
      }
      robots_[name] = std::make_unique<ExchangeStage>(name, options, peers);
      views_[name] = test_motion(0.08 * static_cast<double>(views_.size()), 3.0);
    }
  }
  ExchangeStage& operator[](const std::string& name) { return *robots_.at(name); }

  /// Every robot has a frame of that stamp, and time passes until nothing more is said.
  void see(Stamp stamp) {
    for (auto& [name, robot] : robots_) offer(name, stamp);
    settle();
  }
  void offer(const std::string& name, Stamp stamp) {
    const RgbdFramePtr frame = textured_frame(views_.at(name), stamp, name);
    RoleOutput out;
    robots_.at(name)->offer(frame, now_, out);
    take(name, std::move(out));
  }
  void settle() {
    while (!said_.empty()) {
      const auto [sender, message] = std::move(said_.front());
      said_.pop_front();
      for (auto& [name, robot] : robots_) {
        if (name == sender) continue;
        RoleOutput out;
        robot->receive(sender, message, now_, out);
        take(name, std::move(out));
      }
    }
  }
  void pass(Duration duration) {
    now_ += duration;
    for (auto& [name, robot] : robots_) {
      RoleOutput out;
      robot->tick(now_, out);
      take(name, std::move(out));
    }
    settle();
  }

  /// Decisions of that kind about frames of that robot, by stamp: the peer.
  std::multimap<Stamp, std::string> decided(const std::string& name, Action action) const {
    std::multimap<Stamp, std::string> peers;
    for (const auto& [robot, decision] : decisions_) {
      if (robot == name && decision.action == action) {
        peers.emplace(decision.frame->stamp, decision.peer);
      }
    }
    return peers;
  }
  const std::vector<std::pair<std::string, FrameDecision>>& decisions() const { return decisions_; }
  int previews = 0;

 private:
  void take(const std::string& name, RoleOutput out) {
    EXPECT_TRUE(out.problems.empty()) << out.problems.front().text;
    for (PoseMessage& message : out.send) {
      previews += std::holds_alternative<PreviewMessage>(message) ? 1 : 0;
      said_.emplace_back(name, std::move(message));
    }
    for (FrameDecision& decision : out.decisions) decisions_.emplace_back(name, decision);
  }

  std::map<std::string, std::unique_ptr<ExchangeStage>> robots_;
  std::map<std::string, Pose> views_;
  std::deque<std::pair<std::string, PoseMessage>> said_;
  std::vector<std::pair<std::string, FrameDecision>> decisions_;
  SteadyTime now_;
};

using Peers = std::multimap<Stamp, std::string>;

// A reference refers to frames near in time alone, and the paper's number of iterations leaves room
// for every start.
ExchangeOptions protocol(bool previews) {
  ExchangeOptions options;
  options.use_previews = previews;
  options.preview.reference_age = 0;
  options.samples.max_iterations = 50;
  options.samples.step_timeout = from_seconds(0.5);
  return options;
}

class BothProtocols : public testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(, BothProtocols, testing::Bool(),
                         [](const auto& info) { return info.param ? "Preview" : "Samples"; });

TEST_P(BothProtocols, ARobotIsReferenceAndDependentAtOnce) {
  Team team({"a", "b", "c"}, protocol(GetParam()));
  team["b"].set_reference("a", true);
  team["c"].set_reference("b", true);
  if (!GetParam()) {  // who is no reference of another begins: a and c must leave each other alone
    team["a"].set_reference("c", true);
    team["c"].set_reference("a", true);
  }
  team.see(1000);
  EXPECT_TRUE(team.decided("b", Action::kSendSparse).count(1000)) << "as a's dependent";
  EXPECT_TRUE(team.decided("b", Action::kPredict).count(1000)) << "as c's reference";
  EXPECT_EQ(team.decided("b", Action::kSendSparse).find(1000)->second, "a");
  EXPECT_EQ(team.decided("b", Action::kPredict).find(1000)->second, "c");
  EXPECT_EQ(team.decided("c", Action::kSendSparse).find(1000)->second, "b");
}

TEST_P(BothProtocols, RolesChangeAndNoExchangeIsLost) {
  Team team({"a", "b"}, protocol(GetParam()));
  for (int round = 0; round < 6; ++round) {
    const bool b_refers = round % 2 == 0;
    team["b"].set_reference("a", b_refers);
    team["a"].set_reference("b", !b_refers);
    const std::string dependent = b_refers ? "b" : "a";
    for (Stamp stamp = 1000 * (round + 1); stamp < 1000 * (round + 1) + 3; ++stamp) {
      team.see(stamp);
      EXPECT_EQ(team.decided(dependent, Action::kSendSparse).count(stamp), 1u) << stamp;
      EXPECT_EQ(team.decided(b_refers ? "a" : "b", Action::kPredict).count(stamp), 1u) << stamp;
    }
  }
  EXPECT_TRUE(team.decided("a", Action::kSendWhole).empty());
  EXPECT_TRUE(team.decided("b", Action::kSendWhole).empty());
}

TEST(ExchangeStage, AnExchangeUnderWayEndsAsItWouldWhenRolesChange) {
  Team team({"a", "b"}, protocol(true));
  team["b"].set_reference("a", true);
  team.offer("b", 1000);  // its preview is on its way
  team["b"].set_reference("a", false);
  team["a"].set_reference("b", true);
  team.offer("a", 1000);
  team.settle();
  EXPECT_EQ(team.decided("b", Action::kSendSparse), (Peers{{1000, "a"}}));
  EXPECT_EQ(team.decided("a", Action::kSendSparse), (Peers{{1000, "b"}}));
}

TEST(ExchangeStage, AFrameIsAskedAboutAtOneReferenceInTurn) {
  Team team({"a", "b", "c"}, protocol(true));
  team["b"].set_reference("a", true);
  team["b"].set_reference("c", true);
  for (Stamp stamp = 1000; stamp < 1006; ++stamp) team.see(stamp);
  EXPECT_EQ(team.previews, 6);
  const Peers peers = team.decided("b", Action::kSendSparse);
  ASSERT_EQ(peers.size(), 6u);
  int of_a = 0;
  for (const auto& [stamp, peer] : peers) of_a += peer == "a" ? 1 : 0;
  EXPECT_EQ(of_a, 3);
}

TEST(ExchangeStage, OneReferenceServesManyDependents) {
  Team team({"a", "b", "c", "d"}, protocol(true));
  for (const char* name : {"b", "c", "d"}) team[name].set_reference("a", true);
  team.see(1000);
  EXPECT_EQ(team.decided("a", Action::kPredict), (Peers{{1000, "b"}, {1000, "c"}, {1000, "d"}}));
  for (const char* name : {"b", "c", "d"}) {
    EXPECT_EQ(team.decided(name, Action::kSendSparse), (Peers{{1000, "a"}}));
  }
}

TEST(ExchangeStage, WithoutAReferenceARobotSaysNothing) {
  Team team({"a", "b"}, protocol(true));
  team.see(1000);
  team.pass(from_seconds(10.0));
  EXPECT_EQ(team.previews, 0);
  EXPECT_TRUE(team.decisions().empty());
}

TEST(ExchangeStage, StrangersAreNoPeers) {
  Team team({"a", "b"}, protocol(true));
  EXPECT_FALSE(team["a"].set_reference("x", true));
  EXPECT_FALSE(team["a"].refers_to("x"));
  EXPECT_TRUE(team["a"].set_reference("b", true));
  EXPECT_TRUE(team["a"].refers_to("b"));
  RoleOutput out;
  team["a"].receive("x", PreviewMessage{1000, "x", "a", 5, {1, 2, 3}}, {}, out);
  EXPECT_TRUE(out.send.empty() && out.decisions.empty() && out.problems.empty());
}

TEST(ExchangeStage, StampsThatGoBackBeginAnEpoch) {
  Team team({"a", "b"}, protocol(true));
  team["b"].set_reference("a", true);
  team.see(1000);
  team.see(2000);
  team.see(1000);
  std::vector<std::uint32_t> epochs;
  for (const auto& [robot, decision] : team.decisions()) {
    if (decision.action == Action::kSendSparse) epochs.push_back(decision.epoch);
  }
  EXPECT_EQ(epochs, (std::vector<std::uint32_t>{0, 0, 1}));
}

TEST(ExchangeStage, DecisionsSayHowLongTheyTook) {
  Team team({"a", "b"}, protocol(true));
  team["b"].set_reference("a", true);
  team.see(1000);
  for (const auto& [robot, decision] : team.decisions()) EXPECT_GT(decision.ms_pose, 0.0f) << robot;
}

}  // namespace
}  // namespace rprr
