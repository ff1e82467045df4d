// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_codec/dhcm.hpp"

#include <gtest/gtest.h>

#include <random>

#include "rprr_geometry/block_mask.hpp"
#include "rprr_synthetic/coded_images.hpp"
#include "rprr_wire/bytes.hpp"

namespace rprr {
namespace {

constexpr DhcmMode kModes[] = {DhcmMode::kFast, DhcmMode::kDefault, DhcmMode::kSmall};

// The frame comes back bit by bit in all modes, and through the buffers that the frame before left
// behind.
void expect_round_trip(const DepthFrame& frame, const std::string& what) {
  static DhcmEncoder encoder;
  static DhcmDecoder decoder;
  for (const DhcmMode mode : kModes) {
    const std::string context = what + ", " + dhcm_mode_name(mode);
    encoder.set_mode(mode);
    const Bytes payload = encoder.encode(frame);
    const Result<DepthFrame> back = decoder.decode(payload);
    ASSERT_TRUE(back) << context << ": " << back.reason();
    EXPECT_TRUE(synthetic::same(back->counts, frame.counts)) << context;
    EXPECT_EQ(back->unit, frame.unit) << context;
    EXPECT_LE(payload.size(), dhcm_bound(frame.counts.size())) << context << " grew";
  }
}

void expect_round_trip(const DepthFrame& frame, const BlockMask& mask, const std::string& what) {
  static DhcmEncoder encoder;
  static DhcmDecoder decoder;
  for (const DhcmMode mode : kModes) {
    const std::string context = what + ", " + dhcm_mode_name(mode);
    encoder.set_mode(mode);
    const Result<DepthFrame> back = decoder.decode(encoder.encode(frame, mask), mask);
    ASSERT_TRUE(back) << context << ": " << back.reason();
    EXPECT_TRUE(synthetic::same(back->counts, synthetic::only(frame.counts, mask))) << context;
  }
}

TEST(Dhcm, EveryKindOfImageComesBack) {
  expect_round_trip(synthetic::kinect_like(640, 480), "kinect");
  expect_round_trip(synthetic::kinect_like(540, 360), "no multiple of eight");
  expect_round_trip(synthetic::noise(320, 240), "noise");
  expect_round_trip(synthetic::constant(640, 480, 0), "no reading anywhere");
  expect_round_trip(synthetic::constant(640, 480, 65535), "largest reading");
  expect_round_trip(synthetic::constant(640, 480, 1), "smallest reading");
  expect_round_trip(synthetic::constant(8192, 3, 1234), "widest");
  expect_round_trip(synthetic::constant(1, 8192, 1234), "highest");
}

// The one residual whose negative is itself.
TEST(Dhcm, StepsOfHalfTheRangeComeBack) {
  DepthFrame two = synthetic::constant(256, 256, 1);
  two.counts(cv::Rect(40, 30, 100, 120)).setTo(32770);  // in a table of values
  expect_round_trip(two, "two readings");
  DepthFrame slope = synthetic::constant(256, 256, 0);
  for (int v = 0; v < 256; ++v) {
    for (int u = 0; u < 256; ++u) {
      const bool far = (u / 16 + v / 16) % 2 == 1;
      slope.counts.at<std::uint16_t>(v, u) =
          static_cast<std::uint16_t>(1000 + 97 * v + u + (far ? 32768 : 0));
    }
  }
  expect_round_trip(slope, "slope");
  BlockMask mask(BlockGrid(256, 256));
  for (int block = 0; block < mask.grid().count(); ++block) mask.set(block, block % 3 != 0);
  expect_round_trip(slope, mask, "blocks of a slope");
}

TEST(Dhcm, LongRunsComeBack) {
  DepthFrame frame = synthetic::constant(1024, 300, 900);
  expect_round_trip(frame, "one surface");
  frame.counts.at<std::uint16_t>(299, 1023) = 901;
  expect_round_trip(frame, "one surface, last pixel differs");
  frame.counts.rowRange(50, 299).setTo(0);
  expect_round_trip(frame, "a long hole");
  // Runs about a power of two, where a number takes one more bit.
  for (int length = 65530; length < 65545; ++length) {
    DepthFrame two = synthetic::constant(8192, 10, 0);
    for (int i = 0; i < 8192 + length; ++i) two.counts.at<std::uint16_t>(i / 8192, i % 8192) = 7;
    expect_round_trip(two, "run of about " + std::to_string(length));
  }
}

TEST(Dhcm, TheLargestImageComesBack) {
  DepthFrame frame = synthetic::constant(8192, 8192, 4000);
  frame.counts.at<std::uint16_t>(8191, 8191) = 1;
  DhcmEncoder encoder;
  DhcmDecoder decoder;
  for (const DhcmMode mode : {DhcmMode::kFast, DhcmMode::kDefault}) {
    encoder.set_mode(mode);
    const Result<DepthFrame> back = decoder.decode(encoder.encode(frame));
    ASSERT_TRUE(back) << back.reason();
    EXPECT_TRUE(synthetic::same(back->counts, frame.counts));
  }
}

TEST(Dhcm, MoreThanHalfOfAllReadingsInOneFrameComeBack) {
  DepthFrame frame = synthetic::constant(512, 256, 0);
  for (int i = 0; i < 512 * 256; ++i) {
    frame.counts.at<std::uint16_t>(i / 512, i % 512) = static_cast<std::uint16_t>(i / 3 * 2);
  }
  expect_round_trip(frame, "ranks beyond 32767");
}

TEST(Dhcm, EverySmallSizeComesBack) {
  for (int height = 1; height <= 20; ++height) {
    for (int width = 1; width <= 20; ++width) {
      const std::string size = std::to_string(width) + "x" + std::to_string(height);
      expect_round_trip(synthetic::kinect_like(width, height), "kinect " + size);
      expect_round_trip(synthetic::noise(width, height), "noise " + size);
      const BlockGrid grid(width, height);
      const DepthFrame frame = synthetic::kinect_like(width, height, 5);
      for (int set = 0; set < (1 << grid.count()); set += 1 + grid.count() / 5) {
        BlockMask mask(grid);
        for (int block = 0; block < grid.count(); ++block) mask.set(block, (set >> block & 1) != 0);
        expect_round_trip(frame, mask, "mask " + std::to_string(set) + " of " + size);
      }
    }
  }
}

TEST(Dhcm, ExtremeValuesSideBySideComeBack) {
  std::mt19937 random(7);
  const std::uint16_t extremes[] = {0, 1, 2, 32767, 32768, 65534, 65535};
  for (int trial = 0; trial < 50; ++trial) {
    DepthFrame frame = synthetic::constant(33, 17, 0);
    for (int i = 0; i < 33 * 17; ++i) {
      frame.counts.at<std::uint16_t>(i / 33, i % 33) = extremes[random() % 7];
    }
    expect_round_trip(frame, "trial " + std::to_string(trial));
  }
}

TEST(Dhcm, AViewIntoALargerImageComesBack) {
  DepthFrame frame = synthetic::kinect_like(100, 80);
  frame.counts = frame.counts(cv::Rect(7, 5, 50, 41));
  expect_round_trip(frame, "view");
}

TEST(Dhcm, MaskedBlocksComeBackAndTheRestIsZero) {
  for (const auto& [width, height] : std::vector<std::pair<int, int>>{{640, 480}, {541, 363}}) {
    const BlockGrid grid(width, height);
    for (const DepthFrame& frame :
         {synthetic::kinect_like(width, height), synthetic::noise(width, height)}) {
      for (const double share : {0.0, 0.02, 0.3, 0.9, 1.0}) {
        expect_round_trip(frame, synthetic::some_blocks(grid, share),
                          "share " + std::to_string(share));
        expect_round_trip(frame, synthetic::region(grid, share), "region " + std::to_string(share));
      }
    }
  }
}

TEST(Dhcm, BlocksCostAboutTheirShareOfTheWholeFrame) {
  const DepthFrame frame = synthetic::kinect_like(640, 480);
  const BlockGrid grid(640, 480);
  DhcmEncoder encoder;
  const auto whole = static_cast<double>(encoder.encode(frame).size());
  const auto quarter =
      static_cast<double>(encoder.encode(frame, synthetic::region(grid, 0.25)).size());
  EXPECT_LT(quarter, 0.30 * whole + 300);
}

TEST(Dhcm, KinectLikeDepthShrinksToLessThanATenthAndFlatDepthToAlmostNothing) {
  DhcmEncoder encoder;
  EXPECT_LT(encoder.encode(synthetic::kinect_like(640, 480)).size(), 640u * 480 * 2 / 10);
  EXPECT_LT(encoder.encode(synthetic::constant(640, 480, 0)).size(), 64u);
  EXPECT_LT(encoder.encode(synthetic::constant(640, 480, 2000)).size(), 128u);
}

TEST(Dhcm, UnitsCrossAsTheyAre) {
  for (const double unit : {0.001, 0.0002, 0.5, 1e-9, 1.0 / 3.0}) {
    DepthFrame frame = synthetic::kinect_like(16, 16);
    frame.unit = unit;
    expect_round_trip(frame, "unit " + std::to_string(unit));
  }
}

TEST(Dhcm, APayloadSaysWhatItIs) {
  DhcmEncoder encoder(DhcmMode::kSmall);
  DepthFrame frame = synthetic::kinect_like(60, 44);
  frame.unit = 0.0002;
  const Result<DhcmInfo> info = dhcm_info(encoder.encode(frame));
  ASSERT_TRUE(info) << info.reason();
  EXPECT_EQ(info->version, 3);
  EXPECT_EQ(info->mode, DhcmMode::kSmall);
  EXPECT_EQ(info->pixels, DhcmPixels::kCounts);
  EXPECT_FALSE(info->masked);
  EXPECT_FALSE(info->stored);
  EXPECT_EQ(info->width, 60);
  EXPECT_EQ(info->height, 44);
  EXPECT_EQ(info->unit, 0.0002);
  encoder.set_mode(DhcmMode::kFast);
  const BlockMask mask(BlockGrid(60, 44), true);
  const Result<DhcmInfo> masked = dhcm_info(encoder.encode(frame, mask));
  ASSERT_TRUE(masked) << masked.reason();
  EXPECT_TRUE(masked->masked);
  EXPECT_EQ(masked->mode, DhcmMode::kFast);
  const Result<DhcmInfo> stored = dhcm_info(encoder.encode(synthetic::noise(30, 30)));
  ASSERT_TRUE(stored) << stored.reason();
  EXPECT_TRUE(stored->stored);
  EXPECT_FALSE(dhcm_info(Bytes{1, 2, 3}));
}

TEST(Dhcm, SmallIsNeverLargerThanDefault) {
  for (const DepthFrame& frame : {synthetic::kinect_like(60, 44), synthetic::kinect_like(320, 240),
                                  synthetic::constant(50, 50, 7), synthetic::noise(20, 20)}) {
    EXPECT_LE(DhcmEncoder(DhcmMode::kSmall).encode(frame).size(),
              DhcmEncoder(DhcmMode::kDefault).encode(frame).size());
  }
}

TEST(Dhcm, ModesHaveNames) {
  for (const DhcmMode mode : kModes) {
    const Result<DhcmMode> named = dhcm_mode_from_name(dhcm_mode_name(mode));
    ASSERT_TRUE(named);
    EXPECT_EQ(*named, mode);
  }
  EXPECT_FALSE(dhcm_mode_from_name("smaller"));
  EXPECT_FALSE(dhcm_mode_from_name(""));
}

TEST(Dhcm, MemoryIsReusedWhereItFits) {
  const DepthFrame frame = synthetic::kinect_like(64, 48);
  const Bytes payload = DhcmEncoder().encode(frame);
  DhcmDecoder decoder;
  const cv::Mat old(48, 64, CV_16UC1, cv::Scalar(7));
  const Result<DepthFrame> there = decoder.decode(payload, old.size(), old);
  ASSERT_TRUE(there) << there.reason();
  EXPECT_EQ(there->counts.data, old.data);
  EXPECT_TRUE(synthetic::same(old, frame.counts));
  const cv::Mat other(48, 64, CV_8UC1, cv::Scalar(7));
  const Result<DepthFrame> elsewhere = decoder.decode(payload, other.size(), other);
  ASSERT_TRUE(elsewhere) << elsewhere.reason();
  EXPECT_TRUE(synthetic::same(elsewhere->counts, frame.counts));
  EXPECT_EQ(cv::countNonZero(other != 7), 0);
}

TEST(Dhcm, SizesAreCheckedBeforeAnythingIsAllocated) {
  DhcmEncoder encoder;
  const DepthFrame frame = synthetic::kinect_like(64, 48);
  const Bytes payload = encoder.encode(frame);
  EXPECT_FALSE(DhcmDecoder(64 * 48 - 1).decode(payload));
  EXPECT_TRUE(DhcmDecoder(64 * 48).decode(payload));
  DhcmDecoder decoder;
  EXPECT_TRUE(decoder.decode(payload, cv::Size(64, 48)));
  EXPECT_FALSE(decoder.decode(payload, cv::Size(48, 64)));
  EXPECT_FALSE(decoder.decode(payload, BlockMask(BlockGrid(64, 48), true))) << "is not masked";
  const Bytes masked = encoder.encode(frame, BlockMask(BlockGrid(64, 48), true));
  EXPECT_FALSE(decoder.decode(masked)) << "needs its mask";
  EXPECT_FALSE(decoder.decode(masked, BlockMask(BlockGrid(64, 56), true)));
}

}  // namespace
}  // namespace rprr
