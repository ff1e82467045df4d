// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <iostream>
#include <opencv2/core.hpp>
#include <random>
#include <set>

#include "rprr_eval/codec/block_regions.hpp"
#include "rprr_eval/codec/codec_survey.hpp"
#include "rprr_eval/codec/depth_codec.hpp"
#include "rprr_geometry/block_mask.hpp"
#include "rprr_wire/bytes.hpp"

namespace rprr {
namespace {

enum class Kind { kEmpty, kSlope, kSpecks, kNoise };

cv::Mat image(Kind kind, int width, int height) {
  std::mt19937 random(7);
  cv::Mat counts(height, width, CV_16UC1, cv::Scalar(0));
  for (int v = 0; v < height && kind != Kind::kEmpty; ++v) {
    for (int u = 0; u < width; ++u) {
      const unsigned dice = random();
      unsigned value = 1000u + 3u * static_cast<unsigned>(u) + static_cast<unsigned>(v);
      if (kind == Kind::kSpecks && dice % 3 == 0) value = 0;
      if (kind == Kind::kSpecks && dice % 7 == 1) value = 65535;
      if (kind == Kind::kNoise) value = dice;
      counts.at<std::uint16_t>(v, u) = static_cast<std::uint16_t>(value);
    }
  }
  return counts;
}

std::vector<NamedDepthCodec> all_codecs() {
  std::vector<std::string> notes;
  auto codecs = make_depth_codecs({}, notes);
  for (const std::string& note : notes) {
    std::cout << note << "\n";
    EXPECT_NE(note.find("install"), std::string::npos) << note;
  }
  return std::move(*codecs);
}

TEST(DepthCodecs, HaveNamesOfTheirOwn) {
  std::set<std::string> names;
  for (const DepthCodecEntry& entry : depth_codecs()) {
    EXPECT_TRUE(names.insert(entry.name).second) << entry.name << " twice";
    EXPECT_FALSE(entry.description.empty()) << entry.name;
  }
}

TEST(DepthCodecs, UnknownNameIsAnErrorThatTellsTheKnownOnes) {
  std::vector<std::string> notes;
  const auto codecs = make_depth_codecs({"rvl", "rot13"}, notes);
  ASSERT_FALSE(codecs);
  EXPECT_NE(codecs.reason().find("rot13"), std::string::npos);
  EXPECT_NE(codecs.reason().find("jpegls"), std::string::npos);
}

// One object for all of them, so that what is kept between frames shows.
TEST(DepthCodecs, GiveBackEveryImage) {
  for (const NamedDepthCodec& named : all_codecs()) {
    for (const cv::Size size : {cv::Size(64, 48), cv::Size(61, 37), cv::Size(16, 128)}) {
      for (const Kind kind : {Kind::kEmpty, Kind::kSlope, Kind::kSpecks, Kind::kNoise}) {
        const cv::Mat counts = image(kind, size.width, size.height);
        Bytes coded;
        ASSERT_TRUE(named.codec->encode(counts, coded)) << named.name;
        cv::Mat back(size, CV_16UC1, cv::Scalar(9));
        ASSERT_TRUE(named.codec->decode(coded, back)) << named.name << " " << size;
        EXPECT_EQ(cv::norm(back, counts, cv::NORM_INF), 0.0)
            << named.name << " " << size << " kind " << static_cast<int>(kind);
      }
    }
  }
}

// The paper's listing by hand: 2 zeros, 3 others with differences 5, -1, 300, folded 10, 1, 600.
TEST(Rvl, CodesAsThePaperDoes) {
  std::vector<std::string> notes;
  const auto codecs = make_depth_codecs({"rvl"}, notes);
  ASSERT_TRUE(codecs);
  const cv::Mat counts = (cv::Mat_<std::uint16_t>(1, 5) << 0, 0, 5, 4, 304);
  Bytes coded;
  ASSERT_TRUE(codecs->front().codec->encode(counts, coded));
  // nibbles 2, 3, a1 (10 = 1 * 8 + 2), 1, 8b11 -> 600 = 1 * 512 + 1 * 64 + 3 * 8 + 0
  const std::uint32_t words[2] = {0x23a118b9u, 0x10000000u};
  ASSERT_EQ(coded.size(), sizeof(words));
  EXPECT_EQ(std::memcmp(coded.data(), words, sizeof(words)), 0);
}

TEST(CodecSurvey, ComparesSideBySide) {
  std::vector<DepthFrame> frames;
  for (const Kind kind : {Kind::kSlope, Kind::kSpecks, Kind::kSlope}) {
    frames.push_back({image(kind, 64, 48), 0.001});
  }
  std::vector<CodecFigures> figures = survey_depth("here", frames, all_codecs(), 2);
  ASSERT_GE(figures.size(), 2u);
  for (const CodecFigures& f : figures) {
    EXPECT_EQ(f.frames, 3u) << f.codec;
    EXPECT_TRUE(f.lossless) << f.codec;
    EXPECT_GT(f.ratio, 1.0) << f.codec;
  }
  figures.front().sparse = survey_sparse(frames, DhcmMode::kDefault, {0.3, 0.1}, 2);
  ASSERT_EQ(figures.front().sparse.size(), 2u);
  EXPECT_GT(figures.front().sparse[0].relative_bits, 0.0);
  EXPECT_GT(figures.front().sparse[0].mask_bytes, 0.0);
  const std::string tables = codec_tables(figures);
  EXPECT_NE(tables.find("| ratio to raw 16 bit | here |"), std::string::npos) << tables;
  EXPECT_NE(tables.find("| rvl | "), std::string::npos) << tables;
}

TEST(BlockRegions, HaveTheShareAskedForAndHangTogether) {
  const BlockGrid grid(640, 480);
  for (const double share : {0.02, 0.1, 0.3, 1.0}) {
    const BlockMask mask = random_regions(grid, share, 3, 5);
    EXPECT_EQ(mask.count(), static_cast<int>(std::lround(share * grid.count())));
    EXPECT_TRUE(mask == random_regions(grid, share, 3, 5));
    int alone = 0;
    for (int block = 0; block < grid.count(); ++block) {
      const int column = block % grid.columns;
      const bool beside = (column > 0 && mask[block - 1]) ||
                          (column + 1 < grid.columns && mask[block + 1]) ||
                          (block >= grid.columns && mask[block - grid.columns]) ||
                          (block + grid.columns < grid.count() && mask[block + grid.columns]);
      alone += mask[block] && !beside ? 1 : 0;
    }
    EXPECT_EQ(alone, 0) << share;
  }
  EXPECT_EQ(random_regions(BlockGrid(8, 8), 0.1, 3, 1).count(), 1);
}

}  // namespace
}  // namespace rprr
