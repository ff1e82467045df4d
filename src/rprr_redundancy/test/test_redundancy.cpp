// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_redundancy/redundancy.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <set>

#include "rprr_redundancy/prediction.hpp"
#include "rprr_wire/mask_wire.hpp"

namespace rprr {
namespace {

using Action = FrameDecision::Action;

const Camera kCamera{160, 120, 140, 140, 79.5, 59.5};
const BlockGrid kSmallGrid(160, 120);

Pose b_from_a() {
  Pose pose = Pose::Identity();
  pose.translation().x() = 0.3;
  return pose;
}

RgbdFramePtr frame_of(Stamp stamp) {
  auto frame = std::make_shared<RgbdFrame>();
  frame->stamp = stamp;
  frame->frame_id = "optical";
  frame->camera = kCamera;
  frame->depth = {cv::Mat(120, 160, CV_16UC1, cv::Scalar(2000)), 0.001};
  frame->depth.counts(cv::Rect(0, 40, 16, 16)).setTo(500);
  frame->bgr = cv::Mat(120, 160, CV_8UC3, cv::Scalar(60, 80, 100));
  return frame;
}

FrameDecision decision(Action action, Stamp stamp, const std::string& peer,
                       std::uint32_t exchange = 7) {
  FrameDecision out;
  out.action = action;
  out.frame = frame_of(stamp);
  out.exchange = exchange;
  out.peer = peer;
  out.reason = "a test";
  out.exchange_bytes = 5000;
  out.ms_pose = 3.0f;
  if (action == Action::kSendSparse || action == Action::kPredict) {
    out.pose.verdict.status = PoseStatus::kAccepted;
    out.pose.b_from_a = b_from_a();
    out.pose.stamp = 500;
    out.pose.dependent_stamp = stamp;
    out.peer_camera = kCamera;
  }
  return out;
}

class RedundancyTest : public testing::Test {
 protected:
  // What the peer asks for, as a message.
  void receive(const std::string& sender, Stamp stamp, std::uint32_t exchange = 7,
               const std::string& receiver = "b") {
    const Bytes bytes = encode_mask(asked);
    stage.receive({sender, receiver, exchange, stamp, bytes, 0}, now, out);
  }

  BlockMask asked = [] {
    BlockMask mask(kSmallGrid);
    mask.set(17);
    return mask;
  }();
  SteadyTime now;
  Redundancy stage{"b"};
  RedundancyOutput out;
};

TEST_F(RedundancyTest, AsDependentItSendsWhatThePeerAsksForAndWhatItAloneSees) {
  stage.take(decision(Action::kSendSparse, 100, "a"), now, out);
  ASSERT_EQ(out.validations.size(), 1u);
  const BlockMask validated = out.validations[0].blocks;
  EXPECT_GT(validated.count(), 0);
  EXPECT_TRUE(out.frames.empty()) << "the prediction is still to come";
  receive("a", 100);
  ASSERT_EQ(out.frames.size(), 1u);
  const OutgoingFrame& frame = out.frames[0];
  EXPECT_TRUE(frame.sparse);
  EXPECT_EQ(frame.frame->stamp, 100);
  EXPECT_EQ(frame.reference, "a");
  EXPECT_EQ(frame.reference_stamp, 500);
  EXPECT_TRUE(frame.b_from_a.isApprox(b_from_a()));
  BlockMask expected = asked;
  expected |= validated;
  EXPECT_TRUE(frame.mask == expected);
  EXPECT_EQ(frame.report.bytes_pose, 5000u);
  EXPECT_GT(frame.report.bytes_masks, 0u);
  EXPECT_EQ(frame.report.blocks_predicted, 1);
  EXPECT_EQ(frame.report.blocks_validated, validated.count());
  EXPECT_EQ(frame.report.ms_pose, 3.0f);
  EXPECT_GT(frame.report.ms_validate, 0.0f);
}

TEST_F(RedundancyTest, AsReferenceItTellsThePeerWhatToSend) {
  FrameDecision predict = decision(Action::kPredict, 100, "c");
  predict.pose.dependent_stamp = 104;
  stage.take(predict, now, out);
  ASSERT_EQ(out.requests.size(), 1u);
  EXPECT_EQ(out.requests[0].receiver, "c");
  EXPECT_EQ(out.requests[0].exchange, 7u);
  EXPECT_EQ(out.requests[0].stamp, 104);
  EXPECT_FALSE(out.requests[0].decision.from_preview) << "there is none: the paper's B_p";
  EXPECT_TRUE(out.requests[0].decision.send.colour ==
              Predictor().predict(predict.frame->depth, kCamera, kCamera, b_from_a()));
}

TEST_F(RedundancyTest, TheTimeOfAPredictionIsReportedOnceWithTheNextFrame) {
  stage.take(decision(Action::kPredict, 100, "c"), now, out);
  stage.take(decision(Action::kSendReference, 100, "c"), now, out);
  stage.take(decision(Action::kSendWhole, 200, "a"), now, out);
  ASSERT_EQ(out.frames.size(), 2u);
  EXPECT_EQ(out.frames[0].report.ms_predict, out.requests[0].ms);
  EXPECT_GT(out.frames[0].report.ms_predict, 0.0f);
  EXPECT_EQ(out.frames[0].report.bytes_pose, 0u) << "what it cost is told by the dependent";
  EXPECT_EQ(out.frames[1].report.ms_predict, 0.0f);
}

TEST_F(RedundancyTest, BothRolesAtOnceOnOneFrame) {
  stage.take(decision(Action::kSendSparse, 100, "a"), now, out);
  stage.take(decision(Action::kPredict, 100, "c", 9), now, out);
  stage.take(decision(Action::kSendReference, 100, "c", 9), now, out);
  ASSERT_EQ(out.frames.size(), 1u) << "c refers to the frame: it cannot wait for a";
  EXPECT_FALSE(out.frames[0].sparse);
  receive("a", 100);
  EXPECT_EQ(out.frames.size(), 1u) << "it has gone out whole";
  EXPECT_EQ(out.requests.size(), 1u);
}

TEST_F(RedundancyTest, AFrameThatWentOutSparselyGoesOutWholeForWhoRefersToIt) {
  stage.take(decision(Action::kSendSparse, 100, "a"), now, out);
  receive("a", 100);
  stage.take(decision(Action::kSendReference, 100, "c", 9), now, out);
  ASSERT_EQ(out.frames.size(), 2u);
  EXPECT_TRUE(out.frames[0].sparse);
  EXPECT_FALSE(out.frames[1].sparse);
  stage.take(decision(Action::kSendReference, 100, "d", 3), now, out);
  EXPECT_EQ(out.frames.size(), 2u) << "once is enough";
}

TEST_F(RedundancyTest, PredictionsOfOtherPeersAreNotTaken) {
  stage.take(decision(Action::kSendSparse, 100, "a"), now, out);
  receive("c", 100);
  receive("a", 100, 7, "d");
  EXPECT_TRUE(out.frames.empty());
  receive("a", 100);
  EXPECT_EQ(out.frames.size(), 1u);
}

TEST_F(RedundancyTest, WithoutAPredictionTheFrameGoesOutWhole) {
  stage.take(decision(Action::kSendSparse, 100, "a"), now, out);
  stage.tick(steady_seconds(0.9), out);
  EXPECT_TRUE(out.frames.empty());
  stage.tick(steady_seconds(1.1), out);
  ASSERT_EQ(out.frames.size(), 1u);
  EXPECT_FALSE(out.frames[0].sparse);
  EXPECT_FALSE(out.frames[0].reason.empty());
}

TEST_F(RedundancyTest, DecisionsThatMakeNoSenseSendTheFrameWhole) {
  FrameDecision no_pose = decision(Action::kSendSparse, 100, "a");
  no_pose.pose.b_from_a.translation().x() = std::nan("");
  FrameDecision no_camera = decision(Action::kSendSparse, 200, "a");
  no_camera.peer_camera.reset();
  FrameDecision rejected = decision(Action::kSendSparse, 300, "a");
  rejected.pose.verdict.status = PoseStatus::kLittleOverlap;
  for (const FrameDecision& bad : {no_pose, no_camera, rejected}) stage.take(bad, now, out);
  EXPECT_EQ(out.problems.size(), 3u);
  ASSERT_EQ(out.frames.size(), 3u);
  for (const OutgoingFrame& frame : out.frames) EXPECT_FALSE(frame.sparse);

  no_pose.action = Action::kPredict;
  stage.take(no_pose, now, out);
  FrameDecision no_frame = decision(Action::kSendWhole, 400, "a");
  no_frame.frame = nullptr;
  stage.take(no_frame, now, out);
  EXPECT_EQ(out.problems.size(), 5u);
  EXPECT_TRUE(out.requests.empty());
}

TEST_F(RedundancyTest, StampsOfAnotherEpochNameOtherFrames) {
  stage.take(decision(Action::kSendWhole, 100, "a"), now, out);
  stage.take(decision(Action::kSendWhole, 100, "a"), now, out);
  EXPECT_EQ(out.frames.size(), 1u);
  FrameDecision again = decision(Action::kSendWhole, 100, "a");
  again.epoch = 1;
  stage.take(again, now, out);
  EXPECT_EQ(out.frames.size(), 2u);
}

// Whatever comes in whatever order: every frame that was decided about goes out once and once
// more at most, and never sparsely after it went out whole.
TEST_F(RedundancyTest, NoFrameIsLostWhateverHappens) {
  std::mt19937 random(4);
  std::set<Stamp> decided, sent, whole;
  for (int step = 0; step < 3000; ++step) {
    const Stamp stamp = 1000 + step / 4;
    const std::string peer = random() % 2 ? "a" : "c";
    const auto action = static_cast<Action>(random() % 4);
    out = {};
    now += from_seconds(0.02);
    if (random() % 3 == 0) {
      receive(peer, stamp);
    } else {
      stage.take(decision(action, stamp, peer), now, out);
      if (action != Action::kPredict) decided.insert(stamp);
    }
    stage.tick(now, out);
    for (const OutgoingFrame& frame : out.frames) {
      EXPECT_TRUE(whole.insert(frame.frame->stamp).second || !frame.sparse);
      if (frame.sparse) whole.erase(frame.frame->stamp);
      sent.insert(frame.frame->stamp);
    }
  }
  out = {};
  stage.tick(now + from_seconds(10.0), out);
  for (const OutgoingFrame& frame : out.frames) sent.insert(frame.frame->stamp);
  EXPECT_EQ(sent, decided);
}

}  // namespace
}  // namespace rprr
