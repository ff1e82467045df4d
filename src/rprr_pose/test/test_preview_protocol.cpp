// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_pose/preview_protocol.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "near_in_time.hpp"
#include "rprr_wire/bytes.hpp"
#include "rprr_wire/camera_wire.hpp"
#include "textured_views.hpp"

namespace rprr {
namespace {

std::unique_ptr<ExchangeRole> reference_of(const PreviewOptions& options = near_in_time()) {
  return make_preview_reference("a", "b", options);
}
std::unique_ptr<ExchangeRole> dependent_of(const PreviewOptions& options = {}) {
  return make_preview_dependent("b", "a", options);
}

const Pose kPreviewTruth = test_motion(0.12, 6.0);
RgbdFramePtr frame_a(Stamp stamp = 1000) {
  return textured_frame(Pose::Identity(), stamp, "a");
}
RgbdFramePtr frame_b(Stamp stamp = 1000) {
  return textured_frame(kPreviewTruth, stamp, "b");
}

class PreviewProtocol : public ::testing::Test {
 protected:
  PreviewProtocol() : reference(reference_of()), dependent(dependent_of()) {}

  // One exchange over a channel without faults; returns what a and b decided.
  void exchange(Stamp stamp) {
    at_a = at_b = {};
    reference->offer(frame_a(stamp), now, at_a);
    dependent->offer(frame_b(stamp), now, at_b);
    for (const PoseMessage& message : at_b.send) reference->receive("b", message, now, at_a);
    for (const PoseMessage& message : at_a.send) dependent->receive("a", message, now, at_b);
  }
  const RelativePoseMessage& pose() const { return std::get<RelativePoseMessage>(at_a.send.at(0)); }

  std::unique_ptr<ExchangeRole> reference, dependent;
  RoleOutput at_a, at_b;
  SteadyTime now;
};

TEST_F(PreviewProtocol, OneMessageEachWayGivesThePose) {
  exchange(1000);
  ASSERT_EQ(at_b.send.size(), 1u);
  ASSERT_EQ(at_a.send.size(), 1u);
  EXPECT_TRUE(pose().verdict.accepted()) << describe(pose().verdict);
  EXPECT_LT(translation_error(pose().b_from_a, kPreviewTruth), 0.03);
  ASSERT_EQ(at_a.decisions.size(), 2u) << "predict, then send whole as reference";
  EXPECT_EQ(at_a.decisions[0].action, FrameDecision::Action::kPredict);
  ASSERT_TRUE(at_a.decisions[0].peer_preview);
  EXPECT_TRUE(decode_preview(at_a.decisions[0].peer_preview->bytes));
  EXPECT_EQ(at_a.decisions[1].action, FrameDecision::Action::kSendReference);
  ASSERT_EQ(at_b.decisions.size(), 1u);
  EXPECT_EQ(at_b.decisions[0].action, FrameDecision::Action::kSendSparse);
  ASSERT_TRUE(at_b.decisions[0].peer_camera);
  EXPECT_EQ(at_b.decisions[0].exchange_bytes,
            serialised_bytes(at_b.send[0]) + serialised_bytes(at_a.send[0]));
  EXPECT_EQ(pose().bytes_spent, at_b.decisions[0].exchange_bytes);
}

TEST_F(PreviewProtocol, TheDependentMaySendDepthLossless) {
  PreviewOptions options;
  options.lossless_depth = true;
  dependent = dependent_of(options);
  exchange(1000);
  EXPECT_TRUE(pose().verdict.accepted()) << describe(pose().verdict);
  EXPECT_LT(translation_error(pose().b_from_a, kPreviewTruth), 0.03);
  ASSERT_EQ(at_a.decisions.size(), 2u);
  ASSERT_TRUE(at_a.decisions[0].peer_preview);
  const BlockPreview* preview = &at_a.decisions[0].peer_preview->preview;
  EXPECT_EQ(preview->coding, PreviewDepth::kCounts);
  const RgbdFramePtr sent = frame_b();
  const BlockPreview exact = make_exact_preview(sent->depth, sent->bgr);
  EXPECT_TRUE(std::equal(exact.depth.begin<std::uint16_t>(), exact.depth.end<std::uint16_t>(),
                         preview->depth.begin<std::uint16_t>()));
}

TEST_F(PreviewProtocol, IntrinsicsCrossTheRadioOnce) {
  exchange(1000);
  const std::size_t first = serialised_bytes(at_b.send[0]);
  EXPECT_FALSE(pose().reference_camera.empty());
  exchange(2000);
  EXPECT_EQ(serialised_bytes(at_b.send[0]) + kCameraBytes, first);
  EXPECT_TRUE(pose().reference_camera.empty());
  EXPECT_TRUE(pose().verdict.accepted()) << describe(pose().verdict);
}

TEST_F(PreviewProtocol, ARestartedReferenceIsToldTheCameraAgain) {
  exchange(1000);
  reference = reference_of();
  exchange(2000);
  EXPECT_EQ(pose().verdict.status, PoseStatus::kMalformed) << describe(pose().verdict);
  EXPECT_EQ(at_b.decisions.at(0).action, FrameDecision::Action::kSendWhole);
  exchange(3000);
  EXPECT_TRUE(pose().verdict.accepted()) << describe(pose().verdict);
}

TEST_F(PreviewProtocol, WithoutAnAnswerBGoesOutWhole) {
  dependent->offer(frame_b(), {}, at_b);
  dependent->tick(steady_seconds(0.9), at_b);
  EXPECT_TRUE(at_b.decisions.empty());
  dependent->tick(steady_seconds(1.1), at_b);
  ASSERT_EQ(at_b.decisions.size(), 1u);
  EXPECT_EQ(at_b.decisions[0].action, FrameDecision::Action::kSendWhole);
  EXPECT_FALSE(at_b.decisions[0].reason.empty());
}

TEST_F(PreviewProtocol, AsFrameMayComeAfterBsPreview) {
  dependent->offer(frame_b(), {}, at_b);
  reference->receive("b", at_b.send.at(0), {}, at_a);
  EXPECT_TRUE(at_a.send.empty());
  reference->offer(frame_a(), {}, at_a);
  ASSERT_EQ(at_a.send.size(), 1u);
  EXPECT_TRUE(pose().verdict.accepted()) << describe(pose().verdict);
}

TEST_F(PreviewProtocol, BIsToldThatNoFrameOfAIsNearInTime) {
  for (const double seconds : {3.7, -3.7}) {
    SCOPED_TRACE(seconds);
    at_a = at_b = {};
    dependent = dependent_of();
    reference = reference_of();
    const Stamp stamp = from_seconds(100.0);
    reference->offer(frame_a(stamp), {}, at_a);
    dependent->offer(frame_b(stamp + from_seconds(seconds)), {}, at_b);
    reference->receive("b", at_b.send.at(0), {}, at_a);
    for (const double later : {0.1, 0.2, 0.3, 0.4}) {  // frames go on, and none is of that time
      reference->offer(frame_a(stamp + from_seconds(later)), steady_seconds(later), at_a);
      reference->tick(steady_seconds(later), at_a);
    }
    EXPECT_TRUE(at_a.send.empty()) << "its frame may be about to arrive";
    reference->tick(steady_seconds(0.6), at_a);
    ASSERT_EQ(at_a.send.size(), 1u);
    EXPECT_EQ(pose().verdict.status, PoseStatus::kNoFrame) << describe(pose().verdict);
    EXPECT_EQ(pose().stamp, stamp + from_seconds(0.4))
        << "of a frame of its own: clocks are compared by it";
    EXPECT_TRUE(at_a.decisions.empty()) << "nothing is sent for it";
    dependent->receive("a", at_a.send[0], steady_seconds(0.6), at_b);
    ASSERT_EQ(at_b.decisions.size(), 1u);
    EXPECT_EQ(at_b.decisions[0].action, FrameDecision::Action::kSendWhole);
    EXPECT_NE(at_b.decisions[0].reason.find("clocks"), std::string::npos);
    EXPECT_EQ(pose().verdict.quantity, PoseQuantity::kTimeApart);
    const double nearest = seconds > 0.0 ? seconds - 0.4 : -seconds;
    EXPECT_NEAR(pose().verdict.measured, nearest, 1e-4) << describe(pose().verdict);
    reference->tick(steady_seconds(2.0), at_a);
    EXPECT_EQ(at_a.send.size(), 1u) << "once";
  }
}

TEST_F(PreviewProtocol, AReferenceWithoutAFrameStaysSilent) {
  dependent->offer(frame_b(), {}, at_b);
  reference->receive("b", at_b.send.at(0), {}, at_a);
  reference->tick(steady_seconds(2.0), at_a);
  EXPECT_TRUE(at_a.send.empty());
}

TEST_F(PreviewProtocol, WithoutRoomOnTheRadioBWaitsAndBeginsWithItsNewestFrame) {
  dependent->set_link_state({false, {}, 0.0}, {}, at_b);
  for (Stamp stamp = 1000; stamp < 1003; ++stamp)
    dependent->offer(frame_b(stamp), SteadyTime(stamp), at_b);
  EXPECT_TRUE(at_b.send.empty());
  dependent->set_link_state({true, {}, 0.0}, SteadyTime(1010), at_b);
  ASSERT_EQ(at_b.send.size(), 1u);
  EXPECT_EQ(std::get<PreviewMessage>(at_b.send[0]).stamp, 1002);
  dependent->set_link_state({true, {}, 0.0}, SteadyTime(1011), at_b);
  EXPECT_EQ(at_b.send.size(), 1u) << "one exchange at a time";
}

// A reference whose radio is busy: frames sent at 1000 and 2000, of which the station holds one.
class BusyReference : public PreviewProtocol {
 protected:
  BusyReference() {
    PreviewOptions options;
    options.reference_age = kAge;
    reference = reference_of(options);
    exchange(1000);
    exchange(2000);
  }
  static constexpr Duration kAge = from_seconds(5.0);
};

TEST_F(BusyReference, RefersToWhatTheStationHolds) {
  reference->set_link_state({false, {1000}, 0.0}, now, at_a);
  exchange(3000);
  EXPECT_TRUE(pose().verdict.accepted()) << describe(pose().verdict);
  EXPECT_EQ(pose().stamp, 1000);
  EXPECT_EQ(pose().dependent_stamp, 3000);
  ASSERT_EQ(at_a.decisions.size(), 1u) << "nothing is sent whole once more";
  EXPECT_EQ(at_a.decisions[0].action, FrameDecision::Action::kPredict);
  ASSERT_EQ(at_b.decisions.size(), 1u);
  EXPECT_EQ(at_b.decisions[0].action, FrameDecision::Action::kSendSparse);
}

TEST_F(BusyReference, OrToTheLastThatWasSent) {
  reference->set_link_state({false, {}, 0.0}, now, at_a);
  exchange(3000);
  EXPECT_EQ(pose().stamp, 2000);
}

TEST_F(BusyReference, OnASlowRadioANewOneGoesOutForLater) {
  reference->set_link_state({true, {1000, 2000}, 3.0}, now, at_a);
  exchange(3000);
  EXPECT_EQ(pose().stamp, 2000) << "the station holds it";
  ASSERT_EQ(at_a.decisions.size(), 2u);
  EXPECT_EQ(at_a.decisions[0].action, FrameDecision::Action::kSendReference);
  EXPECT_EQ(at_a.decisions[0].frame->stamp, 3000);
}

TEST_F(BusyReference, ButNotToAnOldOne) {
  reference->set_link_state({false, {1000}, 0.0}, now, at_a);
  now = SteadyTime(kAge + 1);
  exchange(3000);
  EXPECT_EQ(pose().stamp, 3000);
  EXPECT_EQ(at_a.decisions.size(), 2u);
}

TEST_F(BusyReference, WithRoomItSendsANewOne) {
  reference->set_link_state({true, {1000, 2000}, 0.0}, now, at_a);
  exchange(3000);
  EXPECT_EQ(pose().stamp, 3000);
}

TEST_F(BusyReference, ClocksThatDifferDoNotKeepItFromAnswering) {
  at_a = at_b = {};
  const Stamp later = from_seconds(500.0);
  dependent->offer(frame_b(later), now, at_b);
  reference->receive("b", at_b.send.at(0), now, at_a);
  EXPECT_TRUE(at_a.send.empty()) << "its own frame may be about to arrive";
  for (Stamp stamp = 4000; stamp < 4006; ++stamp) {  // a camera's usual rate
    now += from_seconds(0.033);
    reference->offer(frame_a(stamp), now, at_a);
    reference->tick(now, at_a);
  }
  ASSERT_EQ(at_a.send.size(), 1u);
  EXPECT_TRUE(pose().verdict.accepted()) << describe(pose().verdict);
}

TEST_F(PreviewProtocol, DoubledPreviewsAreAnsweredOnce) {
  reference->offer(frame_a(), {}, at_a);
  dependent->offer(frame_b(), {}, at_b);
  reference->receive("b", at_b.send.at(0), {}, at_a);
  reference->receive("b", at_b.send.at(0), {}, at_a);
  EXPECT_EQ(at_a.send.size(), 1u);
}

TEST_F(PreviewProtocol, MessagesForOthersAreIgnored) {
  reference->offer(frame_a(), {}, at_a);
  dependent->offer(frame_b(), {}, at_b);
  auto message = std::get<PreviewMessage>(at_b.send.at(0));
  message.receiver = "c";
  reference->receive("b", message, {}, at_a);
  EXPECT_TRUE(at_a.send.empty());
}

TEST_F(PreviewProtocol, HostilePreviewsAreRefusedAndServiceGoesOn) {
  std::mt19937 random(5);
  dependent->offer(frame_b(), {}, at_b);
  const auto good = std::get<PreviewMessage>(at_b.send.at(0));
  reference->offer(frame_a(), {}, at_a);
  for (std::uint32_t trial = 0; trial < 300; ++trial) {
    PreviewMessage message = good;
    message.exchange = 100 + trial;
    for (int i = 0; i < 3; ++i) {
      message.data[random() % 40] = static_cast<std::uint8_t>(random());
    }
    if (trial % 3 == 0) message.data.resize(random() % message.data.size());
    reference->receive("b", message, {}, at_a);
  }
  EXPECT_FALSE(at_a.problems.empty());
  for (const MessageProblem& problem : at_a.problems) EXPECT_EQ(problem.peer, "b") << problem.text;
  dependent->tick(steady_seconds(1.0), at_b);  // gives up waiting
  for (Stamp stamp : {5000, 6000}) exchange(stamp);
  EXPECT_TRUE(pose().verdict.accepted()) << describe(pose().verdict);
}

// A preview that waits for the reference's frame is read when that comes, not when it arrived.
TEST_F(PreviewProtocol, APreviewThatIsReadLaterIsRefusedByItsSendersName) {
  dependent->offer(frame_b(), {}, at_b);
  auto message = std::get<PreviewMessage>(at_b.send.at(0));
  message.data[0] = 0xFF;
  reference->receive("b", message, {}, at_a);
  reference->offer(frame_a(), {}, at_a);
  reference->tick(SteadyTime(1), at_a);
  ASSERT_FALSE(at_a.problems.empty());
  EXPECT_EQ(at_a.problems.front().peer, "b");
}

TEST_F(PreviewProtocol, PosesThatAreNoneAreRefused) {
  dependent->offer(frame_b(), {}, at_b);
  RelativePoseMessage bad;
  bad.dependent = "b";
  bad.exchange = 1;
  bad.verdict.status = PoseStatus::kAccepted;
  bad.b_from_a.linear() *= 2.0;
  dependent->receive("a", bad, {}, at_b);
  ASSERT_EQ(at_b.decisions.size(), 1u);
  EXPECT_EQ(at_b.decisions[0].action, FrameDecision::Action::kSendWhole);
  EXPECT_FALSE(at_b.problems.empty());
}

TEST(PreviewContent, RoundTripsAndRefusesCuts) {
  PreviewContent content;
  content.camera = rounded_for_wire(kTestCamera);
  content.camera_hash = camera_hash(kTestCamera);
  content.known_peer_hash = 9;
  content.preview = {1, 2, 3};
  const Bytes bytes = encode_preview_content(content);
  const Result<PreviewContent> back = decode_preview_content(bytes);
  ASSERT_TRUE(back) << back.reason();
  EXPECT_EQ(back->preview, content.preview);
  EXPECT_EQ(back->known_peer_hash, 9u);
  for (std::size_t size = 0; size < bytes.size() - 3; ++size) {
    EXPECT_FALSE(decode_preview_content(ByteView(bytes).first(size))) << "cut to " << size;
  }
}

}  // namespace
}  // namespace rprr
