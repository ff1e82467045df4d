// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_codec/frame_codec.hpp"

#include <gtest/gtest.h>

#include "synthetic.hpp"

namespace rprr {
namespace {

constexpr int kWidth = 164;  // no multiple of eight
constexpr int kHeight = 122;

class FrameCodec : public ::testing::Test {
 protected:
  FrameCodec()
      : depth_(synthetic::kinect_like(kWidth, kHeight)),
        bgr_(synthetic::colourful(kWidth, kHeight)),
        decoder_(make_local_colour_decoder()) {}

  static EncodedFrame frame_of(const BlockMask* mask) {
    EncodedFrame frame;
    frame.camera = {kWidth, kHeight, 150.0, 150.0, 80.0, 60.0};
    frame.sparse = mask != nullptr;
    if (mask != nullptr) {
      frame.mask = *mask;
      frame.reference = "eyebug_a";
    }
    return frame;
  }
  // Encoded, through the container, decoded.
  DecodedFrame through(EncodedFrame frame, const FrameCodecOptions& options) {
    Result<FrameEncoder> encoder = FrameEncoder::create(options);
    EXPECT_TRUE(encoder) << encoder.reason();
    const Result<bool> encoded = encoder->encode(depth_, bgr_, frame);
    EXPECT_TRUE(encoded) << encoded.reason();
    const Result<EncodedFrame> parsed = parse_encoded_frame(serialise(frame));
    EXPECT_TRUE(parsed) << parsed.reason();
    Result<DecodedFrame> decoded = decoder_.decode(*parsed);
    EXPECT_TRUE(decoded) << decoded.reason();
    return decoded ? *decoded : DecodedFrame{};
  }

  DepthFrame depth_;
  cv::Mat bgr_;
  FrameDecoder decoder_;
};

TEST_F(FrameCodec, WholeFrameComesBack) {
  FrameCodecOptions options;
  options.colour_quality = 0;
  const DecodedFrame decoded = through(frame_of(nullptr), options);
  EXPECT_TRUE(synthetic::same(decoded.depth.counts, depth_.counts));
  EXPECT_LE(cv::norm(decoded.bgr, bgr_, cv::NORM_INF), 0.0) << "quality 0 is lossless";
}

TEST_F(FrameCodec, SentBlocksComeBackWithEitherFill) {
  const BlockMask mask = synthetic::some_blocks(BlockGrid(kWidth, kHeight), 0.3);
  for (const UnsentFill fill : {UnsentFill::kBlack, UnsentFill::kSmooth}) {
    FrameCodecOptions options;
    options.colour_quality = 0;
    options.fill = fill;
    const DecodedFrame decoded = through(frame_of(&mask), options);
    EXPECT_TRUE(synthetic::same(decoded.depth.counts, synthetic::only(depth_.counts, mask)));
    EXPECT_TRUE(synthetic::same(synthetic::only(decoded.bgr, mask), synthetic::only(bgr_, mask)));
  }
}

TEST_F(FrameCodec, DepthOfFewerBlocksThanColour) {
  const BlockMask mask = synthetic::some_blocks(BlockGrid(kWidth, kHeight), 0.4);
  for (const int keep_every : {2, 1000000}) {
    BlockMask with_depth(mask.grid());
    for (int block = 1; block < mask.grid().count(); ++block) {
      with_depth.set(block, mask[block] && block % keep_every == 0);
    }
    EncodedFrame frame = frame_of(&mask);
    frame.depth_mask = with_depth;
    FrameCodecOptions options;
    options.colour_quality = 0;
    depth_.unit = 0.0002;
    const DecodedFrame decoded = through(frame, options);
    EXPECT_TRUE(synthetic::same(decoded.depth.counts, synthetic::only(depth_.counts, with_depth)));
    EXPECT_EQ(decoded.depth.unit, 0.0002) << "the unit is known without any depth";
    EXPECT_TRUE(synthetic::same(synthetic::only(decoded.bgr, mask), synthetic::only(bgr_, mask)));
  }
}

TEST_F(FrameCodec, DepthBeyondTheBlocksSentIsAnError) {
  const BlockMask none(BlockGrid(kWidth, kHeight));
  EncodedFrame frame = frame_of(&none);
  frame.depth_mask = BlockMask(none.grid(), true);
  Result<FrameEncoder> encoder = FrameEncoder::create({});
  EXPECT_FALSE(encoder->encode(depth_, bgr_, frame));
  EXPECT_FALSE(decoder_.decode(frame));
  frame.depth_mask = BlockMask(BlockGrid(kWidth + 8, kHeight));
  EXPECT_FALSE(decoder_.decode(frame)) << "mask of another size";
}

TEST_F(FrameCodec, NothingToSendTakesNoPayload) {
  const BlockMask none(BlockGrid(kWidth, kHeight));
  EncodedFrame frame = frame_of(&none);
  Result<FrameEncoder> encoder = FrameEncoder::create({});
  ASSERT_TRUE(encoder->encode(depth_, bgr_, frame));
  EXPECT_TRUE(frame.depth.empty());
  EXPECT_TRUE(frame.colour.empty());
  const Result<DecodedFrame> decoded = decoder_.decode(frame);
  ASSERT_TRUE(decoded) << decoded.reason();
  EXPECT_EQ(cv::countNonZero(decoded->depth.counts), 0);
  EXPECT_EQ(decoded->bgr.size(), bgr_.size());
  frame.depth = {1};
  EXPECT_FALSE(decoder_.decode(frame));
}

TEST_F(FrameCodec, IndependentBytesAreThoseOfTheWholeFrame) {
  FrameCodecOptions options;
  options.measure_independent = true;
  Result<FrameEncoder> encoder = FrameEncoder::create(options);
  EncodedFrame whole = frame_of(nullptr);
  ASSERT_TRUE(encoder->encode(depth_, bgr_, whole));
  EXPECT_EQ(whole.report.independent_bytes_depth, whole.depth.size());
  EXPECT_EQ(whole.report.independent_bytes_colour, whole.colour.size());
  const BlockMask mask = synthetic::region(BlockGrid(kWidth, kHeight), 0.2);
  EncodedFrame sparse = frame_of(&mask);
  ASSERT_TRUE(encoder->encode(depth_, bgr_, sparse));
  EXPECT_EQ(sparse.report.independent_bytes_depth, whole.depth.size());
  EXPECT_EQ(sparse.report.independent_bytes_colour, whole.colour.size());
  EXPECT_LT(sparse.depth.size(), whole.depth.size());
  EXPECT_LT(sparse.colour.size(), whole.colour.size());
  EXPECT_GT(sparse.report.ms_encode, 0.0f);
}

TEST_F(FrameCodec, InputsThatDoNotFitAreErrors) {
  FrameCodecOptions unknown;
  unknown.colour_codec = "gif";
  EXPECT_FALSE(FrameEncoder::create(unknown));
  FrameCodecOptions coarse;
  coarse.colour_quality = 31;
  EXPECT_FALSE(FrameEncoder::create(coarse));

  Result<FrameEncoder> encoder = FrameEncoder::create({});
  EncodedFrame frame = frame_of(nullptr);
  frame.camera.width += 8;
  EXPECT_FALSE(encoder->encode(depth_, bgr_, frame)) << "camera of another size";
  frame = frame_of(nullptr);
  EXPECT_FALSE(encoder->encode(depth_, bgr_.rowRange(0, 50), frame)) << "colour too small";
  EXPECT_FALSE(encoder->encode({}, bgr_, frame)) << "no depth";
  EXPECT_FALSE(encoder->encode(depth_, {}, frame)) << "no colour";
  const BlockMask other(BlockGrid(kWidth + 8, kHeight), true);
  frame = frame_of(&other);
  EXPECT_FALSE(encoder->encode(depth_, bgr_, frame)) << "mask of another size";
  frame = frame_of(nullptr);
  frame.sparse = true;
  EXPECT_FALSE(encoder->encode(depth_, bgr_, frame)) << "sparse without a mask";
}

TEST_F(FrameCodec, PayloadsOfOtherSizesAreErrors) {
  Result<FrameEncoder> encoder = FrameEncoder::create({});
  EncodedFrame frame = frame_of(nullptr);
  ASSERT_TRUE(encoder->encode(depth_, bgr_, frame));
  EncodedFrame larger = frame;
  larger.camera.width += 1;
  EXPECT_FALSE(decoder_.decode(larger));
  EncodedFrame empty = frame;
  empty.colour.clear();
  EXPECT_FALSE(decoder_.decode(empty));
  EncodedFrame no_mask = frame;
  no_mask.sparse = true;
  EXPECT_FALSE(decoder_.decode(no_mask));
}

}  // namespace
}  // namespace rprr
