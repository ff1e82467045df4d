// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_codec/encoded_frame.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include "rprr_synthetic/coded_images.hpp"
#include "rprr_wire/bytes.hpp"
#include "rprr_wire/camera_wire.hpp"
#include "rprr_wire/mask_wire.hpp"

namespace rprr {
namespace {

EncodedFrame example(bool sparse) {
  EncodedFrame frame;
  frame.camera = rounded_for_wire({640, 480, 525.1, 525.3, 319.5, 239.5});
  frame.sparse = sparse;
  frame.depth = {1, 2, 3, 4, 5};
  frame.colour_codec = "pgf";
  frame.colour = {9, 8, 7};
  frame.report = {100, 20, 3000, 400, 50000, 60000, 11.5f, 2.25f, 3.0f, 14.75f};
  if (sparse) {
    frame.reference = "eyebug_a";
    frame.reference_stamp = 1234567890123456789;
    frame.b_from_a = exp_se3((Twist() << 0.1, -0.2, 0.3, 0.05, 0.4, -0.02).finished());
    frame.mask = synthetic::some_blocks(BlockGrid(640, 480), 0.3);
  }
  return frame;
}

EncodedFrame with_base(const std::string& codec, int reduction) {
  EncodedFrame frame = example(true);
  frame.base_codec = codec;
  frame.base = {4, 4, 4, 4};
  frame.base_reduction = reduction;
  return frame;
}

TEST(EncodedFrame, ComesBack) {
  for (const bool sparse : {false, true}) {
    const EncodedFrame frame = example(sparse);
    const Result<EncodedFrame> back = parse_encoded_frame(serialise(frame));
    ASSERT_TRUE(back) << back.reason();
    EXPECT_EQ(back->camera.fx, frame.camera.fx);
    EXPECT_EQ(back->camera.width, 640);
    EXPECT_EQ(back->sparse, sparse);
    EXPECT_EQ(back->reference, frame.reference);
    EXPECT_EQ(back->reference_stamp, frame.reference_stamp);
    EXPECT_LT((back->b_from_a.matrix() - frame.b_from_a.matrix()).cwiseAbs().maxCoeff(), 5e-9);
    EXPECT_TRUE(back->mask == frame.mask);
    EXPECT_EQ(back->depth, frame.depth);
    EXPECT_EQ(back->colour, frame.colour);
    EXPECT_EQ(back->colour_codec, "pgf");
    EXPECT_EQ(back->report.blocks_validated, 20);
    EXPECT_EQ(back->report.independent_bytes_colour, 60000u);
    EXPECT_EQ(back->report.ms_encode, 14.75f);
  }
}

TEST(EncodedFrame, EveryRotationComesBack) {
  std::mt19937 random(6);
  std::uniform_real_distribution<double> any(-3.2, 3.2);
  EncodedFrame frame = example(true);
  for (int trial = 0; trial < 2000; ++trial) {
    Twist twist = Twist::Zero();
    for (int i = 0; i < 6; ++i) twist[i] = trial % 7 == i ? M_PI : any(random);
    if (trial % 3 == 0) twist.tail<3>() = Eigen::Vector3d::Unit(trial % 9 / 3) * M_PI;
    frame.b_from_a = exp_se3(twist);
    const Result<EncodedFrame> back = parse_encoded_frame(serialise(frame));
    ASSERT_TRUE(back) << back.reason();
    const Pose error = back->b_from_a * frame.b_from_a.inverse();
    EXPECT_LT((error.rotation() - Eigen::Matrix3d::Identity()).norm(), 1e-13);
    EXPECT_LT((back->b_from_a.translation() - frame.b_from_a.translation()).norm(), 1e-8);
  }
}

TEST(EncodedFrame, BaseComesBack) {
  for (const int reduction : {1, 2, 4, 8, 16}) {
    for (const std::string codec : {"webp", "pgf"}) {
      for (const bool detail : {true, false}) {
        EncodedFrame frame = with_base(codec, reduction);
        if (!detail) frame.colour.clear();
        EncodedSizes sent;
        EncodedSizes received;
        const Result<EncodedFrame> back = parse_encoded_frame(serialise(frame, &sent), &received);
        ASSERT_TRUE(back) << back.reason();
        EXPECT_EQ(back->base, frame.base);
        EXPECT_EQ(back->base_codec, codec);
        EXPECT_EQ(back->base_reduction, reduction);
        EXPECT_EQ(back->colour, frame.colour);
        EXPECT_EQ(sent.base, 4u);
        EXPECT_EQ(sent.mask + sent.depth + sent.colour + sent.base + sent.extras, sent.total);
        EXPECT_EQ(received.base, sent.base);
        EXPECT_EQ(received.extras, sent.extras);
      }
    }
  }
  const Result<EncodedFrame> without = parse_encoded_frame(serialise(example(true)));
  EXPECT_EQ(without->base_reduction, 0);
  EXPECT_TRUE(without->base.empty());
}

TEST(EncodedFrame, LayoutComesBack) {
  EncodedFrame frame = example(true);
  EXPECT_EQ(parse_encoded_frame(serialise(frame))->colour_layout, ColourLayout::kInPlace);
  frame.colour_layout = ColourLayout::kCompact;
  EXPECT_EQ(parse_encoded_frame(serialise(frame))->colour_layout, ColourLayout::kCompact);
}

TEST(EncodedFrame, AWholeFrameHasNeitherBaseNorLayout) {
  EncodedFrame frame = with_base("webp", 2);
  frame.sparse = false;
  frame.colour_layout = ColourLayout::kCompact;
  EncodedSizes sizes;
  const Result<EncodedFrame> back = parse_encoded_frame(serialise(frame, &sizes));
  ASSERT_TRUE(back) << back.reason();
  EXPECT_EQ(back->base_reduction, 0);
  EXPECT_EQ(back->colour_layout, ColourLayout::kInPlace);
  EXPECT_EQ(sizes.base, 0u);
}

TEST(EncodedFrame, FlagsThatNoFrameHasAreRefused) {
  const auto accepted = [](const EncodedFrame& frame, int flags) {
    Bytes bytes = serialise(frame);
    bytes.resize(bytes.size() - 4);
    bytes[1] = static_cast<std::uint8_t>(flags);
    seal(bytes);
    return static_cast<bool>(parse_encoded_frame(bytes));
  };
  const int good = serialise(with_base("webp", 2))[1];
  EXPECT_TRUE(accepted(with_base("webp", 2), good));
  EXPECT_TRUE(accepted(with_base("webp", 2), good | 0x80)) << "depth is rounded";
  EXPECT_TRUE(accepted(example(false), 0x80)) << "of whole frames too";
  for (const int halvings : {6, 7}) {
    EXPECT_FALSE(accepted(with_base("webp", 2), (good & ~0x1C) | halvings << 2));
  }
  for (int flags = 1; flags < 256; ++flags) {
    if ((flags & 1) == 0 && flags != 0x80) {
      EXPECT_FALSE(accepted(example(false), flags)) << flags;
    }
  }
}

TEST(EncodedFrame, OlderVersionsAreRefused) {
  for (const int version : {0, 1, 2, 4}) {
    Bytes bytes = serialise(example(true));
    bytes.resize(bytes.size() - 4);
    bytes[0] = static_cast<std::uint8_t>(version);
    seal(bytes);
    EXPECT_FALSE(parse_encoded_frame(bytes)) << version;
  }
}

TEST(EncodedFrame, TimesThatAreNoneAreWrittenAsNone) {
  EncodedFrame frame = example(true);
  frame.report.ms_pose = std::nanf("");
  frame.report.ms_predict = -1.0f;
  frame.report.ms_validate = std::numeric_limits<float>::infinity();
  const Result<EncodedFrame> back = parse_encoded_frame(serialise(frame));
  ASSERT_TRUE(back) << back.reason();
  EXPECT_EQ(back->report.ms_pose, 0.0f);
  EXPECT_EQ(back->report.ms_predict, 0.0f);
  EXPECT_EQ(back->report.ms_validate, 4e6f);
}

TEST(EncodedFrame, BothMasksComeBack) {
  EncodedFrame frame = example(true);
  EXPECT_TRUE(parse_encoded_frame(serialise(frame))->depth_blocks() == frame.mask);
  frame.depth_mask = BlockMask(frame.mask.grid());
  for (int block = 0; block < frame.mask.grid().count(); block += 3) {
    frame.depth_mask.set(block, frame.mask[block]);
  }
  const Result<EncodedFrame> back = parse_encoded_frame(serialise(frame));
  ASSERT_TRUE(back) << back.reason();
  EXPECT_TRUE(back->mask == frame.mask);
  EXPECT_TRUE(back->depth_mask == frame.depth_mask);
}

TEST(EncodedFrame, SizesAddUpOnBothSides) {
  for (const bool sparse : {false, true}) {
    const EncodedFrame frame = example(sparse);
    EncodedSizes sent;
    EncodedSizes received;
    const Bytes bytes = serialise(frame, &sent);
    ASSERT_TRUE(parse_encoded_frame(bytes, &received));
    EXPECT_EQ(sent.total, bytes.size());
    EXPECT_EQ(sent.depth, 5u);
    EXPECT_EQ(sent.colour, 3u);
    EXPECT_EQ(sent.mask, sparse ? encode_mask(frame.mask).size() : 0u);
    EXPECT_EQ(sent.mask + sent.depth + sent.colour + sent.extras, sent.total);
    EXPECT_EQ(received.extras, sent.extras);
    EXPECT_EQ(received.mask, sent.mask);
    EXPECT_EQ(received.total, sent.total);
    EXPECT_LT(sent.extras, 115u);
  }
}

TEST(EncodedFrame, CutsAndFlipsAreErrors) {
  const Bytes bytes = serialise(example(true));
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    EXPECT_FALSE(parse_encoded_frame(ByteView(bytes).first(size))) << "cut to " << size;
  }
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    Bytes damaged = bytes;
    damaged[i] ^= 0x20;
    EXPECT_FALSE(parse_encoded_frame(damaged)) << "byte " << i;
  }
}

TEST(EncodedFrame, WhatMakesNoSenseIsRefusedThoughSealed) {
  const auto refused = [](auto change, const std::string& what) {
    EncodedFrame frame = example(true);
    change(frame);
    EXPECT_FALSE(parse_encoded_frame(serialise(frame))) << what;
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  refused([&](EncodedFrame& f) { f.b_from_a.translation().x() = nan; }, "translation of NaN");
  refused([&](EncodedFrame& f) { f.b_from_a.translation().x() = 1e300; },
          "translation out of space");
  refused([&](EncodedFrame& f) { f.b_from_a.matrix().setConstant(nan); }, "motion of NaN");
  refused([](EncodedFrame& f) { f.camera.fx = -1.0; }, "negative focal length");
  refused([](EncodedFrame& f) { f.camera.width = 0; }, "no width");
  refused([](EncodedFrame& f) { f.camera.width = 648; }, "mask of another grid");
  refused([](EncodedFrame& f) { f.reference.clear(); }, "no reference");
  refused([](EncodedFrame& f) { f.reference = "a b\n"; }, "unprintable reference");
  refused([](EncodedFrame& f) { f.colour_codec = "\x01"; }, "unprintable codec");
  refused([](EncodedFrame& f) { f.base_reduction = 2; }, "empty base");
  refused([](EncodedFrame& f) { f = with_base("\x01", 2); }, "unprintable codec of the base");
}

TEST(EncodedFrame, LongNamesAreRefusedBeforeTheyAreCopied) {
  Bytes bytes = serialise(example(true));
  bytes.resize(bytes.size() - 4);
  bytes[22] = 200;  // length of the reference
  seal(bytes);
  EXPECT_FALSE(parse_encoded_frame(bytes));
}

TEST(EncodedFrame, HostileBytesWithAValidChecksumNeverCrash) {
  std::mt19937 random(5);
  const Bytes good = serialise(with_base("webp", 4));
  for (int trial = 0; trial < 20000; ++trial) {
    Bytes bytes(good.begin(), good.end() - 4);
    for (std::uint32_t i = 0; i <= random() % 3; ++i) {
      bytes[random() % bytes.size()] = static_cast<std::uint8_t>(random());
    }
    if (trial % 5 == 0) bytes.resize(random() % bytes.size());
    seal(bytes);
    const Result<EncodedFrame> frame = parse_encoded_frame(bytes);
    if (!frame) continue;
    EXPECT_TRUE(frame->camera.valid());
    EXPECT_TRUE(is_rigid(frame->b_from_a));
    EXPECT_LE(frame->reference.size(), 64u);
    EXPECT_TRUE(frame->base_reduction == 0 || is_base_reduction(frame->base_reduction));
    EXPECT_EQ(frame->base_reduction == 0, frame->base.empty());
  }
}

}  // namespace
}  // namespace rprr
