// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_codec/colour_codec.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "rprr_geometry/camera.hpp"
#include "rprr_synthetic/coded_images.hpp"
#include "rprr_wire/bytes.hpp"

namespace rprr {
namespace {

Bytes encoded(const std::string& codec, const cv::Mat& image, int quality) {
  Result<std::unique_ptr<ColourEncoder>> encoder = make_colour_encoder(codec);
  EXPECT_TRUE(encoder) << encoder.reason();
  Result<Bytes> payload = (*encoder)->encode(image, quality);
  EXPECT_TRUE(payload) << payload.reason();
  return payload ? *payload : Bytes{};
}

double mean_error(const cv::Mat& a, const cv::Mat& b) {
  return cv::norm(a, b, cv::NORM_L1) / static_cast<double>(3 * a.total());
}

const std::vector<cv::Size> kSizes = {{1, 1}, {1, 40},  {40, 1},  {2, 3},     {5, 5},
                                      {8, 8}, {17, 31}, {80, 60}, {640, 480}, {541, 361}};

class EveryColourCodec : public ::testing::TestWithParam<std::string> {
 protected:
  ColourCodecInfo info() const { return *colour_codec_info(GetParam()); }
  // Share of the way from best to coarsest.
  int quality(double share) const {
    return static_cast<int>(std::lround(info().best + share * (info().coarsest - info().best)));
  }
};

TEST_P(EveryColourCodec, EverySizeComesBack) {
  const auto decoder = make_local_colour_decoder();
  for (const cv::Size& size : kSizes) {
    const cv::Mat image = synthetic::colourful(size.width, size.height);
    const Bytes payload = encoded(GetParam(), image, info().best);
    const Result<cv::Mat> back = decoder->decode(GetParam(), payload, size);
    ASSERT_TRUE(back) << back.reason() << " " << size;
    ASSERT_EQ(back->size(), size);
    // Sharp edges of colour at half the resolution.
    EXPECT_LT(mean_error(*back, image), 12.0) << size;
    const Result<cv::Size> stated = colour_payload_size(GetParam(), payload);
    ASSERT_TRUE(stated) << stated.reason();
    EXPECT_EQ(*stated, size);
  }
}

TEST_P(EveryColourCodec, BytesFallAndErrorsRiseAlongTheScale) {
  const auto decoder = make_local_colour_decoder();
  const cv::Mat image = synthetic::colourful(320, 240);
  std::size_t last_bytes = ~std::size_t{0};
  double last_error = -1.0;
  for (const double share : {0.0, 0.25, 0.5, 0.75, 1.0}) {
    const Bytes payload = encoded(GetParam(), image, quality(share));
    const Result<cv::Mat> back = decoder->decode(GetParam(), payload, image.size());
    ASSERT_TRUE(back) << back.reason();
    EXPECT_LE(payload.size(), last_bytes) << "quality " << quality(share);
    EXPECT_GE(mean_error(*back, image), 0.8 * last_error) << "quality " << quality(share);
    last_bytes = payload.size();
    last_error = mean_error(*back, image);
  }
}

TEST_P(EveryColourCodec, OneEncoderTakesAnyQualityAndSizeInTurn) {
  const auto encoder = make_colour_encoder(GetParam());
  ASSERT_TRUE(encoder);
  EXPECT_EQ((*encoder)->name(), GetParam());
  for (const int side : {64, 17, 200}) {
    const cv::Mat image = synthetic::colourful(side, side);
    for (const double share : {0.9, 0.1, 0.5}) {
      const Result<Bytes> payload = (*encoder)->encode(image, quality(share));
      ASSERT_TRUE(payload) << payload.reason();
      EXPECT_EQ(*payload, encoded(GetParam(), image, quality(share)));
    }
  }
}

TEST_P(EveryColourCodec, AViewIntoALargerImageIsEncodedAsACopyOfIt) {
  const cv::Mat view = synthetic::colourful(200, 150)(cv::Rect(11, 7, 90, 60));
  EXPECT_EQ(encoded(GetParam(), view, quality(0.3)),
            encoded(GetParam(), view.clone(), quality(0.3)));
}

TEST_P(EveryColourCodec, WrongInputsAreErrors) {
  const auto encoder = make_colour_encoder(GetParam());
  const cv::Mat image = synthetic::colourful(40, 30);
  EXPECT_FALSE((*encoder)->encode(cv::Mat(), info().best));
  EXPECT_FALSE((*encoder)->encode(cv::Mat(8, 8, CV_8UC1), info().best));
  EXPECT_FALSE((*encoder)->encode(cv::Mat(1, kMaxImageSide + 1, CV_8UC3), info().best));
  const int low = std::min(info().best, info().coarsest);
  const int high = std::max(info().best, info().coarsest);
  EXPECT_TRUE((*encoder)->encode(image, low));
  EXPECT_TRUE((*encoder)->encode(image, high));
  EXPECT_FALSE((*encoder)->encode(image, low - 1));
  EXPECT_FALSE((*encoder)->encode(image, high + 1));
}

TEST_P(EveryColourCodec, CutAndDamagedPayloadsAreErrors) {
  const auto decoder = make_local_colour_decoder();
  const cv::Size size(40, 30);
  const Bytes payload = encoded(GetParam(), synthetic::colourful(40, 30), quality(0.3));
  EXPECT_FALSE(decoder->decode(GetParam(), payload, cv::Size(30, 40)));
  EXPECT_FALSE(decoder->decode("gif", payload, size));
  for (std::size_t cut = 0; cut < payload.size(); ++cut) {
    EXPECT_FALSE(decoder->decode(GetParam(), ByteView(payload).first(cut), size)) << "cut " << cut;
  }
  for (std::size_t i = 0; i < payload.size(); ++i) {
    Bytes damaged = payload;
    damaged[i] ^= 1;
    EXPECT_FALSE(decoder->decode(GetParam(), damaged, size)) << "byte " << i;
  }
}

TEST_P(EveryColourCodec, StatedSizesOfHostilePayloadsArePossible) {
  std::mt19937 random(11);
  const Bytes payload = encoded(GetParam(), synthetic::colourful(61, 9), quality(0.5));
  int stated = 0;
  for (int trial = 0; trial < 20000; ++trial) {
    Bytes hostile(payload.begin(), payload.end() - 4);
    for (std::uint32_t i = 0; i <= random() % 4; ++i) {
      hostile[random() % hostile.size()] = static_cast<std::uint8_t>(random());
    }
    if (trial % 3 == 0) hostile.resize(random() % hostile.size());
    seal(hostile);
    const Result<cv::Size> size = colour_payload_size(GetParam(), hostile);
    if (!size) continue;
    ++stated;
    EXPECT_TRUE(size->width >= 1 && size->height >= 1);
    EXPECT_LE(std::max(size->width, size->height), kMaxImageSide);
  }
  EXPECT_GT(stated, 1000);
}

std::string name_of(const ::testing::TestParamInfo<std::string>& info) {
  return info.param;
}

INSTANTIATE_TEST_SUITE_P(All, EveryColourCodec, ::testing::ValuesIn(colour_codecs()), name_of);

TEST(ColourCodecs, AreFoundByName) {
  EXPECT_EQ(colour_codecs(), (std::vector<std::string>{"pgf", "jpeg", "webp"}));
  for (const std::string name : {"", "tiff", "PGF"}) {
    EXPECT_FALSE(make_colour_encoder(name));
    EXPECT_FALSE(colour_codec_info(name));
    EXPECT_FALSE(colour_payload_size(name, {}));
  }
  EXPECT_NE(make_colour_encoder("tiff").reason().find("pgf, jpeg, webp"), std::string::npos);
}

TEST(Pgf, IsLosslessAtQualityZeroForEverySize) {
  const auto decoder = make_local_colour_decoder();
  for (const cv::Size& size : kSizes) {
    const cv::Mat image = synthetic::colourful(size.width, size.height);
    const Result<cv::Mat> back = decoder->decode("pgf", encoded("pgf", image, 0), size);
    ASSERT_TRUE(back) << back.reason() << " " << size;
    EXPECT_TRUE(synthetic::same(*back, image)) << size;
  }
}

// Something of every frequency.
cv::Mat textured(int width, int height) {
  cv::Mat image = synthetic::colourful(width, height);
  std::mt19937 random(4);
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      for (int c = 0; c < 3; ++c) {
        auto& value = image.at<cv::Vec3b>(v, u)[c];
        value = static_cast<std::uint8_t>(value + random() % 24);
      }
    }
  }
  return image;
}

TEST(Pgf, CutPayloadsDecodeCoarserAtTheFullSize) {
  const auto decoder = make_local_colour_decoder();
  for (const cv::Size& size : {cv::Size(320, 240), cv::Size(541, 361), cv::Size(16, 16)}) {
    for (const int quality : {0, 4, 6}) {
      const cv::Mat image = textured(size.width, size.height);
      const Bytes payload = encoded("pgf", image, quality);
      const Result<int> levels = pgf_levels(payload);
      ASSERT_TRUE(levels) << levels.reason();
      double last_error = -1.0;
      std::size_t last_bytes = payload.size() + 1;
      for (int coarse = 0; coarse < *levels; ++coarse) {
        const Result<Bytes> cut = pgf_cut(payload, coarse);
        ASSERT_TRUE(cut) << cut.reason();
        EXPECT_LT(cut->size(), last_bytes);
        EXPECT_EQ(*colour_payload_coarse("pgf", *cut), coarse);
        EXPECT_EQ(*colour_payload_size("pgf", *cut), size);
        const Result<cv::Mat> back = decoder->decode("pgf", *cut, size);
        ASSERT_TRUE(back) << back.reason() << " level " << coarse;
        ASSERT_EQ(back->size(), size);
        const double error = cv::norm(*back, image, cv::NORM_L2SQR);
        EXPECT_GT(error, last_error) << size << " quality " << quality << " level " << coarse;
        last_error = error;
        last_bytes = cut->size();
        if (coarse > 0) {
          EXPECT_EQ(*pgf_cut(*pgf_cut(payload, coarse - 1), coarse), *cut);
        }
      }
      EXPECT_EQ(*pgf_cut(payload, 0), payload);
      if (*levels == 1) continue;
      EXPECT_LT(mean_error(*decoder->decode("pgf", *pgf_cut(payload, 1), size), image), 20.0);
    }
  }
}

TEST(Pgf, AConstantImageIsTheSameAtEveryLevel) {
  const cv::Mat image(121, 163, CV_8UC3, cv::Scalar(20, 90, 200));
  const Bytes payload = encoded("pgf", image, 0);
  for (int coarse = 0; coarse < *pgf_levels(payload); ++coarse) {
    const auto back =
        make_local_colour_decoder()->decode("pgf", *pgf_cut(payload, coarse), image.size());
    ASSERT_TRUE(back) << back.reason();
    EXPECT_LE(cv::norm(*back, image, cv::NORM_INF), 1.0) << "level " << coarse;
  }
}

TEST(Pgf, CutsThatDoNotExistAreErrors) {
  const Bytes payload = encoded("pgf", textured(320, 240), 6);
  const int levels = *pgf_levels(payload);
  EXPECT_FALSE(pgf_cut(payload, -1));
  EXPECT_FALSE(pgf_cut(payload, levels));
  EXPECT_FALSE(pgf_cut(*pgf_cut(payload, 2), 1)) << "what is gone is gone";
  EXPECT_FALSE(pgf_cut({}, 0));
  EXPECT_FALSE(pgf_cut(encoded("webp", textured(320, 240), 6), 1));
  Bytes damaged = payload;
  damaged[20] ^= 1;
  EXPECT_FALSE(pgf_cut(damaged, 1));
}

TEST(Pgf, HostileLevelsAreErrors) {
  const Bytes payload = encoded("pgf", textured(320, 240), 6);
  const auto refused = [&](std::size_t at, std::uint8_t value) {
    Bytes hostile(payload.begin(), payload.end() - 4);
    hostile[at] = value;
    seal(hostile);
    EXPECT_FALSE(pgf_levels(hostile)) << at << " is " << int{value};
    EXPECT_FALSE(make_local_colour_decoder()->decode("pgf", hostile, cv::Size(320, 240)));
  };
  refused(0, 1);   // the former version
  refused(3, 0);   // no level
  refused(3, 31);  // too many
  refused(3, 200);
  refused(4, payload[3]);      // all left out
  refused(4, 1);               // one left out, and its bytes still there
  refused(9, payload[9] ^ 1);  // lengths that do not add up
}

}  // namespace
}  // namespace rprr
