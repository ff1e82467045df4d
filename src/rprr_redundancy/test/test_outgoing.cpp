// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_redundancy/outgoing.hpp"

#include <gtest/gtest.h>
#include <ros/serialization.h>
#include <rprr_msgs/BlockMask.h>

#include <map>
#include <random>

#include "rprr_wire/bytes.hpp"
#include "rprr_wire/mask_wire.hpp"

namespace rprr {
namespace {

const BlockGrid kGrid(640, 480);
constexpr Duration kTimeout = from_seconds(0.5);

BlockMask mask_of(std::initializer_list<int> blocks) {
  BlockMask mask(kGrid);
  for (const int block : blocks) mask.set(block);
  return mask;
}

PredictionMessage message(std::uint32_t exchange, Stamp stamp, ByteView mask,
                          const std::string& receiver = "b", const std::string& sender = "a") {
  return {sender, receiver, exchange, stamp, mask, 0};
}

class OutgoingTest : public testing::Test {
 protected:
  static OutgoingOptions options() {
    OutgoingOptions options;
    options.prediction_timeout = kTimeout;
    options.waiting = 3;
    options.early_predictions = 3;
    return options;
  }
  Outgoing outgoing{"b", options()};
  const Bytes predicted = encode_mask(mask_of({1, 2, 3}));
};

TEST_F(OutgoingTest, WholeGoesOutAtOnceAndOnce) {
  const auto decisions = outgoing.whole(100, 4, "nobody spoke");
  ASSERT_EQ(decisions.size(), 1u);
  EXPECT_FALSE(decisions[0].sparse);
  EXPECT_EQ(decisions[0].stamp, 100);
  EXPECT_EQ(decisions[0].exchange, 4u);
  EXPECT_EQ(decisions[0].reason, "nobody spoke");
  EXPECT_TRUE(outgoing.whole(100, 5, "again").empty());
}

TEST_F(OutgoingTest, AfterARestartStampsNameOtherFrames) {
  outgoing.whole(100, 4, "nobody spoke");
  outgoing.accepted(101, "a", 5, mask_of({3}), {});
  outgoing.restart();
  EXPECT_EQ(outgoing.waiting(), 0u);
  EXPECT_EQ(outgoing.whole(100, 6, "again").size(), 1u);
  outgoing.accepted(101, "a", 7, mask_of({3}), {});
  EXPECT_EQ(outgoing.prediction(message(7, 101, predicted), SteadyTime(1)).size(), 1u);
}

TEST_F(OutgoingTest, SparseIsTheUnionOfBothSets) {
  EXPECT_TRUE(outgoing.accepted(100, "a", 4, mask_of({3, 9}), {}).empty());
  const auto decisions = outgoing.prediction(message(4, 100, predicted), SteadyTime(1));
  ASSERT_EQ(decisions.size(), 1u);
  EXPECT_TRUE(decisions[0].sparse);
  EXPECT_TRUE(decisions[0].mask == mask_of({1, 2, 3, 9}));
  EXPECT_EQ(decisions[0].blocks_predicted, 3);
  EXPECT_EQ(decisions[0].blocks_validated, 2);
  EXPECT_EQ(decisions[0].message_bytes, block_mask_message_bytes(0, 1, predicted.size()));
  EXPECT_EQ(outgoing.waiting(), 0u);
  EXPECT_TRUE(outgoing.tick(SteadyTime(10 * kTimeout)).empty()) << "decided frames do not time out";
}

TEST_F(OutgoingTest, DepthIsWhatTheReferenceAsksForAndWhatItCannotSee) {
  outgoing.accepted(100, "a", 4, mask_of({3, 9}), {});
  const Bytes pair = encode_mask_pair({mask_of({1, 2, 3}), mask_of({2})});
  const auto decisions = outgoing.prediction(message(4, 100, pair), SteadyTime(1));
  ASSERT_EQ(decisions.size(), 1u);
  EXPECT_TRUE(decisions[0].mask == mask_of({1, 2, 3, 9}));
  EXPECT_TRUE(decisions[0].depth_mask == mask_of({2, 3, 9}));
  outgoing.accepted(101, "a", 5, mask_of({9}), SteadyTime(1));
  const auto paper = outgoing.prediction(message(5, 101, predicted), SteadyTime(1));
  ASSERT_EQ(paper.size(), 1u);
  EXPECT_TRUE(paper[0].depth_mask == paper[0].mask) << "one mask stands for both";
}

TEST_F(OutgoingTest, PredictionMayComeFirst) {
  EXPECT_TRUE(outgoing.prediction(message(4, 100, predicted), {}).empty());
  const auto decisions = outgoing.accepted(100, "a", 4, mask_of({}), SteadyTime(1));
  ASSERT_EQ(decisions.size(), 1u);
  EXPECT_TRUE(decisions[0].sparse);
  EXPECT_EQ(outgoing.early_predictions(), 0u);
}

TEST_F(OutgoingTest, SilenceSendsTheFrameWhole) {
  outgoing.accepted(100, "a", 4, mask_of({}), {});
  EXPECT_TRUE(outgoing.tick(SteadyTime(kTimeout - 1)).empty());
  const auto decisions = outgoing.tick(SteadyTime(kTimeout));
  ASSERT_EQ(decisions.size(), 1u);
  EXPECT_FALSE(decisions[0].sparse);
  EXPECT_NE(decisions[0].reason.find("in time"), std::string::npos);
  EXPECT_TRUE(outgoing.prediction(message(4, 100, predicted), SteadyTime(kTimeout + 1)).empty())
      << "too late";
  EXPECT_EQ(outgoing.early_predictions(), 0u);
}

TEST_F(OutgoingTest, StrangersAndMismatchesAreIgnored) {
  outgoing.accepted(100, "a", 4, mask_of({}), {});
  EXPECT_TRUE(outgoing.prediction(message(4, 100, predicted, "c"), SteadyTime(1)).empty())
      << "for another";
  EXPECT_TRUE(outgoing.prediction(message(3, 100, predicted), SteadyTime(1)).empty())
      << "old exchange";
  EXPECT_TRUE(outgoing.prediction(message(4, 99, predicted), SteadyTime(1)).empty())
      << "another frame";
  EXPECT_TRUE(outgoing.prediction(message(4, 100, predicted, "b", "c"), SteadyTime(1)).empty())
      << "of another peer";
  EXPECT_EQ(outgoing.prediction(message(4, 100, predicted), SteadyTime(1)).size(), 1u);
  EXPECT_TRUE(outgoing.prediction(message(4, 100, predicted), SteadyTime(2)).empty()) << "repeated";
}

TEST_F(OutgoingTest, DuplicateEventsDecideOnce) {
  outgoing.accepted(100, "a", 4, mask_of({}), {});
  EXPECT_TRUE(outgoing.accepted(100, "a", 4, mask_of({}), SteadyTime(1)).empty());
  EXPECT_EQ(outgoing.waiting(), 1u);
  EXPECT_EQ(outgoing.prediction(message(4, 100, predicted), SteadyTime(1)).size(), 1u);
  EXPECT_TRUE(outgoing.accepted(100, "a", 4, mask_of({}), SteadyTime(2)).empty());
  EXPECT_TRUE(outgoing.whole(100, 4, "late").empty());
}

TEST_F(OutgoingTest, WholeOverridesAFrameThatWaits) {
  outgoing.accepted(100, "a", 4, mask_of({}), {});
  EXPECT_EQ(outgoing.whole(100, 4, "rejected after all").size(), 1u);
  EXPECT_EQ(outgoing.waiting(), 0u);
  EXPECT_TRUE(outgoing.tick(SteadyTime(kTimeout)).empty());
}

TEST_F(OutgoingTest, UnreadablePredictionSendsTheFrameWhole) {
  const Bytes other_size = encode_mask(BlockMask(BlockGrid(320, 240), true));
  Bytes cut = predicted;
  cut.pop_back();
  OutgoingOptions small = options();
  small.largest_mask = 16;
  const Bytes long_mask(17, 0);
  Outgoing strict("b", small);
  strict.accepted(1, "a", 1, mask_of({}), {});
  const auto too_long = strict.prediction(message(1, 1, long_mask), {});
  ASSERT_EQ(too_long.size(), 1u);
  EXPECT_NE(too_long[0].reason.find("too long"), std::string::npos);
  Stamp stamp = 100;
  for (const Bytes& bytes : {other_size, cut, Bytes{}, Bytes(5000, 0xAB)}) {
    outgoing.accepted(++stamp, "a", 4, mask_of({1}), {});
    const auto decisions = outgoing.prediction(message(4, stamp, bytes), {});
    ASSERT_EQ(decisions.size(), 1u);
    EXPECT_FALSE(decisions[0].sparse);
    EXPECT_NE(decisions[0].reason.find("unreadable prediction"), std::string::npos);
    EXPECT_GT(decisions[0].message_bytes, bytes.size()) << "they crossed the radio all the same";
  }
}

TEST_F(OutgoingTest, MemoryIsBounded) {
  std::size_t whole = 0;
  for (Stamp stamp = 1; stamp <= 100; ++stamp) {
    whole += outgoing.accepted(stamp, "a", 1, mask_of({}), {}).size();
    outgoing.prediction(message(2, 1000 + stamp, predicted), {});
  }
  EXPECT_EQ(outgoing.waiting(), 3u);
  EXPECT_EQ(outgoing.early_predictions(), 3u);
  EXPECT_EQ(whole, 97u) << "nothing is lost: who has to make room goes out whole";
  outgoing.tick(SteadyTime(10 * kTimeout));
  EXPECT_EQ(outgoing.early_predictions(), 0u) << "forgotten with time";
}

TEST_F(OutgoingTest, APeerThatStartsAgainIsHeard) {
  outgoing.accepted(100, "a", 900, mask_of({}), {});
  EXPECT_EQ(outgoing.prediction(message(900, 100, predicted), {}).size(), 1u);
  outgoing.accepted(200, "a", 1, mask_of({}), SteadyTime(1));
  EXPECT_EQ(outgoing.prediction(message(1, 200, predicted), SteadyTime(1)).size(), 1u);
}

// Whatever happens on the channel, every frame leads to exactly one decision.
TEST_F(OutgoingTest, EveryFrameIsDecidedOnceWhateverTheChannelDoes) {
  std::mt19937 random(3);
  std::map<Stamp, int> decided;
  const auto count = [&](const std::vector<OutgoingDecision>& decisions) {
    for (const auto& decision : decisions) ++decided[decision.stamp];
  };
  SteadyTime now;
  for (Stamp stamp = 1; stamp <= 50; ++stamp) {
    const auto exchange = static_cast<std::uint32_t>(stamp);
    const auto predict = [&] {
      for (auto n = random() % 3; n > 0; --n) {
        count(outgoing.prediction(message(exchange, stamp, predicted), now));
      }
    };
    predict();
    if (random() % 4 == 0) count(outgoing.whole(stamp, exchange, "rejected"));
    count(outgoing.accepted(stamp, "a", exchange, mask_of({}), now));
    predict();
    now += static_cast<Stamp>(random() % 3) * kTimeout / 2;
    count(outgoing.tick(now));
  }
  count(outgoing.tick(now + kTimeout));
  EXPECT_EQ(decided.size(), 50u);
  for (const auto& [stamp, times] : decided) EXPECT_EQ(times, 1) << "frame " << stamp;
}

TEST(BlockMaskMessage, LengthIsThatOfRosSerialisation) {
  rprr_msgs::BlockMask ros;
  ros.header.frame_id = "some_frame";
  ros.receiver = "eyebug_b";
  ros.data.resize(123);
  EXPECT_EQ(ros::serialization::serializationLength(ros), block_mask_message_bytes(10, 8, 123));
  EXPECT_EQ(ros::serialization::serializationLength(rprr_msgs::BlockMask()),
            block_mask_message_bytes(0, 0, 0));
}

}  // namespace
}  // namespace rprr
