// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_radio/send_queue.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "rprr_radio/frame_chunk.hpp"
#include "rprr_wire/bytes.hpp"

namespace rprr {
namespace {

constexpr SteadyTime kQueueStart = steady_seconds(5000.0);
constexpr Duration kMillisecond = from_seconds(0.001);

SendQueueOptions options_of(double bandwidth) {
  SendQueueOptions options;
  options.robot = "b";
  options.bandwidth = bandwidth;
  return options;
}

QueuedFrame whole(Stamp stamp) {
  QueuedFrame frame;
  frame.stamp = stamp;
  frame.frame_id = "camera";
  return frame;
}

QueuedFrame sparse(Stamp stamp, Stamp reference_stamp) {
  QueuedFrame frame = whole(stamp);
  frame.sparse = true;
  frame.reference = "a";
  frame.reference_stamp = reference_stamp;
  return frame;
}

// Encodes what is due to so many bytes, and sends it.
std::vector<SendOrder> pump(SendQueue& queue, SteadyTime now, std::size_t bytes = 100) {
  std::vector<SendOrder> sent;
  for (;;) {
    if (const auto order = queue.next_to_encode(now)) {
      queue.encoded(*order, Bytes(bytes, order->as_whole ? 2 : 1), now);
    }
    auto message = queue.next_to_send(now);
    if (!message) return sent;
    sent.push_back(std::move(*message));
  }
}

TEST(SendQueue, WithoutALimitFramesGoAtOnceInTheirOrderAndInOnePiece) {
  SendQueue queue(options_of(0.0));
  for (Stamp stamp = 1; stamp <= 3; ++stamp)
    EXPECT_TRUE(queue.offer(whole(stamp), kQueueStart).empty());
  const auto sent = pump(queue, kQueueStart, 50000);
  ASSERT_EQ(sent.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(sent[i].stamp, static_cast<Stamp>(i + 1));
    EXPECT_EQ(sent[i].data.size(), 50000u);
  }
}

TEST(SendQueue, WithoutALimitTheOldestGivesWayInAFullQueue) {
  SendQueue queue(options_of(0.0));
  std::vector<Stamp> dropped;
  for (Stamp stamp = 1; stamp <= 7; ++stamp) {
    for (const QueuedFrame& gone : queue.offer(whole(stamp), kQueueStart))
      dropped.push_back(gone.stamp);
  }
  EXPECT_EQ(dropped, (std::vector<Stamp>{1, 2}));
  EXPECT_EQ(queue.waiting(), 5u);
}

TEST(SendQueue, AnyTwoSecondsKeepToTheBandwidthAndUseIt) {
  constexpr double kBandwidth = 25000.0;
  std::mt19937 random(3);
  SendQueue queue(options_of(kBandwidth));
  std::deque<std::pair<SteadyTime, double>> window;
  double in_window = 0.0;
  double total = 0.0;
  Stamp stamp = 1;
  const auto count = [&](SteadyTime now, double bytes) {
    window.emplace_back(now, bytes);
    in_window += bytes;
    total += bytes;
    while (window.front().first <= now - from_seconds(2.0)) {
      in_window -= window.front().second;
      window.pop_front();
    }
    ASSERT_LE(in_window, 2.0 * kBandwidth) << to_seconds(now - kQueueStart) << " s";
  };
  SteadyTime now = kQueueStart;
  for (; now < kQueueStart + from_seconds(60.0); now += 3 * kMillisecond) {
    if (queue.link_state(now).has_room) {  // as the exchange does: a preview, then the frame
      queue.spent(2300, now);
      count(now, 2300.0);
      queue.offer(whole(stamp++), now);
    }
    for (const SendOrder& order : pump(queue, now, 3000 + random() % 20000)) {
      count(now, static_cast<double>(
                     encoded_message_bytes(order.frame_id.size(), order.data.size()) + 4));
    }
    if (HasFatalFailure()) return;
  }
  EXPECT_GT(total, 0.8 * kBandwidth * to_seconds(now - kQueueStart));
}

TEST(SendQueue, ALimitedFrameComesInChunksThatMakeItAgain) {
  SendQueue queue(options_of(20000.0));
  queue.offer(whole(7), kQueueStart);
  const auto order = queue.next_to_encode(kQueueStart);
  ASSERT_TRUE(order);
  Bytes data(9001);
  for (std::size_t i = 0; i < data.size(); ++i) data[i] = static_cast<std::uint8_t>(i * 7);
  queue.encoded(*order, data, kQueueStart);
  FrameAssembler assembler;
  std::optional<FrameAssembler::Frame> frame;
  for (SteadyTime now = kQueueStart; now < kQueueStart + from_seconds(2.0) && !frame;
       now += kMillisecond) {
    while (const auto message = queue.next_to_send(now)) {
      ASSERT_TRUE(is_chunk(message->data));
      const Result<FrameChunk> chunk = parse_chunk(message->data);
      ASSERT_TRUE(chunk) << chunk.reason();
      frame = assembler.add(message->stamp, message->frame_id, *chunk, message->data.size());
    }
  }
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->data, data);
  EXPECT_EQ(frame->frame_id, "camera");
}

TEST(SendQueue, WithALimitOnlyTheNewestWaitsAndIsEncodedLate) {
  SendQueue queue(options_of(20000.0));
  queue.offer(whole(1), kQueueStart);
  pump(queue, kQueueStart, 30000);  // on the air for a while
  std::vector<Stamp> dropped;
  for (Stamp stamp = 2; stamp <= 9; ++stamp) {
    for (const QueuedFrame& gone : queue.offer(whole(stamp), kQueueStart))
      dropped.push_back(gone.stamp);
  }
  EXPECT_EQ(dropped.size(), 7u);
  EXPECT_FALSE(queue.next_to_encode(kQueueStart)) << "the radio is busy";
  EXPECT_FALSE(queue.link_state(kQueueStart).has_room);
  EXPECT_NEAR(queue.backlog(kQueueStart), 30000.0 / 18000.0, 0.3);
  SteadyTime now = kQueueStart;
  std::vector<SendOrder> sent;
  while (queue.waiting() > 0 && now < kQueueStart + from_seconds(5.0)) {
    now += 10 * kMillisecond;
    pump(queue, now, 1000);
  }
  EXPECT_LT(now, kQueueStart + from_seconds(2.5));
}

TEST(SendQueue, WholeAndSparseFramesTakeTurns) {
  SendQueue queue(options_of(20000.0));
  std::vector<Stamp> encoded;
  Stamp stamp = 1;
  for (SteadyTime now = kQueueStart; now < kQueueStart + from_seconds(10.0);
       now += 10 * kMillisecond) {
    queue.offer(whole(2 * stamp), now);
    queue.offer(sparse(2 * stamp + 1, 1), now);
    ++stamp;
    if (const auto order = queue.next_to_encode(now)) {
      encoded.push_back(order->frame.stamp);
      queue.encoded(*order, Bytes(4000), now);
    }
    while (queue.next_to_send(now)) {
    }
  }
  ASSERT_GT(encoded.size(), 20u);
  for (std::size_t i = 1; i < encoded.size(); ++i) {
    EXPECT_NE(encoded[i] % 2, encoded[i - 1] % 2) << "frame " << i;
  }
}

TEST(SendQueue, TheLimitOfAFrameLeavesRoomForTheExchange) {
  SendQueueOptions options = options_of(20000.0);
  options.frame_rate = 2.0;
  SendQueue queue(options);
  std::size_t limit = 0;
  for (int i = 0; i < 30; ++i) {
    const SteadyTime now = kQueueStart + i * from_seconds(2.0);
    queue.spent(2300, now);
    queue.offer(whole(i + 1), now);
    const auto order = queue.next_to_encode(now + from_seconds(1.0));
    ASSERT_TRUE(order);
    limit = order->limit;
    queue.encoded(*order, Bytes(1000), now);
    while (queue.next_to_send(now + from_seconds(1.0))) {
    }
  }
  EXPECT_LT(limit, 9000u - 2300u);
  EXPECT_GT(limit, 9000u - 2300u - 700u);
}

TEST(SendQueue, ASparseFrameWaitsForTheReceiptOfItsReference) {
  SendQueue queue(options_of(0.0));
  queue.offer(sparse(10, 5), kQueueStart);
  EXPECT_EQ(pump(queue, kQueueStart).size(), 1u)
      << "a station that never sent a receipt is not asked";

  queue.receipt("a", {1, 2}, {}, 2, kQueueStart);
  queue.receipt("b", {}, {}, 10, kQueueStart);
  queue.offer(sparse(11, 6), kQueueStart);
  EXPECT_TRUE(pump(queue, kQueueStart).empty());
  queue.receipt("a", {2, 6}, {}, 6, kQueueStart + kMillisecond);
  const auto sent = pump(queue, kQueueStart + kMillisecond);
  ASSERT_EQ(sent.size(), 1u);
  EXPECT_EQ(sent[0].data[0], 1) << "still sparse";
}

TEST(SendQueue, AFrameWhoseReferenceIsNotAcknowledgedGoesOutWhole) {
  SendQueue queue(options_of(0.0));
  queue.receipt("station", {}, {}, 0, kQueueStart);
  queue.offer(sparse(10, 5), kQueueStart);
  EXPECT_TRUE(pump(queue, kQueueStart).empty());
  queue.receipt("a", {}, {}, 0, kQueueStart + from_seconds(1.9));
  EXPECT_TRUE(pump(queue, kQueueStart + from_seconds(1.9)).empty());
  const auto sent = pump(queue, kQueueStart + from_seconds(2.0));
  ASSERT_EQ(sent.size(), 1u);
  EXPECT_EQ(sent[0].data[0], 2);
}

TEST(SendQueue, WithoutReceiptsAnyMoreFramesAreNotHeldBack) {
  SendQueue queue(options_of(0.0));
  queue.receipt("a", {1}, {}, 1, kQueueStart);
  queue.offer(sparse(10, 5), kQueueStart + from_seconds(3.5));
  EXPECT_EQ(pump(queue, kQueueStart + from_seconds(3.5)).size(), 1u);
}

TEST(SendQueue, AWholeFrameIsRepeatedWhenAskedForButNotAtWill) {
  SendQueue queue(options_of(0.0));
  queue.offer(whole(1), kQueueStart);
  const Bytes first = pump(queue, kQueueStart)[0].data;
  queue.receipt("b", {}, {1}, 0, kQueueStart);
  const auto again = pump(queue, kQueueStart);
  ASSERT_EQ(again.size(), 1u);
  EXPECT_EQ(again[0].data, first);
  EXPECT_EQ(again[0].stamp, 1);
  for (int i = 0; i < 100; ++i)
    queue.receipt("b", {}, {1, 1, 1}, 0, kQueueStart + i * kMillisecond);
  EXPECT_TRUE(pump(queue, kQueueStart).empty()) << "not within the period";
  queue.receipt("b", {}, {77}, 0, kQueueStart + from_seconds(5.0));
  EXPECT_TRUE(pump(queue, kQueueStart + from_seconds(5.0)).empty()) << "a frame that never was";
  EXPECT_EQ(queue.repeated(), 1u);
}

TEST(SendQueue, BeginsNothingWhileFramesAreOnTheirWayUnacknowledged) {
  SendQueue queue(options_of(0.0));
  queue.receipt("b", {}, {}, 0, kQueueStart);
  queue.offer(whole(1), kQueueStart);
  pump(queue, kQueueStart);
  EXPECT_FALSE(queue.link_state(kQueueStart).has_room) << "one at a time until the radio is known";
  SteadyTime now = kQueueStart + 10 * kMillisecond;
  queue.receipt("b", {1}, {}, 1, now);
  EXPECT_EQ(queue.link_state(now).references, std::vector<Stamp>{1});
  for (Stamp stamp = 2; stamp <= 4; ++stamp) {
    EXPECT_TRUE(queue.link_state(now).has_room);
    queue.offer(whole(stamp), now);
    EXPECT_EQ(pump(queue, now).size(), 1u);
  }
  EXPECT_FALSE(queue.link_state(now).has_room);
  queue.offer(whole(5), now);
  EXPECT_TRUE(pump(queue, now).empty());
  queue.receipt("b", {1, 2}, {}, 2, now + kMillisecond);
  EXPECT_EQ(pump(queue, now + kMillisecond).size(), 1u);
}

TEST(SendQueue, LostFramesDoNotBlockTheRadioForGood) {
  SendQueue queue(options_of(0.0));
  for (Stamp stamp = 1; stamp <= 3; ++stamp) queue.offer(whole(stamp), kQueueStart);
  pump(queue, kQueueStart);
  const SteadyTime later = kQueueStart + from_seconds(4.5);
  queue.receipt("b", {}, {}, 0, later - kMillisecond);
  EXPECT_TRUE(queue.link_state(later).has_room);
}

TEST(SendQueue, ALostFrameDoesNotMakeTheRadioSeemNarrow) {
  SendQueue queue(options_of(0.0));
  SteadyTime now = kQueueStart;
  const auto send = [&](Stamp stamp, bool is_lost) {
    queue.receipt("b", {}, {}, 0, now);
    queue.offer(whole(stamp), now);
    pump(queue, now, 40000);
    now += 50 * kMillisecond;
    if (!is_lost) queue.receipt("b", {stamp}, {}, stamp, now);
  };
  for (Stamp stamp = 1; stamp <= 8; ++stamp) send(stamp, false);
  send(9, true);
  now += from_seconds(20.0);
  for (Stamp stamp = 10; stamp <= 12; ++stamp) {
    send(stamp, false);
    EXPECT_FALSE(queue.is_narrow()) << "after frame " << stamp;
  }
}

TEST(SendQueue, ANewListenerIsNotWaitedForInVain) {
  SendQueue queue(options_of(0.0));
  queue.receipt("b", {}, {}, 0, kQueueStart);
  for (Stamp stamp = 1; stamp <= 3; ++stamp) queue.offer(whole(stamp), kQueueStart);
  pump(queue, kQueueStart);
  EXPECT_FALSE(queue.link_state(kQueueStart).has_room);
  queue.listener_joined();
  EXPECT_TRUE(queue.link_state(kQueueStart).has_room);
}

// A radio of so many bytes a second, whose receipts come as soon as a frame is through.
struct SlowRadio {
  double bytes_per_second;
  std::deque<std::pair<Stamp, SteadyTime>> arrivals;  // stamp of a frame, and when it is through
  SteadyTime free_at;
  std::size_t most_under_way = 0;

  void take(const SendOrder& order, SteadyTime now) {
    free_at = std::max(free_at, now) +
              from_seconds(static_cast<double>(order.data.size()) / bytes_per_second);
    arrivals.emplace_back(order.stamp, free_at);
    most_under_way = std::max(most_under_way, arrivals.size());
  }
  void deliver(SendQueue& queue, SteadyTime now) {
    while (!arrivals.empty() && arrivals.front().second <= now) {
      queue.receipt("b", {arrivals.front().first}, {}, arrivals.front().first, now);
      arrivals.pop_front();
    }
  }
};

TEST(SendQueue, WithoutABandwidthTheReceiptsTellHowMuchFits) {
  SendQueueOptions options = options_of(0.0);
  options.frame_rate = 2.0;
  SendQueue queue(options);
  queue.receipt("b", {}, {}, 0, kQueueStart);
  SlowRadio radio{20000.0, {}, {}, 0};
  Stamp stamp = 1;
  Duration late = 0;
  int delivered = 0;
  for (SteadyTime now = kQueueStart; now < kQueueStart + from_seconds(60.0);
       now += 10 * kMillisecond) {
    radio.deliver(queue, now);
    if (queue.link_state(now).has_room) queue.offer(whole(stamp++), now);
    while (const auto order = queue.next_to_encode(now)) {
      const std::size_t least = 8000;  // depth
      const std::size_t usual = 40000;
      const std::size_t bytes = order->limit > 0 ? std::clamp(order->limit, least, usual) : usual;
      queue.encoded(*order, Bytes(bytes), now);
      while (const auto message = queue.next_to_send(now)) radio.take(*message, now);
      ++delivered;
      if (now > kQueueStart + from_seconds(20.0)) late = std::max(late, radio.free_at - now);
    }
    if (now == kQueueStart + from_seconds(20.0)) radio.most_under_way = 0;
  }
  EXPECT_LE(radio.most_under_way, 1u) << "nothing queues up in the radio";
  EXPECT_LT(to_seconds(late), 0.7) << "frames got coarser";
  EXPECT_GT(delivered, 80) << "for about the frame rate that is wished";
}

TEST(SendQueue, WhileTheRadioIsDownNextToNothingIsHandedOver) {
  SendQueue queue(options_of(0.0));
  queue.receipt("b", {}, {}, 0, kQueueStart);
  std::size_t sent = 0;
  Stamp stamp = 1;
  for (SteadyTime now = kQueueStart; now < kQueueStart + from_seconds(20.0);
       now += 100 * kMillisecond) {
    queue.offer(whole(stamp++), now);
    sent += pump(queue, now).size();
  }
  EXPECT_LE(sent, 5u);
  EXPECT_GE(sent, 2u) << "somebody may listen again";
  EXPECT_EQ(queue.waiting(), 1u) << "and the newest is next";
}

TEST(SendQueue, LearnsHowLongReceiptsOfReferencesTake) {
  SendQueue queue(options_of(0.0));
  SteadyTime now = kQueueStart;
  int whole_frames = 0;
  for (Stamp stamp = 1; stamp <= 5; ++stamp) {  // each reference takes four seconds
    queue.receipt("a", {stamp - 1}, {}, stamp - 1, now);
    queue.offer(sparse(100 + stamp, stamp), now);
    for (int i = 0; i < 40; ++i) {
      now += from_seconds(0.1);
      if (i % 10 == 0) queue.receipt("a", {stamp - 1}, {}, stamp - 1, now);
      for (const SendOrder& order : pump(queue, now)) {
        whole_frames += order.data[0] == 2 ? 1 : 0;
        queue.receipt("b", {}, {}, order.stamp, now);
      }
    }
  }
  EXPECT_EQ(whole_frames, 1) << "the first, before this was known";
}

TEST(SendQueue, WithoutReceiptsWhatWasSentCanBeReferredTo) {
  SendQueue queue(options_of(0.0));
  for (Stamp stamp = 1; stamp <= 3; ++stamp) queue.offer(whole(stamp), kQueueStart);
  pump(queue, kQueueStart);
  EXPECT_EQ(queue.link_state(kQueueStart).references, (std::vector<Stamp>{2, 3}));
}

TEST(SendQueue, WhereReceiptsAreNotWaitedForTheyChangeNothing) {
  SendQueueOptions options = options_of(0.0);
  options.receipt_timeout = 0;
  SendQueue queue(options);
  for (Stamp stamp = 1; stamp <= 20; ++stamp) {
    const SteadyTime now = kQueueStart + from_seconds(2.0 * static_cast<double>(stamp));
    queue.offer(whole(stamp), now);
    queue.offer(sparse(100 + stamp, 7), now);
    const auto sent = pump(queue, now, 40000);
    ASSERT_EQ(sent.size(), 2u);
    EXPECT_EQ(sent[1].data[0], 1) << "sparse as it was";
    queue.receipt("b", {stamp}, {}, stamp, now + from_seconds(1.9));  // slow ones
    EXPECT_TRUE(queue.link_state(now + from_seconds(1.9)).has_room);
  }
  EXPECT_FALSE(queue.is_narrow());
}

TEST(SendQueue, ReceiptsOfAnybodyAndOfAnyLengthTakeNoMemory) {
  SendQueue queue(options_of(0.0));
  const std::vector<Stamp> many(100000, 42);
  for (int i = 0; i < 1000; ++i) {
    queue.receipt("robot" + std::to_string(i), many, many, 42, kQueueStart + i);
  }
  queue.receipt("b", many, many, 42, kQueueStart + 5000);
  EXPECT_LE(queue.link_state(kQueueStart + 6000).references.size(), 64u);
}

}  // namespace
}  // namespace rprr
