// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_codec/frame_codec.hpp"

#include <gtest/gtest.h>

#include "rprr_geometry/block_mask.hpp"
#include "rprr_synthetic/coded_images.hpp"
#include "rprr_wire/bytes.hpp"

namespace rprr {
namespace {

constexpr int kWidth = 164;  // no multiple of eight
constexpr int kHeight = 122;

// PGF can code without loss, and objective kFixed leaves the layers to the tests.
FrameCodecOptions pgf_options(int quality = 6) {
  FrameCodecOptions options;
  options.colour_codec = "pgf";
  options.colour_quality = quality;
  options.objective = Objective::kFixed;
  return options;
}

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
    const Result<FrameEncoder> encoder = FrameEncoder::create(options);
    EXPECT_TRUE(encoder) << encoder.reason();
    return encoder ? through(frame, options, encoder->settings()) : DecodedFrame{};
  }
  DecodedFrame through(EncodedFrame frame, const FrameCodecOptions& options,
                       const LayerSettings& settings) {
    Result<FrameEncoder> encoder = FrameEncoder::create(options);
    EXPECT_TRUE(encoder) << encoder.reason();
    const Result<bool> encoded = encoder->encode(depth_, bgr_, frame, settings);
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
  const FrameCodecOptions options = pgf_options(0);
  const DecodedFrame decoded = through(frame_of(nullptr), options);
  EXPECT_TRUE(synthetic::same(decoded.depth.counts, depth_.counts));
  EXPECT_LE(cv::norm(decoded.bgr, bgr_, cv::NORM_INF), 0.0) << "quality 0 is lossless";
}

TEST_F(FrameCodec, SentBlocksComeBackWithEitherFill) {
  const BlockMask mask = synthetic::some_blocks(BlockGrid(kWidth, kHeight), 0.3);
  for (const UnsentFill fill : {UnsentFill::kBlack, UnsentFill::kSmooth}) {
    FrameCodecOptions options = pgf_options(0);
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
    const FrameCodecOptions options = pgf_options(0);
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
  Result<FrameEncoder> encoder = FrameEncoder::create(pgf_options());
  EXPECT_FALSE(encoder->encode(depth_, bgr_, frame));
  EXPECT_FALSE(decoder_.decode(frame));
  frame.depth_mask = BlockMask(BlockGrid(kWidth + 8, kHeight));
  EXPECT_FALSE(decoder_.decode(frame)) << "mask of another size";
}

TEST_F(FrameCodec, NothingToSendTakesNoPayload) {
  const BlockMask none(BlockGrid(kWidth, kHeight));
  EncodedFrame frame = frame_of(&none);
  Result<FrameEncoder> encoder = FrameEncoder::create(pgf_options());
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

TEST_F(FrameCodec, DetailOfEveryCodecComesBackInEitherLayout) {
  for (const std::string& codec : colour_codecs()) {
    for (const double share : {0.02, 0.2, 0.8}) {
      const BlockMask mask = synthetic::some_blocks(BlockGrid(kWidth, kHeight), share);
      FrameCodecOptions options = pgf_options();
      options.colour_codec = codec;
      options.colour_quality = colour_codec_info(codec)->best;
      const DecodedFrame decoded = through(frame_of(&mask), options);
      EXPECT_TRUE(decoded.has_detail);
      EXPECT_TRUE(synthetic::same(decoded.bgr, synthetic::only(decoded.bgr, mask)))
          << "outside of the mask it is black";
      const double error = cv::norm(decoded.bgr, synthetic::only(bgr_, mask), cv::NORM_L1) /
                           (3.0 * cv::countNonZero(mask.to_image()));
      EXPECT_LE(error, codec == "pgf" ? 0.0 : 12.0) << codec << " " << share;
    }
  }
}

TEST_F(FrameCodec, BaseOfEveryReductionComesBack) {
  const BlockMask mask = synthetic::region(BlockGrid(kWidth, kHeight), 0.4);
  const FrameCodecOptions options = pgf_options();
  for (const int reduction : {1, 2, 4, 8, 16}) {
    cv::Mat expected;
    reduce_image(bgr_, reduction, expected);
    ASSERT_EQ(expected.size(), base_size(bgr_.size(), reduction));
    for (const bool detail : {true, false}) {
      const DecodedFrame decoded = through(frame_of(&mask), options, {reduction, 0, 0, detail});
      ASSERT_EQ(decoded.base.size(), expected.size());
      EXPECT_EQ(decoded.has_detail, detail);
      EXPECT_TRUE(synthetic::same(decoded.depth.counts, synthetic::only(depth_.counts, mask)));
      const BlockGrid& grid = mask.grid();
      int wrong = 0;
      for (int v = 0; v < expected.rows; ++v) {
        for (int u = 0; u < expected.cols; ++u) {
          if (detail && mask[grid.index_of_pixel(u * reduction, v * reduction)]) continue;
          wrong += decoded.base.at<cv::Vec3b>(v, u) != expected.at<cv::Vec3b>(v, u) ? 1 : 0;
        }
      }
      EXPECT_EQ(wrong, 0) << "reduction " << reduction;
      EXPECT_EQ(
          cv::norm(decoded.bgr, detail ? synthetic::only(bgr_, mask) : bgr_ * 0.0, cv::NORM_INF),
          0.0);
    }
  }
}

TEST_F(FrameCodec, BaseWithoutAnyBlock) {
  const BlockMask none(BlockGrid(kWidth, kHeight));
  const LayerSettings settings = {2, 6, 6, true};
  const DecodedFrame decoded = through(frame_of(&none), pgf_options(), settings);
  EXPECT_FALSE(decoded.has_detail);
  EXPECT_EQ(decoded.base.size(), base_size(bgr_.size(), 2));
  EXPECT_EQ(cv::norm(decoded.bgr, cv::NORM_INF), 0.0);
  const DecodedFrame whole = through(frame_of(nullptr), pgf_options(), settings);
  EXPECT_TRUE(whole.has_detail);
  EXPECT_TRUE(whole.base.empty()) << "a whole frame needs none";
}

// Our encoder does not make such frames, but the container can hold them.
TEST_F(FrameCodec, ABaseOfAnotherCodecThanTheDetailsIsDecoded) {
  const BlockMask mask = synthetic::region(BlockGrid(kWidth, kHeight), 0.4);
  FrameCodecOptions webp;
  webp.objective = Objective::kFixed;
  EncodedFrame frame = frame_of(&mask);
  EncodedFrame other = frame_of(&mask);
  ASSERT_TRUE(FrameEncoder::create(pgf_options(0))->encode(depth_, bgr_, frame, {2, 6, 0, true}));
  ASSERT_TRUE(FrameEncoder::create(webp)->encode(depth_, bgr_, other, {4, 50, 40, true}));
  frame.base_codec = other.base_codec;
  frame.base = other.base;
  frame.base_reduction = other.base_reduction;
  const Result<EncodedFrame> parsed = parse_encoded_frame(serialise(frame));
  ASSERT_TRUE(parsed) << parsed.reason();
  const Result<DecodedFrame> decoded = decoder_.decode(*parsed);
  ASSERT_TRUE(decoded) << decoded.reason();
  EXPECT_EQ(decoded->base.size(), base_size(bgr_.size(), 4));
  EXPECT_TRUE(synthetic::same(synthetic::only(decoded->bgr, mask), synthetic::only(bgr_, mask)));
}

TEST_F(FrameCodec, SeveralSettingsOfOneFrame) {
  const BlockMask mask = synthetic::region(BlockGrid(kWidth, kHeight), 0.4);
  Result<FrameEncoder> encoder = FrameEncoder::create(pgf_options());
  EncodedFrame stepwise = frame_of(&mask);
  ASSERT_TRUE(encoder->prepare(depth_, bgr_, stepwise));
  for (const int quality : {20, 3, 9}) {
    const LayerSettings settings = {2, quality, quality, true};
    const Result<Bytes> tried = encoder->layers().encode_detail(quality);
    ASSERT_TRUE(encoder->encode_colour(stepwise, settings));
    EXPECT_EQ(*tried, stepwise.colour);
    EncodedFrame at_once = frame_of(&mask);
    Result<FrameEncoder> other = FrameEncoder::create(pgf_options());
    ASSERT_TRUE(other->encode(depth_, bgr_, at_once, settings));
    EXPECT_EQ(stepwise.depth, at_once.depth);
    EXPECT_EQ(stepwise.colour, at_once.colour);
    EXPECT_EQ(stepwise.base, at_once.base);
  }
}

TEST_F(FrameCodec, ACutDetailIsKnownToBeCoarse) {
  const BlockMask mask = synthetic::region(BlockGrid(kWidth, kHeight), 0.4);
  for (const BlockMask* sent : {static_cast<const BlockMask*>(nullptr), &mask}) {
    Result<FrameEncoder> encoder = FrameEncoder::create(pgf_options());
    EncodedFrame frame = frame_of(sent);
    ASSERT_TRUE(encoder->encode(depth_, bgr_, frame));
    EXPECT_EQ(decoder_.decode(frame)->coarse, 0);
    frame.colour = *pgf_cut(frame.colour, 1);
    const Result<DecodedFrame> decoded = decoder_.decode(frame);
    ASSERT_TRUE(decoded) << decoded.reason();
    EXPECT_EQ(decoded->coarse, 1);
    EXPECT_EQ(decoded->bgr.size(), bgr_.size());
  }
}

TEST_F(FrameCodec, SettingsThatDoNotExistAreErrors) {
  const BlockMask mask = synthetic::region(BlockGrid(kWidth, kHeight), 0.4);
  Result<FrameEncoder> encoder = FrameEncoder::create(pgf_options());
  const auto encodes = [&](const BlockMask* sent, const LayerSettings& settings) {
    EncodedFrame frame = frame_of(sent);
    return static_cast<bool>(encoder->encode(depth_, bgr_, frame, settings));
  };
  EXPECT_TRUE(encodes(&mask, {2, 10, 6, true}));
  EXPECT_TRUE(encodes(&mask, {2, 10, 6, false}));
  EXPECT_FALSE(encodes(&mask, {0, 10, 6, false})) << "no colour at all";
  EXPECT_FALSE(encodes(&mask, {3, 10, 6, true})) << "no such reduction";
  EXPECT_FALSE(encodes(&mask, {32, 10, 6, true})) << "no such reduction";
  EXPECT_FALSE(encodes(&mask, {2, 31, 6, true})) << "no such quality";
  EXPECT_FALSE(encodes(&mask, {2, 10, -1, true})) << "no such quality";
  EXPECT_FALSE(encodes(nullptr, {2, 10, 6, false})) << "a whole frame without its image";
  EXPECT_TRUE(encodes(nullptr, {2, 10, 6, true}));
}

TEST_F(FrameCodec, HostileBasesAndLayoutsAreErrors) {
  const BlockMask mask = synthetic::region(BlockGrid(kWidth, kHeight), 0.4);
  Result<FrameEncoder> encoder = FrameEncoder::create(pgf_options());
  EncodedFrame good = frame_of(&mask);
  ASSERT_TRUE(encoder->encode(depth_, bgr_, good, {2, 10, 6, true}));
  ASSERT_TRUE(decoder_.decode(good));
  const auto refused = [&](auto change, const std::string& what) {
    EncodedFrame frame = good;
    change(frame);
    EXPECT_FALSE(decoder_.decode(frame)) << what;
  };
  refused([](EncodedFrame& f) { f.base_reduction = 4; }, "base of another size");
  refused([](EncodedFrame& f) { f.base_reduction = 3; }, "no such reduction");
  refused([](EncodedFrame& f) { f.base.pop_back(); }, "damaged base");
  refused([](EncodedFrame& f) { f.base_codec = "jpeg"; }, "base of another codec");
  refused([](EncodedFrame& f) { f.colour.pop_back(); }, "damaged detail");
  refused([](EncodedFrame& f) { f.base_reduction = 0, f.colour.clear(); }, "no colour");
  EXPECT_EQ(good.colour_layout, ColourLayout::kCompact);
  refused([](EncodedFrame& f) { f.colour_layout = ColourLayout::kInPlace; }, "another layout");
  EncodedFrame whole = frame_of(nullptr);
  ASSERT_TRUE(encoder->encode(depth_, bgr_, whole));
  whole.colour_layout = ColourLayout::kCompact;
  EXPECT_FALSE(decoder_.decode(whole));
  whole.colour_layout = ColourLayout::kInPlace;
  whole.base = good.base;
  whole.base_reduction = 2;
  EXPECT_FALSE(decoder_.decode(whole));
}

TEST_F(FrameCodec, IndependentBytesAreThoseOfTheWholeFrame) {
  FrameCodecOptions options = pgf_options();
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
  EXPECT_FALSE(FrameEncoder::create(pgf_options(31)));
  EXPECT_TRUE(FrameEncoder::create(pgf_options(30)));
  FrameCodecOptions jpeg = pgf_options(0);
  jpeg.colour_codec = "jpeg";
  EXPECT_FALSE(FrameEncoder::create(jpeg));
  jpeg.colour_quality = 1;
  EXPECT_TRUE(FrameEncoder::create(jpeg));

  Result<FrameEncoder> encoder = FrameEncoder::create(pgf_options());
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
  Result<FrameEncoder> encoder = FrameEncoder::create(pgf_options());
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
