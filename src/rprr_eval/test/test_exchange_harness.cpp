// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_eval/exchange/exchange_harness.hpp"

#include <gtest/gtest.h>

#include "rprr_eval/measure/metrics.hpp"
#include "rprr_geometry/relative_pose.hpp"
#include "rprr_pose/samples_protocol.hpp"
#include "rprr_wire/camera_wire.hpp"
#include "synthetic_walk.hpp"

namespace rprr {
namespace {

constexpr Duration kLatency = from_seconds(0.005);

RgbdFramePtr frame_of(const WalkFrame& seen, Stamp stamp, const std::string& robot) {
  auto frame = std::make_shared<RgbdFrame>();
  frame->stamp = stamp;
  frame->frame_id = robot + "_rgb_optical_frame";
  frame->camera = rounded_for_wire(example_sensor_a(320, 240).camera);
  frame->depth = seen.image.depth;
  return frame;
}

ExchangeHarness samples_harness(Duration latency = kLatency) {
  SamplesOptions options;
  options.max_iterations = 50;
  options.step_timeout = from_seconds(0.5);
  return {{"a", make_samples_reference("a", "b", options)},
          {"b", make_samples_dependent("b", "a", options)},
          latency};
}

TEST(ExchangeHarness, NeighboursOfAWalkAgreeOnTheTruePose) {
  const WalkFrame a = walk_frame(0);
  const WalkFrame b = walk_frame(1);
  ExchangeHarness harness = samples_harness();
  const ExchangeOutcome outcome = harness.run(frame_of(a, 1000, "a"), frame_of(b, 1000, "b"));
  ASSERT_TRUE(outcome.pose);
  EXPECT_TRUE(outcome.pose->verdict.accepted()) << describe(outcome.pose->verdict);
  const PoseError error = pose_error(outcome.pose->b_from_a,
                                     relative_pose_of(a.world_from_camera, b.world_from_camera));
  EXPECT_LT(error.metres, 0.04);
  EXPECT_LT(error.degrees, 1.5);
  ASSERT_FALSE(outcome.at_reference.empty()) << "a is told to predict";
  EXPECT_EQ(outcome.at_reference.back().action, FrameDecision::Action::kPredict);
  EXPECT_EQ(outcome.at_dependent.action, FrameDecision::Action::kSendSparse);
  EXPECT_EQ(outcome.at_dependent.frame->stamp, 1000);
}

TEST(ExchangeHarness, CountsWhatBothRobotsCount) {
  ExchangeHarness harness = samples_harness();
  const ExchangeOutcome outcome =
      harness.run(frame_of(walk_frame(0), 1000, "a"), frame_of(walk_frame(1), 1000, "b"));
  ASSERT_TRUE(outcome.pose);
  EXPECT_EQ(outcome.bytes, outcome.pose->bytes_spent);
  EXPECT_EQ(outcome.bytes, outcome.at_dependent.exchange_bytes);
  EXPECT_EQ(outcome.messages, 2 * outcome.pose->iterations + 3);
  EXPECT_EQ(outcome.elapsed, outcome.messages * kLatency)
      << "each message waits for the one before";
  EXPECT_GT(outcome.seconds_compute, 0.0);
}

TEST(ExchangeHarness, RobotsKeepWhatTheyKnowBetweenExchanges) {
  const WalkFrame a = walk_frame(0);
  const WalkFrame b = walk_frame(1);
  ExchangeHarness harness = samples_harness();
  const ExchangeOutcome first = harness.run(frame_of(a, 1000, "a"), frame_of(b, 1000, "b"));
  const ExchangeOutcome second = harness.run(frame_of(a, 2000, "a"), frame_of(b, 2000, "b"));
  ASSERT_TRUE(first.pose && second.pose);
  EXPECT_TRUE(second.pose->verdict.accepted()) << describe(second.pose->verdict);
  EXPECT_EQ(second.pose->exchange, first.pose->exchange + 1);
  EXPECT_LT(second.bytes / static_cast<std::size_t>(second.messages),
            first.bytes / static_cast<std::size_t>(first.messages))
      << "intrinsics cross once";
}

TEST(ExchangeHarness, TheSameFramesLeadToTheSameOutcome) {
  const auto run = [] {
    return samples_harness().run(frame_of(walk_frame(0), 1000, "a"),
                                 frame_of(walk_frame(1), 1000, "b"));
  };
  const ExchangeOutcome first = run();
  const ExchangeOutcome second = run();
  ASSERT_TRUE(first.pose && second.pose);
  EXPECT_EQ(first.bytes, second.bytes);
  EXPECT_TRUE(first.pose->b_from_a.matrix() == second.pose->b_from_a.matrix());
}

TEST(ExchangeHarness, ViewsThatShareNothingSendBWhole) {
  ExchangeHarness harness = samples_harness();
  const ExchangeOutcome outcome =
      harness.run(frame_of(walk_frame(0), 1000, "a"), frame_of(walk_frame(50), 1000, "b"));
  ASSERT_TRUE(outcome.pose);
  EXPECT_FALSE(outcome.pose->verdict.accepted());
  for (const FrameDecision& decision : outcome.at_reference) {
    EXPECT_EQ(decision.action, FrameDecision::Action::kSendReference);
  }
  EXPECT_EQ(outcome.at_dependent.action, FrameDecision::Action::kSendWhole);
  EXPECT_FALSE(outcome.at_dependent.reason.empty());
  EXPECT_EQ(outcome.at_dependent.frame->stamp, 1000);
}

TEST(ExchangeHarness, ALatencyBeyondTheTimeoutsSendsBWhole) {
  ExchangeHarness harness = samples_harness(from_seconds(3.0));
  const ExchangeOutcome outcome =
      harness.run(frame_of(walk_frame(0), 1000, "a"), frame_of(walk_frame(1), 1000, "b"));
  EXPECT_EQ(outcome.at_dependent.action, FrameDecision::Action::kSendWhole);
  EXPECT_FALSE(outcome.at_dependent.reason.empty());
}

// A role that does nothing but note what it is given; decides when it got a message, if at all.
class Listener final : public ExchangeRole {
 public:
  Listener(std::vector<SteadyTime>& arrivals, int messages_to_send, bool decides)
      : arrivals_(arrivals), to_send_(messages_to_send), decides_(decides) {}
  void offer(const RgbdFramePtr& frame, SteadyTime /*now*/, RoleOutput& out) override {
    frame_ = frame;
    for (int i = 0; i < to_send_; ++i) {
      UpdateMessage message;
      message.exchange = static_cast<std::uint32_t>(i);
      out.send.emplace_back(message);
    }
  }
  void receive(const std::string& peer, const PoseMessage& message, SteadyTime now,
               RoleOutput& out) override {
    EXPECT_EQ(peer, "a");
    EXPECT_EQ(std::get<UpdateMessage>(message).exchange, arrivals_.size()) << "out of order";
    arrivals_.push_back(now);
    if (!decides_) return;
    out.decisions.emplace_back();
    out.decisions.back().frame = frame_;
  }
  void tick(SteadyTime /*now*/, RoleOutput& /*out*/) override {}

 private:
  std::vector<SteadyTime>& arrivals_;
  int to_send_;
  bool decides_;
  RgbdFramePtr frame_;
};

TEST(ExchangeHarness, MessagesArriveInOrderOneLatencyLater) {
  std::vector<SteadyTime> unused;
  std::vector<SteadyTime> arrivals;
  ExchangeHarness harness({"a", std::make_unique<Listener>(unused, 3, false)},
                          {"b", std::make_unique<Listener>(arrivals, 0, true)}, kLatency);
  const auto frame = std::make_shared<RgbdFrame>();
  const ExchangeOutcome outcome = harness.run(frame, frame);
  EXPECT_EQ(arrivals, std::vector<SteadyTime>(3, SteadyTime(kLatency)));
  EXPECT_EQ(outcome.messages, 3);
  EXPECT_EQ(outcome.elapsed, kLatency);
}

TEST(ExchangeHarness, RolesThatNeverDecideDoNotHangIt) {
  std::vector<SteadyTime> unused;
  ExchangeHarness harness({"a", std::make_unique<Listener>(unused, 0, false)},
                          {"b", std::make_unique<Listener>(unused, 0, false)}, kLatency);
  const auto frame = std::make_shared<RgbdFrame>();
  const ExchangeOutcome outcome = harness.run(frame, frame);
  EXPECT_FALSE(outcome.pose);
  EXPECT_EQ(outcome.messages, 0);
}

}  // namespace
}  // namespace rprr
