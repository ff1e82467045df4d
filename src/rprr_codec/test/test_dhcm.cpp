// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_codec/dhcm.hpp"

#include <gtest/gtest.h>

#include <random>

#include "synthetic.hpp"

namespace rprr {
namespace {

// The frame comes back bit by bit, and through the buffers that the frame before left behind.
void expect_round_trip(const DepthFrame& frame, const std::string& what) {
  static DhcmEncoder encoder;
  static DhcmDecoder decoder;
  const Bytes payload = encoder.encode(frame);
  const Result<DepthFrame> back = decoder.decode(payload);
  ASSERT_TRUE(back) << what << ": " << back.reason();
  EXPECT_TRUE(synthetic::same(back->counts, frame.counts)) << what;
  EXPECT_EQ(back->unit, frame.unit) << what;
  EXPECT_LE(payload.size(), 2 * frame.counts.total() + 64) << what << " grew";
}

void expect_round_trip(const DepthFrame& frame, const BlockMask& mask, const std::string& what) {
  static DhcmEncoder encoder;
  static DhcmDecoder decoder;
  const Result<DepthFrame> back = decoder.decode(encoder.encode(frame, mask), mask);
  ASSERT_TRUE(back) << what << ": " << back.reason();
  EXPECT_TRUE(synthetic::same(back->counts, synthetic::only(frame.counts, mask))) << what;
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

TEST(Dhcm, RunsBeyondTheLimitOfOneNumberComeBack) {
  DepthFrame frame = synthetic::constant(1024, 300, 900);
  expect_round_trip(frame, "one surface");
  frame.counts.at<std::uint16_t>(299, 1023) = 901;
  expect_round_trip(frame, "one surface, last pixel differs");
  frame.counts.rowRange(50, 299).setTo(0);
  expect_round_trip(frame, "a long hole");
  // Runs of about the limit, which is 65535.
  for (int length = 65530; length < 65545; ++length) {
    DepthFrame two = synthetic::constant(8192, 10, 0);
    for (int i = 0; i < 8192 + length; ++i) two.counts.at<std::uint16_t>(i / 8192, i % 8192) = 7;
    expect_round_trip(two, "run of about " + std::to_string(length));
  }
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

TEST(Dhcm, TheBitFormatIsPinned) {
  // Anything that changes these must change the version byte and doc/dhcm.md too.
  const auto content = [](const Bytes& payload) { return crc32(unseal(payload)); };
  DhcmEncoder encoder;
  const DepthFrame frame = synthetic::kinect_like(60, 44);
  EXPECT_EQ(content(encoder.encode(frame)), 2811983123u);
  EXPECT_EQ(content(encoder.encode(synthetic::noise(9, 9))), 2235239020u);
  EXPECT_EQ(content(encoder.encode(frame, synthetic::some_blocks(BlockGrid(60, 44), 0.4))),
            2495530508u);
}

TEST(Dhcm, ACutPayloadIsAnError) {
  DhcmEncoder encoder;
  DhcmDecoder decoder;
  for (const DepthFrame& frame : {synthetic::kinect_like(40, 30), synthetic::noise(12, 12)}) {
    const Bytes payload = encoder.encode(frame);
    for (std::size_t size = 0; size < payload.size(); ++size) {
      EXPECT_FALSE(decoder.decode(ByteView(payload).first(size))) << "cut to " << size;
      // The same with all lengths and the checksum made good: less data than pixels need.
      if (size < 18) continue;
      Bytes resealed(payload.begin(), payload.begin() + static_cast<std::ptrdiff_t>(size));
      const std::size_t head = 6 + 4 + ((payload[1] & 8) != 0 ? 8 : 4);
      if (size < head || size + 4 >= payload.size()) continue;
      for (std::size_t i = 0; i < 4; ++i) {
        resealed[6 + i] = static_cast<std::uint8_t>((size - head) >> (8 * i));
      }
      seal(resealed);
      EXPECT_FALSE(decoder.decode(resealed)) << "cut to " << size << " and sealed anew";
    }
  }
}

TEST(Dhcm, DamageIsAnErrorAndHostileBytesDoNoHarm) {
  DhcmEncoder encoder;
  DhcmDecoder decoder;
  std::mt19937 random(11);
  const BlockGrid grid(40, 30);
  const BlockMask mask = synthetic::some_blocks(grid, 0.5);
  const DepthFrame frame = synthetic::kinect_like(40, 30);
  const Bytes whole = encoder.encode(frame);
  const Bytes masked = encoder.encode(frame, mask);
  for (int trial = 0; trial < 20000; ++trial) {
    const bool use_mask = trial % 2 == 0;
    Bytes payload = use_mask ? masked : whole;
    for (std::uint32_t i = 0; i <= random() % 4; ++i) {
      payload[random() % (payload.size() - 4)] ^= static_cast<std::uint8_t>(1 + random() % 255);
    }
    if (payload == (use_mask ? masked : whole)) continue;
    const auto decode = [&] {
      return use_mask ? decoder.decode(payload, mask) : decoder.decode(payload);
    };
    EXPECT_FALSE(decode()) << "damage that the checksum must find";
    payload.resize(payload.size() - 4);
    seal(payload);
    const Result<DepthFrame> hostile = decode();
    if (use_mask && hostile) {
      EXPECT_EQ(hostile->counts.size(), frame.counts.size());
    }
  }
  const Result<DepthFrame> good = decoder.decode(whole);
  ASSERT_TRUE(good) << "hostile payloads left something behind: " << good.reason();
  EXPECT_TRUE(synthetic::same(good->counts, frame.counts));
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
