// SPDX-License-Identifier: BSD-3-Clause
// How FrameEncoder chooses its layers.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "rprr_codec/frame_codec.hpp"
#include "rprr_geometry/block_mask.hpp"
#include "rprr_synthetic/coded_images.hpp"
#include "rprr_wire/bytes.hpp"

namespace rprr {
namespace {

constexpr int kPlannedWidth = 324;
constexpr int kPlannedHeight = 242;

SparseColours bytes(std::size_t budget) {
  return {SparseColours::By::kBytes, static_cast<double>(budget)};
}

class FramePlan : public ::testing::Test {
 protected:
  FramePlan()
      : depth_(synthetic::kinect_like(kPlannedWidth, kPlannedHeight)),
        bgr_(synthetic::colourful(kPlannedWidth, kPlannedHeight)),
        mask_(synthetic::some_blocks(BlockGrid(kPlannedWidth, kPlannedHeight), 0.3)) {}

  EncodedFrame sparse_frame() const {
    EncodedFrame frame;
    frame.camera = {kPlannedWidth, kPlannedHeight, 300.0, 300.0, 160.0, 120.0};
    frame.sparse = true;
    frame.reference = "eyebug_a";
    frame.mask = mask_;
    frame.depth_mask = BlockMask(mask_.grid());
    for (int block = 0; block < mask_.grid().count(); block += 3) {
      frame.depth_mask.set(block, mask_[block]);
    }
    return frame;
  }
  EncodedFrame encoded(FrameEncoder& encoder) const {
    EncodedFrame frame = sparse_frame();
    const Result<bool> done = encoder.encode(depth_, bgr_, frame);
    EXPECT_TRUE(done) << done.reason();
    return frame;
  }
  EncodedFrame encoded(const FrameCodecOptions& options) const {
    Result<FrameEncoder> encoder = FrameEncoder::create(options);
    EXPECT_TRUE(encoder) << encoder.reason();
    return encoder ? encoded(*encoder) : EncodedFrame{};
  }

  DepthFrame depth_;
  cv::Mat bgr_;
  BlockMask mask_;
};

class FramePlanning : public FramePlan, public ::testing::WithParamInterface<Objective> {
 protected:
  static FrameCodecOptions options() {
    FrameCodecOptions options;
    options.colour_codec = "webp";
    options.colour_quality = 40;
    options.objective = GetParam();
    return options;
  }
};
INSTANTIATE_TEST_SUITE_P(Objectives, FramePlanning,
                         ::testing::Values(Objective::kMap, Objective::kView));

TEST_P(FramePlanning, WhatIsChosenDecodes) {
  for (const std::string& codec : colour_codecs()) {
    FrameCodecOptions options = this->options();
    options.colour_codec = codec;
    options.colour_quality = like_webp(*colour_codec_info(codec), 40);
    const Result<EncodedFrame> parsed = parse_encoded_frame(serialise(encoded(options)));
    ASSERT_TRUE(parsed) << parsed.reason();
    FrameDecoder decoder(make_local_colour_decoder());
    const Result<DecodedFrame> decoded = decoder.decode(*parsed);
    ASSERT_TRUE(decoded) << codec << ": " << decoded.reason();
    EXPECT_FALSE(decoded->base.empty()) << codec;
    EXPECT_TRUE(synthetic::same(decoded->depth.counts,
                                synthetic::only(depth_.counts, sparse_frame().depth_mask)))
        << "depth is lossless whatever becomes of the colour";
  }
}

TEST_P(FramePlanning, ABudgetIsKeptAndUsed) {
  FrameCodecOptions options = this->options();
  options.sparse_colours = bytes(1);
  const std::size_t least = serialise(encoded(options)).size();
  std::size_t last = 0;
  for (const std::size_t more : {50, 500, 1500, 3000, 6000}) {
    const std::size_t budget = least + more;
    options.sparse_colours = bytes(budget);
    const std::size_t bytes = serialise(encoded(options)).size();
    EXPECT_LE(bytes, budget);
    EXPECT_GE(bytes, last) << "more bytes are never worse used";
    last = bytes;
  }
}

TEST_P(FramePlanning, WithoutRoomTheLeastIsSent) {
  FrameCodecOptions options = this->options();
  options.sparse_colours = bytes(1);
  const EncodedFrame frame = encoded(options);
  options.sparse_colours = bytes(3000);
  EXPECT_LE(frame.base.size() + frame.colour.size(),
            encoded(options).base.size() + encoded(options).colour.size());
  EXPECT_FALSE(frame.base.empty());
}

TEST_P(FramePlanning, TheSearchDoesNotDependOnWhereItBegins) {
  FrameCodecOptions options = this->options();
  options.sparse_colours = bytes(4500);
  Result<FrameEncoder> encoder = FrameEncoder::create(options);
  ASSERT_TRUE(encoder);
  const Bytes cold = serialise(encoded(*encoder));
  const Bytes warm = serialise(encoded(*encoder));
  EXPECT_NEAR(static_cast<double>(cold.size()), static_cast<double>(warm.size()), 12.0)
      << "but for the times that the report states";
}

// Of a sparse or a whole frame, within a limit.
class FrameLimit : public FramePlanning {
 protected:
  EncodedFrame within(FrameEncoder& encoder, bool sparse, std::size_t limit) const {
    EncodedFrame frame = sparse_frame();
    if (!sparse) {
      frame = EncodedFrame();
      frame.camera = sparse_frame().camera;
    }
    const Result<bool> done = encoder.encode_within(depth_, bgr_, frame, limit);
    EXPECT_TRUE(done) << done.reason();
    return frame;
  }
  static constexpr std::size_t kTimes = 12;  // bytes by which the times in a report may differ
};
INSTANTIATE_TEST_SUITE_P(Objectives, FrameLimit,
                         ::testing::Values(Objective::kFixed, Objective::kMap, Objective::kView));

TEST_P(FrameLimit, MakesColoursCoarserAndLeavesDepthAlone) {
  Result<FrameEncoder> encoder = FrameEncoder::create(options());
  ASSERT_TRUE(encoder);
  for (const bool sparse : {false, true}) {
    const EncodedFrame usual = within(*encoder, sparse, 0);
    const std::size_t most = serialise(usual).size();
    const EncodedFrame least = within(*encoder, sparse, 1);
    const std::size_t lowest = serialise(least).size();
    EXPECT_LE(lowest, most + kTimes);
    EXPECT_EQ(least.depth, usual.depth);
    EXPECT_FALSE(least.depth_rounded);
    for (int i = 1; i <= 4; ++i) {
      const std::size_t floor = std::max(lowest, usual.depth.size() * 5 / 4);
      const std::size_t limit = floor + static_cast<std::size_t>(i) * (most - lowest) / 4;
      EXPECT_LE(serialise(within(*encoder, sparse, limit)).size(), limit)
          << (sparse ? "sparse" : "whole");
    }
    const std::size_t ample = serialise(within(*encoder, sparse, 10 * most)).size();
    EXPECT_NEAR(static_cast<double>(ample), static_cast<double>(most), kTimes)
        << "no finer than asked for";
  }
}

TEST_P(FrameLimit, RoundsDepthNoMoreThanAllowedAndSaysSo) {
  FrameCodecOptions options = this->options();
  options.depth_step = 0.02;
  Result<FrameEncoder> encoder = FrameEncoder::create(options);
  ASSERT_TRUE(encoder);
  FrameDecoder decoder(make_local_colour_decoder());
  for (const bool sparse : {false, true}) {
    const std::size_t most = serialise(within(*encoder, sparse, 0)).size();
    EXPECT_FALSE(within(*encoder, sparse, 10 * most).depth_rounded);
    const Result<EncodedFrame> least = parse_encoded_frame(serialise(within(*encoder, sparse, 1)));
    ASSERT_TRUE(least) << least.reason();
    EXPECT_TRUE(least->depth_rounded);
    const Result<DecodedFrame> decoded = decoder.decode(*least);
    ASSERT_TRUE(decoded) << decoded.reason();
    const cv::Mat expected =
        sparse ? synthetic::only(depth_.counts, least->depth_blocks()) : depth_.counts;
    for (int i = 0; i < kPlannedWidth * kPlannedHeight; ++i) {
      const int before = expected.at<std::uint16_t>(i / kPlannedWidth, i % kPlannedWidth);
      const int after =
          decoded->depth.counts.at<std::uint16_t>(i / kPlannedWidth, i % kPlannedWidth);
      ASSERT_EQ(before == 0, after == 0);
      if (before == 0) continue;
      const double z = before * depth_.unit;
      ASSERT_LE(std::abs(before - after) * depth_.unit, 0.011 * z * z * 1.2 + depth_.unit) << z;
    }
  }
}

TEST_P(FramePlanning, ATargetTakesNoMoreThanItNeeds) {
  std::size_t last = 0;
  for (const double target : {18.0, 22.0, 26.0, 99.0}) {
    FrameCodecOptions options = this->options();
    options.sparse_colours = {SparseColours::By::kPsnr, target};
    const EncodedFrame frame = encoded(options);
    const std::size_t bytes = frame.base.size() + frame.colour.size();
    EXPECT_GE(bytes, last);
    last = bytes;
  }
}

TEST_P(FramePlanning, TheNoiseOfTheBaseIsWhatItsDecoderSees) {
  const EncodedFrame frame = encoded(options());
  FrameDecoder decoder(make_local_colour_decoder());
  const Result<cv::Mat> base = decoder.decode_base(frame);
  ASSERT_TRUE(base) << base.reason();
  cv::Mat truth;
  reduce_image(bgr_, frame.base_reduction, truth);
  const double rms =
      cv::norm(truth, *base, cv::NORM_L2) / std::sqrt(3.0 * static_cast<double>(truth.total()));
  if (frame.colour.empty()) {
    EXPECT_NEAR(frame.base_noise, rms, 0.02);
  } else {
    EXPECT_LE(frame.base_noise, 1.2 * rms) << "blocks of the detail do not count";
  }
}

// The order of what decides how fine colours are.
TEST_P(FramePlanning, SparseColoursGoBeforeTheQualityAndTheRadioBeforeBoth) {
  FrameCodecOptions options = this->options();
  options.sparse_colours = bytes(1);
  const std::size_t least = serialise(encoded(options)).size();
  const std::size_t budget = least + 1500;
  options.sparse_colours = bytes(budget);
  options.colour_quality = 5;
  const EncodedFrame coarse = encoded(options);
  options.colour_quality = 95;
  const EncodedFrame fine = encoded(options);
  EXPECT_EQ(coarse.base, fine.base) << "colour_quality does not matter where bytes are named";
  EXPECT_EQ(coarse.colour, fine.colour);
  EXPECT_LE(serialise(fine).size(), budget);
  Result<FrameEncoder> encoder = FrameEncoder::create(options);
  ASSERT_TRUE(encoder);
  EncodedFrame frame = sparse_frame();
  const std::size_t limit = std::max(least, encoded(options).depth.size() * 5 / 4) + 300;
  ASSERT_LT(limit, budget);
  ASSERT_TRUE(encoder->encode_within(depth_, bgr_, frame, limit));
  EXPECT_LE(serialise(frame).size(), limit);
}

TEST_F(FramePlan, FixedLayersTakeNoSparseColours) {
  FrameCodecOptions options;
  options.objective = Objective::kFixed;
  EXPECT_TRUE(FrameEncoder::create(options));
  options.sparse_colours = bytes(3000);
  const Result<FrameEncoder> encoder = FrameEncoder::create(options);
  ASSERT_FALSE(encoder);
  EXPECT_NE(encoder.reason().find("sparse_colours: bytes:3000"), std::string::npos);
}

TEST_F(FramePlan, AViewIsLikeAWholeImageOfHalfTheQuality) {
  const ColourCodecInfo webp = *colour_codec_info("webp");
  FrameCodecOptions options;
  options.colour_quality = 60;
  const LayerLadder ladder(Objective::kView, false, webp, 30.0);
  const EncodedFrame frame = encoded(options);
  EXPECT_EQ(frame.base_reduction, ladder.at(ladder.usual()).base_reduction);
  EncodedFrame same = sparse_frame();
  ASSERT_TRUE(FrameEncoder::create(options)->encode(depth_, bgr_, same, ladder.at(ladder.usual())));
  EXPECT_EQ(frame.base, same.base);
}

TEST_F(FramePlan, WithoutDetailOnlyBlocksWithDepthAreNamed) {
  FrameCodecOptions options;
  options.colour_codec = "webp";
  options.objective = Objective::kView;
  options.colour_quality = 100;
  const EncodedFrame frame = encoded(options);
  EXPECT_TRUE(frame.colour.empty());
  EXPECT_EQ(frame.mask, sparse_frame().depth_mask);
}

TEST_F(FramePlan, AMaskOfNoBlockStillHasItsBase) {
  FrameCodecOptions options;
  options.colour_codec = "webp";
  options.objective = Objective::kView;
  Result<FrameEncoder> encoder = FrameEncoder::create(options);
  ASSERT_TRUE(encoder);
  EncodedFrame frame = sparse_frame();
  frame.mask = frame.depth_mask = BlockMask(mask_.grid());
  ASSERT_TRUE(encoder->encode(depth_, bgr_, frame));
  const Result<EncodedFrame> parsed = parse_encoded_frame(serialise(frame));
  ASSERT_TRUE(parsed) << parsed.reason();
  FrameDecoder decoder(make_local_colour_decoder());
  const Result<DecodedFrame> decoded = decoder.decode(*parsed);
  ASSERT_TRUE(decoded) << decoded.reason();
  EXPECT_FALSE(decoded->has_detail);
  EXPECT_FALSE(decoded->base.empty());
}

}  // namespace
}  // namespace rprr
