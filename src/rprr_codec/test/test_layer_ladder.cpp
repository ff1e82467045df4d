// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_codec/layer_ladder.hpp"

#include <gtest/gtest.h>

#include <cstdlib>

#include "rprr_codec/encoded_frame.hpp"

namespace rprr {
namespace {

LayerLadder ladder(Objective objective, bool few, const std::string& codec, int usual) {
  const ColourCodecInfo info = *colour_codec_info(codec);
  return LayerLadder(objective, few, info, as_webp(info, usual));
}

TEST(LayerLadder, EveryRungIsOfItsCodecsScale) {
  for (const std::string& codec : colour_codecs()) {
    const ColourCodecInfo info = *colour_codec_info(codec);
    for (const Objective objective : {Objective::kMap, Objective::kView}) {
      for (const bool few : {false, true}) {
        const LayerLadder rungs = ladder(objective, few, codec, info.best);
        ASSERT_GT(rungs.rungs(), 5);
        for (int i = 0; i < rungs.rungs(); ++i) {
          const LayerSettings& at = rungs.at(i);
          EXPECT_TRUE(is_base_reduction(at.base_reduction));
          EXPECT_TRUE(info.has_quality(at.base_quality));
          EXPECT_TRUE(info.has_quality(at.detail_quality));
        }
      }
    }
  }
}

// Each rung is at least as fine in something as the one below.
TEST(LayerLadder, RungsOfTheViewRise) {
  for (const bool few : {false, true}) {
    const LayerLadder rungs = ladder(Objective::kView, few, "webp", 20);
    for (int i = 1; i < rungs.rungs(); ++i) {
      const LayerSettings& below = rungs.at(i - 1);
      const LayerSettings& at = rungs.at(i);
      EXPECT_TRUE(
          at.base_reduction < below.base_reduction ||
          (at.base_reduction == below.base_reduction && at.base_quality > below.base_quality) ||
          (at.detail && !below.detail) || at.detail_quality > below.detail_quality)
          << i;
    }
    EXPECT_EQ(rungs.at(rungs.rungs() - 1).base_reduction, 1);
    EXPECT_FALSE(rungs.at(rungs.rungs() - 1).detail) << "the whole image at one quality";
  }
}

TEST(LayerLadder, AMapHasItsDetailAtTheUsualQualityOverTheLeastBase) {
  for (int quality = 0; quality <= 100; quality += 10) {
    const LayerLadder rungs = ladder(Objective::kMap, false, "webp", quality);
    const LayerSettings& usual = rungs.at(rungs.usual());
    EXPECT_TRUE(usual.detail);
    EXPECT_LE(std::abs(usual.detail_quality - quality), 7);
    EXPECT_GE(usual.base_reduction, 8);
  }
}

TEST(LayerLadder, TheUsualRungRisesWithTheQuality) {
  int last = -1;
  for (int quality = 0; quality <= 100; ++quality) {
    const int usual = ladder(Objective::kView, false, "webp", quality).usual();
    EXPECT_GE(usual, last) << quality;
    last = usual;
  }
  EXPECT_EQ(last + 1, ladder(Objective::kView, false, "webp", 100).rungs());
}

TEST(LayerLadder, QualitiesOfOtherCodecsGoBothWays) {
  for (const std::string& codec : colour_codecs()) {
    const ColourCodecInfo info = *colour_codec_info(codec);
    for (const double webp : {0.0, 10.0, 40.0, 75.0, 100.0}) {
      const int quality = like_webp(info, webp);
      EXPECT_TRUE(info.has_quality(quality)) << codec;
      EXPECT_NEAR(as_webp(info, quality), webp, codec == "pgf" ? 15.0 : 2.0) << codec;
    }
  }
}

TEST(CoarserQualities, RiseFromTheCoarsestToJustBelow) {
  for (const std::string& name : colour_codecs()) {
    const ColourCodecInfo codec = *colour_codec_info(name);
    const int usual = like_webp(codec, 40);
    const std::vector<int> qualities = coarser_qualities(codec, usual);
    ASSERT_GT(qualities.size(), 3u) << name;
    EXPECT_EQ(qualities.front(), codec.coarsest) << name;
    const int sign = codec.best > codec.coarsest ? 1 : -1;
    for (std::size_t i = 1; i < qualities.size(); ++i) {
      EXPECT_GT(sign * qualities[i], sign * qualities[i - 1]) << name;
    }
    EXPECT_LT(sign * qualities.back(), sign * usual) << name;
    EXPECT_TRUE(coarser_qualities(codec, codec.coarsest).empty()) << name;
  }
}

}  // namespace
}  // namespace rprr
