// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "rprr_eval/exchange/fault_channel.hpp"
#include "rprr_wire/bytes.hpp"

namespace rprr {
namespace {

constexpr int kMessages = 2000;
const Duration kStep = from_seconds(0.01);

Bytes numbered(int number) {
  Bytes bytes(64, 0);
  bytes[0] = static_cast<std::uint8_t>(number);
  bytes[1] = static_cast<std::uint8_t>(number >> 8);
  return bytes;
}
int number_of(const Bytes& bytes) {
  return bytes[0] | bytes[1] << 8;
}

// All messages that come out of a channel, one step of time for each that goes in.
std::vector<Bytes> pass(FaultChannel& channel, int messages = kMessages) {
  std::vector<Bytes> out;
  SteadyTime now;
  const auto collect = [&] {
    for (Bytes& bytes : channel.due(now)) out.push_back(std::move(bytes));
  };
  for (int i = 0; i < messages; ++i) {
    channel.add({numbered(i), 2, 62}, now);
    collect();
    now += kStep;
  }
  now += from_seconds(100.0);
  collect();
  return out;
}

std::vector<int> numbers(const std::vector<Bytes>& messages) {
  std::vector<int> out;
  for (const Bytes& bytes : messages) out.push_back(number_of(bytes));
  return out;
}

TEST(FaultChannel, WithoutFaultsEverythingComesAsItIs) {
  FaultChannel channel(1);
  const std::vector<Bytes> out = pass(channel);
  ASSERT_EQ(out.size(), static_cast<std::size_t>(kMessages));
  for (int i = 0; i < kMessages; ++i) EXPECT_EQ(out[static_cast<std::size_t>(i)], numbered(i));
}

TEST(FaultChannel, EachFaultComesAsOftenAsAskedFor) {
  Faults faults;
  faults.lose = 0.1;
  faults.duplicate = 0.2;
  faults.reorder = 0.3;
  faults.corrupt = 0.4;
  FaultChannel channel(7);
  channel.set(faults);
  const std::vector<Bytes> out = pass(channel);
  const FaultChannel::Counts& counts = channel.counts();
  EXPECT_EQ(counts.came, static_cast<std::size_t>(kMessages));
  const double kept = 0.9 * kMessages;
  EXPECT_NEAR(static_cast<double>(counts.lost), 0.1 * kMessages, 60.0);
  EXPECT_NEAR(static_cast<double>(counts.duplicated), 0.2 * kept, 80.0);
  EXPECT_NEAR(static_cast<double>(counts.reordered), 0.3 * kept, 90.0);
  EXPECT_NEAR(static_cast<double>(counts.corrupted), 0.4 * kept, 100.0);
  EXPECT_EQ(out.size(), counts.came - counts.lost + counts.duplicated);
  EXPECT_FALSE(std::is_sorted(out.begin(), out.end(), [](const Bytes& a, const Bytes& b) {
    return number_of(a) < number_of(b);
  }));
}

TEST(FaultChannel, OnlyBytesThatMayBeFlippedAreFlipped) {
  Faults faults;
  faults.corrupt = 1.0;
  FaultChannel channel(3);
  channel.set(faults);
  SteadyTime now;
  for (int i = 0; i < 200; ++i) {
    channel.add({Bytes(64, 0), 20, 10}, now += 1);
    const Bytes bytes = channel.due(now).at(0);
    const auto changed = [](std::uint8_t byte) { return byte != 0; };
    EXPECT_TRUE(std::none_of(bytes.begin(), bytes.begin() + 20, changed));
    EXPECT_TRUE(std::none_of(bytes.begin() + 30, bytes.end(), changed));
  }
  channel.add({Bytes(64, 0), 0, 0}, now += 1);
  EXPECT_EQ(channel.due(now).at(0), Bytes(64, 0)) << "without a range nothing is flipped";
  channel.add({Bytes(4, 0), 20, 10}, now += 1);
  EXPECT_EQ(channel.due(now).at(0), Bytes(4, 0)) << "a range past the end";
}

TEST(FaultChannel, OneSeedMakesOneSequence) {
  Faults faults;
  faults.lose = faults.duplicate = faults.reorder = faults.corrupt = 0.3;
  const auto run = [&faults](std::uint32_t seed) {
    FaultChannel channel(seed);
    channel.set(faults);
    return pass(channel, 200);
  };
  EXPECT_EQ(run(5), run(5));
  EXPECT_NE(run(5), run(6));
}

TEST(FaultChannel, DelayKeepsTheOrder) {
  Faults faults;
  faults.delay = from_seconds(1.0);
  FaultChannel channel(1);
  channel.set(faults);
  channel.add({numbered(1), 0, 0}, {});
  channel.add({numbered(2), 0, 0}, {});
  EXPECT_TRUE(channel.due(steady_seconds(0.99)).empty());
  EXPECT_EQ(numbers(channel.due(steady_seconds(1.0))), (std::vector<int>{1, 2}));
}

TEST(FaultChannel, NothingPassesWhileItIsDownAndNothingComesAfterwards) {
  Faults faults;
  faults.delay = from_seconds(1.0);
  FaultChannel channel(1);
  channel.set(faults);
  channel.add({numbered(1), 0, 0}, {});
  Faults down;
  down.down = true;
  channel.set(down);
  channel.add({numbered(2), 0, 0}, {});
  channel.set({});
  EXPECT_TRUE(channel.due(steady_seconds(10.0)).empty());
  EXPECT_EQ(channel.counts().lost, 2u);
  channel.add({numbered(3), 0, 0}, steady_seconds(10.0));
  EXPECT_EQ(numbers(channel.due(steady_seconds(10.0))), (std::vector<int>{3}));
}

TEST(FaultChannel, WhatIsUnderWayIsBounded) {
  Faults faults;
  faults.delay = from_seconds(1.0);
  FaultChannel channel(1, 10);
  channel.set(faults);
  for (int i = 0; i < 100; ++i) channel.add({numbered(i), 0, 0}, {});
  EXPECT_EQ(channel.under_way(), 10u);
  EXPECT_EQ(channel.counts().lost, 90u);
}

}  // namespace
}  // namespace rprr
