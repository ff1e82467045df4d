// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_pose/samples_protocol.hpp"

#include <gtest/gtest.h>

#include <deque>
#include <functional>
#include <random>

#include "rprr_pose/samples_wire.hpp"
#include "rprr_wire/bytes.hpp"
#include "rprr_wire/camera_wire.hpp"
#include "synthetic_views.hpp"

namespace rprr {
namespace {

constexpr Duration kMillisecond = 1000000;

// The channel takes milliseconds, so half a second is a long silence. The paper's number of
// iterations leaves room for starts from the identity.
SamplesOptions options_of_tests() {
  SamplesOptions options;
  options.max_iterations = 50;
  options.step_timeout = 500 * kMillisecond;
  return options;
}

// Two roles on a channel that a test may disturb: each message may be passed, dropped, doubled or
// replaced.
class Pair {
 public:
  using Channel = std::function<std::vector<PoseMessage>(const PoseMessage&, bool from_reference)>;

  explicit Pair(const std::function<void(SamplesOptions&)>& change = [](SamplesOptions&) {}) {
    SamplesOptions options = options_of_tests();
    change(options);
    reference = make_samples_reference("a", "b", options);
    dependent = make_samples_dependent("b", "a", options);
  }

  void offer(const RgbdFramePtr& a, const RgbdFramePtr& b) {
    if (b) give(false, [&](ExchangeRole& role, RoleOutput& out) { role.offer(b, now, out); });
    if (a) give(true, [&](ExchangeRole& role, RoleOutput& out) { role.offer(a, now, out); });
  }

  void run(Duration duration) {
    for (const SteadyTime end = now + duration; now < end; now += 5 * kMillisecond) {
      for (std::size_t waiting = in_flight.size(); waiting > 0; --waiting) {
        const auto [message, from_reference] = in_flight.front();
        in_flight.pop_front();
        const std::string sender = from_reference ? "a" : "b";
        give(!from_reference, [&, sent = message](ExchangeRole& role, RoleOutput& out) {
          role.receive(sender, sent, now, out);
        });
      }
      for (const bool at_reference : {true, false}) {
        give(at_reference, [&](ExchangeRole& role, RoleOutput& out) { role.tick(now, out); });
      }
    }
  }

  std::vector<FrameDecision> at_reference, at_dependent;
  std::vector<MessageProblem> problems;
  std::vector<RelativePoseMessage> poses;
  int messages = 0;
  std::size_t bytes = 0;
  Channel channel = [](const PoseMessage& message, bool) { return std::vector{message}; };
  SteadyTime now;
  std::unique_ptr<ExchangeRole> reference, dependent;
  std::deque<std::pair<PoseMessage, bool>> in_flight;

 private:
  void give(bool to_reference, const std::function<void(ExchangeRole&, RoleOutput&)>& action) {
    RoleOutput out;
    action(to_reference ? *reference : *dependent, out);
    for (const PoseMessage& message : out.send) {
      ++messages;
      bytes += serialised_bytes(message);
      if (const auto* pose = std::get_if<RelativePoseMessage>(&message)) poses.push_back(*pose);
      for (const PoseMessage& passed : channel(message, to_reference)) {
        in_flight.emplace_back(passed, to_reference);
      }
    }
    auto& decisions = to_reference ? at_reference : at_dependent;
    decisions.insert(decisions.end(), out.decisions.begin(), out.decisions.end());
    problems.insert(problems.end(), out.problems.begin(), out.problems.end());
  }
};

const Pose kSamplesTruth = test_motion(0.12, 6.0);

RgbdFramePtr corner_a(Stamp stamp = 1000) {
  return corner_frame(Pose::Identity(), stamp, "a");
}
RgbdFramePtr corner_b(Stamp stamp = 1000) {
  return corner_frame(kSamplesTruth, stamp, "b");
}

TEST(SamplesProtocol, EndsWithTheTruePoseAndBothRobotsKnowWhatToDo) {
  Pair pair;
  pair.offer(corner_a(), corner_b());
  pair.run(from_seconds(0.4));
  ASSERT_EQ(pair.poses.size(), 1u);
  const RelativePoseMessage& pose = pair.poses[0];
  EXPECT_TRUE(pose.verdict.accepted()) << describe(pose.verdict);
  EXPECT_LT(translation_error(pose.b_from_a, kSamplesTruth), 0.01);
  EXPECT_LT(rotation_error(pose.b_from_a, kSamplesTruth), 0.3);
  ASSERT_EQ(pair.at_reference.size(), 2u) << "send whole as reference, then predict";
  EXPECT_EQ(pair.at_reference[0].action, FrameDecision::Action::kSendReference);
  EXPECT_EQ(pair.at_reference[1].action, FrameDecision::Action::kPredict);
  ASSERT_EQ(pair.at_dependent.size(), 1u);
  EXPECT_EQ(pair.at_dependent[0].action, FrameDecision::Action::kSendSparse);
  ASSERT_TRUE(pair.at_dependent[0].peer_camera);
  EXPECT_EQ(camera_hash(*pair.at_dependent[0].peer_camera), camera_hash(kTestCamera));
  EXPECT_TRUE(pair.problems.empty()) << pair.problems[0].text;
}

TEST(SamplesProtocol, CountsItsBytesAndMessagesHonestly) {
  Pair pair;
  pair.offer(corner_a(), corner_b());
  pair.run(from_seconds(0.4));
  ASSERT_EQ(pair.poses.size(), 1u);
  EXPECT_EQ(pair.poses[0].bytes_spent, pair.bytes);
  EXPECT_EQ(pair.at_dependent[0].exchange_bytes, pair.bytes);
  EXPECT_EQ(pair.messages, 2 * pair.poses[0].iterations + 3);
}

TEST(SamplesProtocol, IntrinsicsCrossTheRadioOnce) {
  Pair pair;
  int cameras = 0;
  pair.channel = [&](const PoseMessage& message, bool) {
    if (const auto* samples = std::get_if<SamplesMessage>(&message)) {
      if (decode_samples(samples->data)->camera) ++cameras;
    }
    return std::vector{message};
  };
  for (int k = 0; k < 3; ++k) {
    pair.offer(corner_a(1000 + k), corner_b(1000 + k));
    pair.run(from_seconds(0.4));
  }
  EXPECT_EQ(pair.poses.size(), 3u);
  EXPECT_EQ(cameras, 2);
}

TEST(SamplesProtocol, ThePapersWayResamplesAndAgrees) {
  Pair pair([](SamplesOptions& options) {
    options.resample = true;
    options.local_start = false;
    options.by_noise = false;
    options.converged_translation = options.converged_rotation = 5e-3;
    options.max_iterations = 50;
    options.limits.max_residual_sigmas = 10.0;
  });
  pair.offer(corner_a(), corner_b());
  pair.run(from_seconds(2.0));
  ASSERT_EQ(pair.poses.size(), 1u);
  EXPECT_TRUE(pair.poses[0].verdict.accepted()) << describe(pair.poses[0].verdict);
  EXPECT_LT(translation_error(pair.poses[0].b_from_a, kSamplesTruth), 0.03);
  EXPECT_EQ(pair.messages, 4 * pair.poses[0].iterations + 1);
}

TEST(SamplesProtocol, NoOverlapIsRejectedAndBGoesOutWhole) {
  Pair pair;
  pair.offer(corner_a(), corner_frame(test_motion(0.2, 150.0), 1000, "b"));
  pair.run(from_seconds(3.0));
  ASSERT_EQ(pair.poses.size(), 1u);
  const PoseVerdict& verdict = pair.poses[0].verdict;
  EXPECT_FALSE(verdict.accepted());
  ASSERT_FALSE(pair.at_dependent.empty());
  EXPECT_EQ(pair.at_dependent[0].action, FrameDecision::Action::kSendWhole);
  EXPECT_EQ(pair.at_dependent[0].reason, "pose rejected: " + describe(verdict));
  EXPECT_NE(pair.at_dependent[0].reason.find("needs"), std::string::npos)
      << pair.at_dependent[0].reason;
  ASSERT_TRUE(pair.at_dependent[0].verdict);
  EXPECT_EQ(pair.at_dependent[0].verdict->status, verdict.status);
}

TEST(SamplesProtocol, AnIterationThatIsCutShortSaysHowFarItStillMoved) {
  Pair pair([](SamplesOptions& options) {
    options.local_start = false;
    options.max_iterations = 1;
  });
  pair.offer(corner_a(), corner_b());
  pair.run(from_seconds(0.4));
  ASSERT_EQ(pair.poses.size(), 1u);
  const PoseVerdict& verdict = pair.poses[0].verdict;
  EXPECT_EQ(verdict.status, PoseStatus::kNotConverged) << describe(verdict);
  EXPECT_EQ(verdict.needed, 1e-3f);
  EXPECT_GT(verdict.measured, 0.01f) << "it starts 0.12 m and 6 degrees off";
}

TEST(SamplesProtocol, AWallLeavesADirectionFree) {
  const auto wall_of = [](const std::string& robot) {
    auto wall = std::make_shared<RgbdFrame>(*corner_frame(Pose::Identity(), 1000, robot));
    wall->depth.counts = cv::Mat(240, 320, CV_16UC1, cv::Scalar(2000));
    return wall;
  };
  Pair pair;
  pair.offer(wall_of("a"), wall_of("b"));
  pair.run(from_seconds(2.0));
  ASSERT_EQ(pair.poses.size(), 1u);
  const PoseVerdict& verdict = pair.poses[0].verdict;
  EXPECT_EQ(verdict.status, PoseStatus::kFreeDirection) << describe(verdict);
  EXPECT_GT(verdict.measured, verdict.needed);
}

TEST(SamplesProtocol, AnyLostMessageCostsOneExchangeNotTheSession) {
  for (int lost = 0; lost < 7; ++lost) {
    Pair pair;
    int sent = 0;
    pair.channel = [&](const PoseMessage& message, bool) {
      return sent++ == lost ? std::vector<PoseMessage>{} : std::vector{message};
    };
    pair.offer(corner_a(1000), corner_b(1000));
    pair.run(from_seconds(1.5));
    ASSERT_EQ(pair.at_dependent.size(), 1u) << "lost message " << lost;
    pair.offer(corner_a(2000), corner_b(2000));
    pair.run(from_seconds(0.4));
    ASSERT_EQ(pair.at_dependent.size(), 2u) << "lost message " << lost;
    EXPECT_EQ(pair.at_dependent[1].action, FrameDecision::Action::kSendSparse)
        << "lost message " << lost << ": " << pair.at_dependent[1].reason;
  }
}

TEST(SamplesProtocol, DoubledAndReorderedMessagesDoNoHarm) {
  Pair pair;
  std::mt19937 random(3);
  pair.channel = [&](const PoseMessage& message, bool) { return std::vector{message, message}; };
  pair.offer(corner_a(), corner_b());
  pair.run(from_seconds(0.5));
  ASSERT_EQ(pair.poses.size(), 1u);
  EXPECT_TRUE(pair.poses[0].verdict.accepted()) << describe(pair.poses[0].verdict);
  EXPECT_EQ(pair.at_dependent.size(), 1u);
}

TEST(SamplesProtocol, ASilentReferenceLetsBGoOutWhole) {
  Pair pair;
  pair.offer(nullptr, corner_b());
  pair.run(from_seconds(1.2));
  ASSERT_EQ(pair.at_dependent.size(), 1u);
  EXPECT_EQ(pair.at_dependent[0].action, FrameDecision::Action::kSendWhole);
  EXPECT_EQ(pair.at_dependent[0].exchange, 0u);
}

TEST(SamplesProtocol, FramesThatCannotBePairedAreNotCalledSilence) {
  Pair pair;
  pair.offer(corner_a(from_seconds(103.7)), corner_b(from_seconds(100.0)));
  for (int k = 1; k < 25; ++k) {  // frames go on
    pair.run(from_seconds(0.1));
    pair.offer(nullptr, corner_b(from_seconds(100.0 + 0.1 * k)));
  }
  ASSERT_FALSE(pair.at_dependent.empty());
  EXPECT_EQ(pair.at_dependent[0].action, FrameDecision::Action::kSendWhole);
  EXPECT_NE(pair.at_dependent[0].reason.find("clocks"), std::string::npos)
      << pair.at_dependent[0].reason;
}

TEST(SamplesProtocol, ASilentDependentTimesOut) {
  Pair pair;
  pair.offer(corner_a(), nullptr);
  pair.run(from_seconds(1.0));
  ASSERT_EQ(pair.poses.size(), 1u);
  const PoseVerdict& verdict = pair.poses[0].verdict;
  EXPECT_EQ(verdict.status, PoseStatus::kTimedOut) << describe(verdict);
  EXPECT_EQ(verdict.quantity, PoseQuantity::kSilence);
  EXPECT_GE(verdict.measured, verdict.needed);
  EXPECT_FLOAT_EQ(verdict.needed, static_cast<float>(to_seconds(options_of_tests().step_timeout)));
}

TEST(SamplesProtocol, BsFrameMayComeAfterAsPoints) {
  Pair pair;
  pair.offer(corner_a(), nullptr);
  pair.run(from_seconds(0.05));
  pair.offer(nullptr, corner_b());
  pair.run(from_seconds(0.4));
  ASSERT_EQ(pair.at_dependent.size(), 1u);
  EXPECT_EQ(pair.at_dependent[0].action, FrameDecision::Action::kSendSparse);
}

TEST(SamplesProtocol, TheDependentTakesTheFrameNearestInTime) {
  Pair pair;
  pair.offer(nullptr, corner_b(from_seconds(1.00)));
  pair.offer(nullptr, corner_b(from_seconds(1.03)));
  pair.offer(corner_a(from_seconds(1.02)), nullptr);
  pair.run(from_seconds(0.4));
  ASSERT_EQ(pair.poses.size(), 1u);
  EXPECT_EQ(pair.poses[0].dependent_stamp, from_seconds(1.03));
}

TEST(SamplesProtocol, MessagesForOthersAreIgnored) {
  Pair pair;
  pair.channel = [](PoseMessage message, bool) {
    if (auto* samples = std::get_if<SamplesMessage>(&message)) samples->receiver = "c";
    return std::vector{message};
  };
  pair.offer(corner_a(), corner_b());
  pair.run(from_seconds(0.3));
  EXPECT_EQ(pair.messages, 1) << "b must not answer what is for c";
}

TEST(SamplesProtocol, GarbageFromThePeerIsReportedAndSurvived) {
  std::mt19937 random(9);
  Pair pair;
  int garbage = 60;
  pair.channel = [&](PoseMessage message, bool) {
    Bytes* data = nullptr;
    if (auto* samples = std::get_if<SamplesMessage>(&message)) data = &samples->data;
    if (auto* update = std::get_if<UpdateMessage>(&message)) data = &update->data;
    if (data && garbage > 0) {
      --garbage;
      data->resize(data->size() - 4);
      (*data)[random() % data->size()] = static_cast<std::uint8_t>(random());
      seal(*data);
    }
    return std::vector{message};
  };
  int k = 0;
  while (garbage > 0 && k < 100) {
    ++k;
    pair.offer(corner_a(1000 * k), corner_b(1000 * k));
    pair.run(from_seconds(1.2));
  }
  const std::size_t before = pair.poses.size();
  pair.offer(corner_a(1000000), corner_b(1000000));
  pair.run(from_seconds(1.2));
  pair.offer(corner_a(2000000), corner_b(2000000));
  pair.run(from_seconds(1.2));
  ASSERT_GE(pair.poses.size(), before + 1);
  EXPECT_TRUE(pair.poses.back().verdict.accepted()) << describe(pair.poses.back().verdict);
}

TEST(SamplesProtocol, ARestartedReferenceIsServedAtOnce) {
  Pair pair;
  pair.offer(corner_a(1000), corner_b(1000));
  pair.run(from_seconds(0.4));
  SamplesOptions options = options_of_tests();
  options.first_exchange = 5000;
  pair.reference = make_samples_reference("a", "b", options);
  for (const Stamp stamp : {2000, 3000}) {  // the first tells b that its camera is unknown again
    pair.offer(corner_a(stamp), corner_b(stamp));
    pair.run(from_seconds(1.2));
  }
  EXPECT_TRUE(pair.poses.back().verdict.accepted()) << describe(pair.poses.back().verdict);
}

TEST(SamplesProtocol, AFrameWithoutDepthIsSaidSo) {
  auto empty = std::make_shared<RgbdFrame>(*corner_a());
  empty->depth.counts = cv::Mat(240, 320, CV_16UC1, cv::Scalar(0));
  Pair pair;
  pair.offer(empty, corner_b());
  pair.run(from_seconds(0.2));
  ASSERT_EQ(pair.poses.size(), 1u);
  EXPECT_EQ(describe(pair.poses[0].verdict), "too few points: points with depth 0, needs 30");
}

}  // namespace
}  // namespace rprr
