// SPDX-License-Identifier: BSD-3-Clause
// Whatever comes over the radio into the state machines behind the handlers: nothing crashes,
// memory stays, and honest messages are served afterwards as before.
#include <gtest/gtest.h>

#include <cmath>
#include <deque>
#include <limits>
#include <opencv2/core.hpp>
#include <set>

#include "mutator.hpp"
#include "rprr_codec/dhcm.hpp"
#include "rprr_eval/exchange/exchange_harness.hpp"
#include "rprr_pose/preview_protocol.hpp"
#include "rprr_pose/samples_protocol.hpp"
#include "rprr_radio/frame_chunk.hpp"
#include "rprr_radio/send_queue.hpp"
#include "rprr_redundancy/outgoing.hpp"
#include "rprr_station/station.hpp"
#include "rprr_wire/bytes.hpp"
#include "rprr_wire/camera_wire.hpp"
#include "rprr_wire/mask_wire.hpp"
#include "synthetic_walk.hpp"

namespace rprr {
namespace {

constexpr std::size_t kMoreMemory = std::size_t{16} << 20;
constexpr Duration kTick = from_seconds(0.02);

// Calls once(now) so often; in the second half the process must not grow.
template <typename Once>
void bombard(int times, const Once& once) {
  std::size_t before = 0;
  SteadyTime now = steady_seconds(100.0);
  for (int i = 0; i < times; ++i) {
    if (i == times / 2) before = resident_bytes();
    once(now += kTick);
  }
  EXPECT_LE(resident_bytes(), before + kMoreMemory) << "memory grows with messages";
}

// The station.

// Any payload is an image: colour codecs have tests of their own.
class AnyColour : public ColourDecoder {
 public:
  Result<cv::Mat> decode(const std::string&, ByteView payload, cv::Size expected) override {
    if (payload.size == 0) return Error{"empty"};
    return cv::Mat(expected, CV_8UC3, cv::Scalar::all(payload.data[0]));
  }
};

const Camera kCamera{100, 76, 90, 90, 49.5, 37.5};

DepthFrame plane() {
  DepthFrame depth{cv::Mat(kCamera.height, kCamera.width, CV_16UC1, cv::Scalar(10000)), 0.0002};
  depth.counts(cv::Rect(20, 20, 30, 30)) = 8000;
  return depth;
}

Bytes whole_frame() {
  EncodedFrame frame;
  frame.camera = kCamera;
  frame.depth = DhcmEncoder().encode(plane());
  frame.colour_codec = "any";
  frame.colour = {10, 20, 30};
  return serialise(frame);
}

Bytes sparse_frame(Stamp reference_stamp) {
  EncodedFrame frame;
  frame.camera = kCamera;
  frame.sparse = true;
  frame.reference = "a";
  frame.reference_stamp = reference_stamp;
  frame.mask = BlockMask(BlockGrid(kCamera.width, kCamera.height));
  for (const int block : {0, 5, 30}) frame.mask.set(block);
  frame.depth = DhcmEncoder().encode(plane(), frame.mask);
  frame.colour_codec = "any";
  frame.colour = {1, 2, 3};
  frame.base_codec = "any";
  frame.base = {4, 5, 6};
  frame.base_reduction = 4;
  return serialise(frame);
}

std::vector<Bytes> chunks_of(const Bytes& data, std::uint16_t number, std::size_t piece) {
  std::vector<Bytes> chunks;
  const std::size_t count = (data.size() + piece - 1) / piece;
  for (std::size_t i = 0; i < count; ++i) {
    const ByteView rest = ByteView(data).from(i * piece);
    chunks.push_back(serialise(FrameChunk{number, static_cast<std::uint16_t>(i),
                                          static_cast<std::uint16_t>(count),
                                          rest.first(std::min(piece, rest.size))}));
  }
  return chunks;
}

TEST(HostileRadio, TheStationServesWhoIsHonest) {
  StationOptions options;
  options.robots = {"a", "b"};
  options.largest_image = 200 * 200;
  options.largest_message = 1 << 16;
  Station station(options, std::make_unique<AnyColour>());
  Mutator mutator(1);
  std::vector<Bytes> good = chunks_of(whole_frame(), 3, 60);
  good.push_back(whole_frame());
  for (Stamp stamp = 1000; stamp < 1004; ++stamp) good.push_back(sparse_frame(stamp));
  const std::vector<std::string> names = {"a", "b", "b", "c", "", std::string(500, 'x')};
  std::size_t rebuilt = 0;
  bombard(80000, [&](SteadyTime now) {
    const Bytes data = mutator.mutate(mutator.one_of(good));
    const StationOutput output = station.receive(
        {mutator.one_of(names), mutator.stamp(), mutator.one_of(names), 7, data}, now);
    rebuilt += output.frames.size();
    EXPECT_LE(output.frames.size(), 1 + 2 * options.waiting);
    EXPECT_LE(station.waiting(), 2 * options.waiting);
    EXPECT_LE(station.held("a").size(), options.references_held);
    for (const RebuiltFrame& frame : output.frames) {
      EXPECT_EQ(frame.bgr.size(), frame.depth.counts.size());
      EXPECT_LE(frame.bgr.total(), options.largest_image);
      EXPECT_TRUE(frame.b_from_a.matrix().allFinite());
    }
  });
  EXPECT_GT(rebuilt, 100u) << "some of it got far";
  const SteadyTime now = steady_seconds(10000.0);
  const Bytes whole = whole_frame();
  const Bytes sparse = sparse_frame(5000);
  const StationOutput first = station.receive({"a", 5000, "f", 1, whole}, now);
  const StationOutput second = station.receive({"b", 5001, "f", 1, sparse}, now);
  ASSERT_EQ(first.frames.size(), 1u);
  ASSERT_EQ(second.frames.size(), 1u);
  EXPECT_EQ(cv::norm(first.frames[0].depth.counts, plane().counts, cv::NORM_INF), 0.0);
}

TEST(HostileRadio, ChunksTakeBoundedMemory) {
  constexpr std::size_t kLargest = 1 << 16;
  FrameAssembler assembler(kLargest);
  Mutator mutator(2);
  const Bytes piece(3000, 7);
  bombard(100000, [&](SteadyTime) {
    FrameChunk chunk;
    chunk.frame = static_cast<std::uint16_t>(mutator.below(5));
    chunk.count =
        mutator.once_in(4) ? kMostChunks : static_cast<std::uint16_t>(1 + mutator.below(9));
    chunk.index = static_cast<std::uint16_t>(mutator.below(chunk.count));
    chunk.piece = ByteView(piece).first(1 + mutator.below(piece.size()));
    const Bytes data = mutator.mutate(serialise(chunk));
    const Result<FrameChunk> parsed = parse_chunk(data);
    if (!parsed) return;
    EXPECT_GT(parsed->count, parsed->index);
    const auto frame =
        assembler.add(mutator.stamp(), std::string(mutator.below(40), 'f'), *parsed, data.size());
    if (frame) {
      EXPECT_LE(frame->data.size(), kLargest);
    }
  });
  const Bytes honest = whole_frame();
  std::optional<FrameAssembler::Frame> frame;
  for (const Bytes& chunk : chunks_of(honest, 77, 50)) {
    frame = assembler.add(999, "f", *parse_chunk(chunk), chunk.size());
  }
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->data, honest);
}

// The robots' sides.

RgbdFramePtr frame_of(int number, Stamp stamp, const std::string& robot) {
  static const WalkFrame seen[] = {walk_frame(0, 160, 120), walk_frame(1, 160, 120)};
  auto frame = std::make_shared<RgbdFrame>();
  frame->stamp = stamp;
  frame->frame_id = robot + "_rgb_optical_frame";
  frame->camera = rounded_for_wire(example_sensor_a(160, 120).camera);
  frame->depth = seen[number].image.depth;
  frame->bgr = seen[number].image.bgr;
  return frame;
}

struct Roles {
  std::unique_ptr<ExchangeRole> a, b;
};

Roles preview_roles() {
  PreviewOptions options;
  options.reference_age = 0;
  return {make_preview_reference("a", "b", options), make_preview_dependent("b", "a", options)};
}
Roles samples_roles() {
  SamplesOptions options;
  options.max_iterations = 50;
  options.step_timeout = from_seconds(0.5);
  return {make_samples_reference("a", "b", options), make_samples_dependent("b", "a", options)};
}

// Both roles; what they say may be changed on the way, and is kept.
class Exchange {
 public:
  explicit Exchange(Roles roles) : roles_(std::move(roles)) {}

  /// Both see something, and say what they say; mutator: null for an honest channel.
  void run(SteadyTime now, Mutator* mutator) {
    const Stamp stamp = ++stamp_;
    act(
        *roles_.a,
        [&](ExchangeRole& role, RoleOutput& out) { role.offer(frame_of(0, stamp, "a"), now, out); },
        true, mutator, now);
    act(
        *roles_.b,
        [&](ExchangeRole& role, RoleOutput& out) { role.offer(frame_of(1, stamp, "b"), now, out); },
        false, mutator, now);
    for (int i = 0; i < 200 && !messages_.empty(); ++i) {
      const auto [message, from_a] = messages_.front();
      messages_.pop_front();
      act(
          from_a ? *roles_.b : *roles_.a,
          [&, said = &message, from_a = from_a](ExchangeRole& role, RoleOutput& out) {
            role.receive(from_a ? "a" : "b", *said, now, out);
          },
          !from_a, mutator, now);
    }
    messages_.clear();
    for (const bool at_a : {true, false}) {
      act(
          at_a ? *roles_.a : *roles_.b,
          [&](ExchangeRole& role, RoleOutput& out) { role.tick(now + from_seconds(10.0), out); },
          at_a, mutator, now);
    }
  }

  int accepted = 0;   // sparse decisions of b
  int decisions = 0;  // of b
  int problems = 0;

 private:
  template <typename Action>
  void act(ExchangeRole& role, const Action& action, bool at_a, Mutator* mutator, SteadyTime) {
    RoleOutput out;
    action(role, out);
    problems += static_cast<int>(out.problems.size());
    for (const FrameDecision& decision : out.decisions) {
      using Kind = FrameDecision::Action;
      const bool sparse = decision.action == Kind::kSendSparse;
      if (sparse || decision.action == Kind::kPredict) {
        EXPECT_TRUE(is_rigid(decision.pose.b_from_a));
        EXPECT_TRUE(decision.pose.covariance.allFinite());
      }
      if (at_a) continue;
      ++decisions;
      accepted += sparse ? 1 : 0;
    }
    for (PoseMessage& message : out.send) {
      if (mutator != nullptr) {
        for (std::size_t copies = mutator->below(3); copies > 0; --copies) {
          messages_.emplace_back(spoilt(message, *mutator), at_a);
        }
        if (mutator->once_in(2)) continue;
      }
      messages_.emplace_back(std::move(message), at_a);
    }
  }

  static PoseMessage spoilt(PoseMessage message, Mutator& mutator) {
    const auto spoil = [&mutator](auto& any) {
      if (mutator.once_in(4)) any.stamp = mutator.stamp();
      if (mutator.once_in(4)) any.exchange += static_cast<std::uint32_t>(mutator.below(3)) - 1;
      using Message = std::decay_t<decltype(any)>;
      if constexpr (std::is_same_v<Message, RelativePoseMessage>) {
        spoil_pose(any, mutator);
      } else {
        any.data = mutator.mutate(any.data);
      }
    };
    std::visit(spoil, message);
    return message;
  }
  static void spoil_pose(RelativePoseMessage& pose, Mutator& mutator) {
    pose.reference_camera = mutator.mutate(pose.reference_camera);
    const double numbers[] = {std::numeric_limits<double>::quiet_NaN(),
                              std::numeric_limits<double>::infinity(), 1e300, -5.0, 0.0};
    pose.verdict = {static_cast<PoseStatus>(mutator.below(14)),
                    static_cast<PoseQuantity>(mutator.below(256)),
                    mutator.once_in(2) ? std::nanf("") : -1e30f,
                    mutator.once_in(2) ? std::numeric_limits<float>::infinity() : 0.0f};
    if (mutator.once_in(2)) {
      pose.b_from_a.matrix()(static_cast<int>(mutator.below(3)),
                             static_cast<int>(mutator.below(4))) = numbers[mutator.below(5)];
    }
    if (mutator.once_in(2)) pose.covariance(2, 3) = numbers[mutator.below(5)];
  }

  Roles roles_;
  Stamp stamp_ = 1000;
  std::deque<std::pair<PoseMessage, bool>> messages_;  // and whether a said it
};

void expect_service_after(Roles roles, int exchanges) {
  Exchange exchange(std::move(roles));
  Mutator mutator(3);
  SteadyTime now;
  bombard(exchanges, [&](SteadyTime) { exchange.run(now += from_seconds(20.0), &mutator); });
  EXPECT_GT(exchange.problems, 0) << "nothing was refused";
  exchange.accepted = exchange.decisions = 0;
  for (int i = 0; i < 3; ++i) exchange.run(now += from_seconds(20.0), nullptr);
  EXPECT_GE(exchange.accepted, 1) << "honest exchanges are not accepted any more, of "
                                  << exchange.decisions;
}

TEST(HostileRadio, RolesOfPreviewsServeWhoIsHonest) {
  expect_service_after(preview_roles(), 500);
}

TEST(HostileRadio, RolesOfSamplesServeWhoIsHonest) {
  expect_service_after(samples_roles(), 500);
}

TEST(HostileRadio, EveryFrameOfBIsDecidedOnce) {
  const BlockGrid grid(160, 120);
  OutgoingOptions options;
  Outgoing outgoing("b", options);
  Mutator mutator(4);
  BlockMask some(grid);
  some.set(3);
  some.set(40);
  const Bytes good = encode_mask_pair({some, some});
  const std::vector<std::string> names = {"b", "b", "b", "a", ""};
  std::multiset<Stamp> decided;
  Stamp frame = 0;
  const auto take = [&](const std::vector<OutgoingDecision>& decisions) {
    for (const OutgoingDecision& decision : decisions) decided.insert(decision.stamp);
  };
  bombard(60000, [&](SteadyTime now) {
    if (mutator.once_in(4)) {
      ++frame;
      take(outgoing.accepted(frame, "a", static_cast<std::uint32_t>(frame), BlockMask(grid), now));
    }
    PredictionMessage message;
    message.sender = "a";
    message.receiver = mutator.one_of(names);
    message.stamp =
        mutator.once_in(3) ? mutator.stamp() : frame + static_cast<Stamp>(mutator.below(2));
    message.exchange =
        static_cast<std::uint32_t>(frame) + static_cast<std::uint32_t>(mutator.below(2));
    const Bytes mask = mutator.mutate(mutator.once_in(50) ? Bytes(options.largest_mask + 1) : good);
    message.mask = mask;
    take(outgoing.prediction(message, now));
    take(outgoing.tick(now));
    EXPECT_LE(outgoing.waiting(), options.waiting);
    EXPECT_LE(outgoing.early_predictions(), options.early_predictions);
  });
  take(outgoing.tick(steady_seconds(1e6)));
  EXPECT_EQ(decided.size(), static_cast<std::size_t>(frame));
  EXPECT_EQ(std::set<Stamp>(decided.begin(), decided.end()).size(), decided.size());
}

TEST(HostileRadio, ReceiptsOfAnybodyLeaveTheQueueAlone) {
  SendQueueOptions options;
  options.robot = "b";
  SendQueue queue(options);
  Mutator mutator(5);
  const std::vector<std::string> names = {"a", "b", "c", "", std::string(1000, 'x')};
  Stamp stamp = 1000;
  bombard(20000, [&](SteadyTime now) {
    queue.receipt(mutator.one_of(names), mutator.stamps(200), mutator.stamps(200), mutator.stamp(),
                  now);
    if (mutator.once_in(5)) {
      QueuedFrame frame;
      frame.stamp = ++stamp;
      frame.sparse = mutator.once_in(2);
      frame.reference = "a";
      frame.reference_stamp = mutator.stamp();
      queue.offer(std::move(frame), now);
    }
    EXPECT_LE(queue.waiting(), options.waiting);
    while (const auto order = queue.next_to_encode(now)) queue.encoded(*order, Bytes(2000), now);
    for (int i = 0; i < 20 && queue.next_to_send(now); ++i) {
    }
    EXPECT_TRUE(std::isfinite(queue.backlog(now)));
    EXPECT_LE(queue.link_state(now).references.size(), 64u);
  });
  // A frame of its own goes out in the end.
  const SteadyTime later = steady_seconds(1e6);
  QueuedFrame frame;
  frame.stamp = ++stamp;
  queue.receipt("b", {}, {}, 0, later);
  queue.offer(frame, later);
  const auto order = queue.next_to_encode(later);
  ASSERT_TRUE(order);
  queue.encoded(*order, Bytes(100), later);
  EXPECT_TRUE(queue.next_to_send(later));
}

}  // namespace
}  // namespace rprr
