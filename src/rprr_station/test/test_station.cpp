// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_station/station.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <opencv2/core.hpp>
#include <random>

#include "rprr_codec/dhcm.hpp"
#include "rprr_geometry/block_mask.hpp"
#include "rprr_radio/frame_chunk.hpp"
#include "rprr_wire/bytes.hpp"

namespace rprr {
namespace {

const Camera kStationCamera{100, 76, 90, 90, 49.5, 37.5};  // partial blocks both ways
constexpr Duration kPatience = from_seconds(1.0);

// Colour payloads that are the image itself: this is no test of colour codecs.
class RawColour : public ColourDecoder {
 public:
  Result<cv::Mat> decode(const std::string& codec, ByteView payload, cv::Size expected) override {
    const auto bytes = static_cast<std::size_t>(expected.area()) * 3;
    if (codec != "raw" || payload.size != bytes) return Error{"not a raw image"};
    cv::Mat image(expected, CV_8UC3);
    std::copy(payload.data, payload.data + bytes, image.ptr<std::uint8_t>());
    return image;
  }
};

Bytes raw(const cv::Mat& bgr) {
  return {bgr.ptr<std::uint8_t>(), bgr.ptr<std::uint8_t>() + bgr.total() * 3};
}

DepthFrame noisy_plane(unsigned seed) {
  DepthFrame depth{cv::Mat(kStationCamera.height, kStationCamera.width, CV_16UC1), 0.0002};
  std::mt19937 random(seed);
  for (int i = 0; i < kStationCamera.width * kStationCamera.height; ++i) {
    depth.counts.ptr<std::uint16_t>()[i] = static_cast<std::uint16_t>(10000 + random() % 7);
  }
  return depth;
}

cv::Mat plain(int blue) {
  return cv::Mat(kStationCamera.height, kStationCamera.width, CV_8UC3, cv::Scalar(blue, 100, 200));
}

EncodedFrame whole_frame(int blue = 10) {
  EncodedFrame frame;
  frame.camera = kStationCamera;
  frame.depth = DhcmEncoder().encode(noisy_plane(1));
  frame.colour_codec = "raw";
  frame.colour = raw(plain(blue));
  return frame;
}

BlockMask some_blocks() {
  BlockMask mask(BlockGrid(kStationCamera.width, kStationCamera.height));
  for (const int block : {0, 5, 30, mask.grid().count() - 1}) mask.set(block);
  return mask;
}

EncodedFrame sparse_frame(Stamp reference_stamp, const std::string& reference = "a") {
  EncodedFrame frame;
  frame.camera = kStationCamera;
  frame.sparse = true;
  frame.reference = reference;
  frame.reference_stamp = reference_stamp;
  frame.mask = some_blocks();
  frame.depth = DhcmEncoder().encode(noisy_plane(2), frame.mask);
  frame.colour_codec = "raw";
  frame.colour = raw(plain(50));
  frame.report.bytes_pose = 4000;
  frame.report.bytes_masks = 150;
  return frame;
}

class StationTest : public testing::Test {
 protected:
  static StationOptions options() {
    StationOptions options;
    options.robots = {"a", "b", "c"};
    options.references_held = 2;
    options.waiting = 2;
    options.wait_for_reference = kPatience;
    options.largest_image = 200 * 200;
    return options;
  }
  StationOutput receive(const std::string& robot, Stamp stamp, const Bytes& bytes,
                        SteadyTime now = {}) {
    return station.receive({robot, stamp, robot + "_frame", 3, bytes}, now);
  }
  StationOutput receive(const std::string& robot, Stamp stamp, const EncodedFrame& frame,
                        SteadyTime now = {}) {
    return receive(robot, stamp, serialise(frame), now);
  }
  void expect_refused(const StationOutput& output) {
    EXPECT_TRUE(output.frames.empty());
    ASSERT_EQ(output.errors.size(), 1u);
    EXPECT_FALSE(output.errors[0].reason.empty());
  }
  Station station{options(), std::make_unique<RawColour>()};
};

TEST_F(StationTest, WholeFrameComesOutAsItIs) {
  const StationOutput output = receive("a", 100, whole_frame());
  ASSERT_EQ(output.frames.size(), 1u);
  const RebuiltFrame& frame = output.frames[0];
  EXPECT_FALSE(frame.sparse);
  EXPECT_EQ(frame.robot, "a");
  EXPECT_EQ(frame.stamp, 100);
  EXPECT_EQ(frame.exchange, 3u);
  EXPECT_EQ(cv::norm(frame.depth.counts, noisy_plane(1).counts, cv::NORM_INF), 0);
  EXPECT_EQ(cv::norm(frame.bgr, plain(10), cv::NORM_INF), 0);
  EXPECT_EQ(frame.share_received, 1.0);
  EXPECT_EQ(frame.blocks_sent, frame.blocks_total);
  EXPECT_EQ(station.held("a"), std::vector<Stamp>{100});
}

TEST_F(StationTest, SparseFrameIsReceivedBlocksOverThePrediction) {
  receive("a", 100, whole_frame());
  const StationOutput output = receive("b", 200, sparse_frame(100));
  ASSERT_EQ(output.frames.size(), 1u);
  const RebuiltFrame& frame = output.frames[0];
  EXPECT_TRUE(frame.sparse);
  EXPECT_EQ(frame.reference, "a");
  EXPECT_EQ(frame.depth.unit, 0.0002);
  const BlockMask mask = some_blocks();
  for (int block = 0; block < mask.grid().count(); ++block) {
    const cv::Rect rect = mask.grid().rect(block);
    const DepthFrame expected = noisy_plane(mask[block] ? 2 : 1);
    EXPECT_EQ(cv::norm(frame.depth.counts(rect), expected.counts(rect), cv::NORM_INF), 0)
        << (mask[block] ? "received depth is bit-exact" : "under the identity, so is predicted");
    EXPECT_EQ(frame.bgr(rect).at<cv::Vec3b>(0, 0)[0], mask[block] ? 50 : 10);
    EXPECT_EQ(frame.provenance(rect).at<std::uint8_t>(0, 0), mask[block] ? kReceived : kPredicted);
  }
  EXPECT_EQ(frame.blocks_sent, 4);
  EXPECT_NEAR(frame.share_received + frame.share_predicted, 1.0, 1e-9);
}

// A prediction in another light, a base in the right one, received blocks in between.
TEST_F(StationTest, TheBaseGivesThePredictionItsLightAndLeavesReceivedBlocksAlone) {
  receive("a", 100, whole_frame(60));
  EncodedFrame sparse = sparse_frame(100);
  sparse.base_codec = "raw";
  sparse.base_reduction = 4;
  sparse.base_noise = 1.0f;
  sparse.base = raw(cv::Mat(19, 25, CV_8UC3, cv::Scalar(90, 100, 200)));
  const StationOutput output = receive("b", 200, sparse);
  ASSERT_EQ(output.frames.size(), 1u);
  const RebuiltFrame& frame = output.frames[0];
  const BlockMask mask = some_blocks();
  for (int block = 0; block < mask.grid().count(); ++block) {
    const cv::Rect rect = mask.grid().rect(block);
    const int blue = frame.bgr(rect).at<cv::Vec3b>(0, 0)[0];
    if (mask[block]) {
      EXPECT_EQ(blue, 50) << "received, not altered";
    } else {
      EXPECT_NEAR(blue, 90, 1);
    }
    EXPECT_EQ(frame.provenance(rect).at<std::uint8_t>(0, 0), mask[block] ? kReceived : kPredicted);
  }
  EXPECT_EQ(frame.share_base, 0.0);
}

TEST_F(StationTest, WithoutDetailAllColourIsPredictionAndBase) {
  receive("a", 100, whole_frame(60));
  EncodedFrame sparse = sparse_frame(100);
  sparse.colour.clear();
  sparse.base_codec = "raw";
  sparse.base_reduction = 1;
  sparse.base_noise = 1.0f;
  sparse.base = raw(plain(90));
  const StationOutput output = receive("b", 200, sparse);
  ASSERT_EQ(output.frames.size(), 1u);
  const RebuiltFrame& frame = output.frames[0];
  EXPECT_LE(cv::norm(frame.bgr, plain(90), cv::NORM_INF), 1);
  EXPECT_EQ(cv::countNonZero(frame.provenance >= kReceivedColour), 0);
  const cv::Rect sent = some_blocks().grid().rect(5);
  EXPECT_EQ(cv::countNonZero(frame.provenance(sent) != kReceivedDepth), 0);
  EXPECT_EQ(cv::norm(frame.depth.counts(sent), noisy_plane(2).counts(sent), cv::NORM_INF), 0);
}

TEST_F(StationTest, EveryByteIsCountedOnce) {
  receive("a", 100, whole_frame());
  const Bytes bytes = serialise(sparse_frame(100));
  const RebuiltFrame frame = receive("b", 200, bytes).frames.at(0);
  EXPECT_EQ(frame.bytes_total, encoded_message_bytes(7, bytes.size()) + 4000 + 150);
  EXPECT_EQ(frame.bytes_total, frame.report.bytes_pose + frame.bytes_masks + frame.sizes.depth +
                                   frame.sizes.colour + frame.sizes.base + frame.bytes_extras);
  EXPECT_EQ(frame.bytes_masks, frame.sizes.mask + 150);
}

TEST_F(StationTest, SparseMayComeBeforeItsReference) {
  EXPECT_TRUE(receive("b", 200, sparse_frame(100)).frames.empty());
  EXPECT_EQ(station.waiting(), 1u);
  EXPECT_TRUE(receive("b", 200, sparse_frame(100)).errors.empty()) << "repeated";
  EXPECT_EQ(station.waiting(), 1u);
  const StationOutput output = receive("a", 100, whole_frame());
  ASSERT_EQ(output.frames.size(), 2u);
  EXPECT_EQ(output.frames[0].robot, "a");
  EXPECT_EQ(output.frames[1].robot, "b");
  EXPECT_EQ(station.waiting(), 0u);
}

TEST_F(StationTest, AFrameMayComeInChunksInAnyOrder) {
  const Bytes bytes = serialise(whole_frame());
  constexpr std::size_t kPiece = 1000;
  const auto count = static_cast<std::uint16_t>((bytes.size() + kPiece - 1) / kPiece);
  std::size_t message_bytes = 0;
  for (std::uint16_t i = count; i-- > 0;) {
    const ByteView rest = ByteView(bytes).from(i * kPiece);
    const Bytes chunk = serialise(FrameChunk{7, i, count, rest.first(std::min(rest.size, kPiece))});
    ReceivedMessage message{"a", 100, i == 0 ? "camera" : "", 3, chunk, 0};
    message_bytes += encoded_message_bytes(message.frame_id.size(), chunk.size());
    const StationOutput output = station.receive(message, {});
    EXPECT_TRUE(output.errors.empty());
    EXPECT_EQ(station.last("a"), i == 0 ? 100 : 0);
    ASSERT_EQ(output.frames.size(), i == 0 ? 1u : 0u);
    if (i > 0) continue;
    EXPECT_EQ(output.frames[0].frame_id, "camera");
    EXPECT_EQ(cv::norm(output.frames[0].bgr, plain(10), cv::NORM_INF), 0);
    EXPECT_EQ(output.frames[0].bytes_total - output.frames[0].report.bytes_pose -
                  output.frames[0].report.bytes_masks,
              message_bytes)
        << "all chunks are counted";
  }
}

TEST_F(StationTest, LostChunksAreReportedAndCostTheirFrameAlone) {
  const Bytes bytes = serialise(whole_frame());
  std::size_t errors = 0;
  for (std::uint16_t number = 1; number <= 10; ++number) {
    const Bytes chunk = serialise(FrameChunk{number, 0, 2, ByteView(bytes).first(100)});
    errors += station.receive({"a", number, "camera", 3, chunk, 0}, {}).errors.size();
  }
  EXPECT_EQ(errors, 7u) << "a few may still be completed";
  EXPECT_EQ(receive("a", 100, whole_frame()).frames.size(), 1u);
}

TEST_F(StationTest, AReferenceThatIsLateIsAskedForOnceMeanwhile) {
  receive("b", 200, sparse_frame(100));
  EXPECT_TRUE(station.tick(SteadyTime(kPatience / 8)).repeats.empty()) << "it may be under way";
  const StationOutput output = station.tick(SteadyTime(kPatience / 2));
  EXPECT_TRUE(output.errors.empty());
  ASSERT_EQ(output.repeats.size(), 1u);
  EXPECT_EQ(output.repeats[0].robot, "a");
  EXPECT_EQ(output.repeats[0].stamp, 100);
  EXPECT_TRUE(station.tick(SteadyTime(kPatience / 2 + 1)).repeats.empty());
  EXPECT_EQ(receive("a", 100, whole_frame()).frames.size(), 2u) << "and then both come out";
}

TEST_F(StationTest, MissingReferenceIsGivenUpAndAskedFor) {
  receive("b", 200, sparse_frame(100));
  EXPECT_TRUE(station.tick(SteadyTime(kPatience - 1)).errors.empty());
  const StationOutput output = station.tick(SteadyTime(kPatience));
  ASSERT_EQ(output.errors.size(), 1u);
  EXPECT_EQ(output.errors[0].robot, "b");
  EXPECT_EQ(output.errors[0].stamp, 200);
  ASSERT_EQ(output.repeats.size(), 1u);
  EXPECT_EQ(output.repeats[0].robot, "a");
  EXPECT_EQ(output.repeats[0].stamp, 100);
  EXPECT_EQ(station.waiting(), 0u);
}

TEST_F(StationTest, MemoryIsBounded) {
  for (Stamp stamp = 1; stamp <= 10; ++stamp) receive("a", stamp, whole_frame());
  EXPECT_EQ(station.held("a"), (std::vector<Stamp>{9, 10}));
  receive("a", 9, whole_frame());
  EXPECT_EQ(station.held("a").size(), 2u) << "a repeated stamp takes no second place";
  std::size_t errors = 0;
  for (Stamp stamp = 1; stamp <= 10; ++stamp) {
    errors += receive("b", stamp, sparse_frame(5)).errors.size();  // gone by now
  }
  EXPECT_EQ(station.waiting(), 2u);
  EXPECT_EQ(errors, 8u);
  EXPECT_TRUE(station.held("nobody").empty());
}

TEST_F(StationTest, StrangersAreRefused) {
  expect_refused(receive("mallory", 1, whole_frame()));
  expect_refused(receive("b", 1, sparse_frame(100, "mallory")));
  EXPECT_EQ(station.waiting(), 0u);
}

TEST_F(StationTest, SizesAreCappedBeforeDecoding) {
  EncodedFrame large = whole_frame();
  large.camera.width = 201;
  large.camera.height = 200;
  expect_refused(receive("a", 1, large));
  expect_refused(receive("a", 1, Bytes((std::size_t{8} << 20) + 1, 0)));
}

TEST_F(StationTest, GarbageWithAValidChecksumIsRefused) {
  EncodedFrame colour = whole_frame();
  colour.colour.resize(10);
  expect_refused(receive("a", 1, colour));
  EncodedFrame codec = whole_frame();
  codec.colour_codec = "unheard-of";
  expect_refused(receive("a", 1, codec));
  EncodedFrame depth = whole_frame();
  depth.depth.assign(100, 0xA5);
  expect_refused(receive("a", 1, depth));
  EXPECT_TRUE(station.held("a").empty());
  std::mt19937 random(1);
  for (int trial = 0; trial < 200; ++trial) {
    Bytes noise(random() % 300);
    for (std::uint8_t& byte : noise) byte = static_cast<std::uint8_t>(random());
    seal(noise);
    expect_refused(receive("a", 1, noise));
  }
  EXPECT_EQ(receive("a", 2, whole_frame()).frames.size(), 1u) << "and life goes on";
}

// The container intact, a byte of what it holds changed, the checksum right again: whatever comes
// out is an error or a frame of the right size.
TEST_F(StationTest, ChangedBytesWithAValidChecksumAreSurvived) {
  receive("a", 100, whole_frame());
  const Bytes good = serialise(sparse_frame(100));
  std::mt19937 random(2);
  for (int trial = 0; trial < 500; ++trial) {
    Bytes bytes = good;
    bytes.resize(bytes.size() - 4);
    bytes[random() % std::min<std::size_t>(bytes.size(), 900)] ^=
        static_cast<std::uint8_t>(1 + random() % 255);
    seal(bytes);
    const StationOutput output = receive("b", 300 + trial, bytes, SteadyTime(trial * kPatience));
    for (const RebuiltFrame& frame : output.frames) {
      EXPECT_EQ(frame.bgr.size(), cv::Size(frame.camera.width, frame.camera.height));
      EXPECT_EQ(frame.depth.counts.size(), frame.bgr.size());
    }
    EXPECT_LE(station.waiting(), 2u);
  }
}

TEST_F(StationTest, EnergyFollowsTheReport) {
  EncodedFrame frame = whole_frame();
  frame.report.ms_encode = 100;
  frame.report.independent_bytes_colour = 1000;
  const RebuiltFrame rebuilt = receive("a", 1, frame).frames.at(0);
  const EnergyModel model;
  EXPECT_NEAR(rebuilt.energy_mj, energy_millijoules(model, 0, 100, rebuilt.bytes_total), 1e-6);
  EXPECT_NEAR(rebuilt.energy_independent_mj, energy_millijoules(model, 0, 100, 1000), 1e-6);
  frame.report.ms_pose = std::numeric_limits<float>::quiet_NaN();
  for (const RebuiltFrame& odd : receive("a", 2, frame).frames) {
    EXPECT_TRUE(std::isfinite(odd.energy_mj)) << "the sender's figures are untrusted";
  }
}

}  // namespace
}  // namespace rprr
