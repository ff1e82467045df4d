// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_codec/colour_codec.hpp"

#include <gtest/gtest.h>

#include "synthetic.hpp"

namespace rprr {
namespace {

Bytes encoded(const cv::Mat& image, int quality) {
  Result<std::unique_ptr<ColourEncoder>> encoder = make_colour_encoder("pgf", quality);
  EXPECT_TRUE(encoder) << encoder.reason();
  Result<Bytes> payload = (*encoder)->encode(image);
  EXPECT_TRUE(payload) << payload.reason();
  return payload ? *payload : Bytes{};
}

TEST(ColourCodec, LosslessAtQualityZeroForEverySize) {
  const auto decoder = make_local_colour_decoder();
  for (const auto& [width, height] : std::vector<std::pair<int, int>>{
           {1, 1}, {1, 40}, {40, 1}, {2, 3}, {5, 5}, {8, 8}, {17, 31}, {640, 480}, {541, 361}}) {
    const cv::Mat image = synthetic::colourful(width, height);
    const Result<cv::Mat> back = decoder->decode("pgf", encoded(image, 0), image.size());
    ASSERT_TRUE(back) << back.reason() << " " << width << "x" << height;
    EXPECT_TRUE(synthetic::same(*back, image)) << width << "x" << height;
  }
}

TEST(ColourCodec, CoarserIsSmallerAndStillLikeTheImage) {
  const auto decoder = make_local_colour_decoder();
  const cv::Mat image = synthetic::colourful(320, 240);
  std::size_t last = ~std::size_t{0};
  for (const int quality : {0, 2, 4, 6, 10}) {
    const Bytes payload = encoded(image, quality);
    EXPECT_LT(payload.size(), last) << "quality " << quality;
    last = payload.size();
    const Result<cv::Mat> back = decoder->decode("pgf", payload, image.size());
    ASSERT_TRUE(back) << back.reason();
    EXPECT_LT(cv::norm(*back, image, cv::NORM_L1) / static_cast<double>(3 * image.total()),
              quality <= 6 ? 8.0 : 40.0)
        << "mean error at quality " << quality;
  }
}

TEST(ColourCodec, AViewIntoALargerImageComesBack) {
  const cv::Mat view = synthetic::colourful(200, 150)(cv::Rect(11, 7, 90, 60));
  const auto decoder = make_local_colour_decoder();
  const Result<cv::Mat> back = decoder->decode("pgf", encoded(view, 0), view.size());
  ASSERT_TRUE(back) << back.reason();
  EXPECT_TRUE(synthetic::same(*back, view));
}

TEST(ColourCodec, NamesAndQualitiesAreChecked) {
  for (const std::string& name : colour_codecs()) EXPECT_TRUE(make_colour_encoder(name, 5)) << name;
  EXPECT_FALSE(make_colour_encoder("", 5));
  EXPECT_FALSE(make_colour_encoder("tiff", 5));
  EXPECT_FALSE(make_colour_encoder("pgf", -1));
  EXPECT_FALSE(make_colour_encoder("pgf", 31));
  EXPECT_TRUE(make_colour_encoder("pgf", 30));
}

TEST(ColourCodec, WrongInputsAreErrors) {
  const auto encoder = make_colour_encoder("pgf", 5);
  EXPECT_FALSE((*encoder)->encode(cv::Mat()));
  EXPECT_FALSE((*encoder)->encode(cv::Mat(8, 8, CV_8UC1)));
  const auto decoder = make_local_colour_decoder();
  const Bytes payload = encoded(synthetic::colourful(40, 30), 3);
  EXPECT_FALSE(decoder->decode("pgf", payload, cv::Size(30, 40)));
  EXPECT_FALSE(decoder->decode("webp", payload, cv::Size(40, 30)));
  for (std::size_t size = 0; size < payload.size(); ++size) {
    EXPECT_FALSE(decoder->decode("pgf", ByteView(payload).first(size), cv::Size(40, 30)))
        << "cut to " << size;
  }
  for (std::size_t i = 0; i < payload.size(); ++i) {
    Bytes damaged = payload;
    damaged[i] ^= 1;
    EXPECT_FALSE(decoder->decode("pgf", damaged, cv::Size(40, 30))) << "byte " << i;
  }
}

TEST(ColourPayloadSize, IsThatOfTheImageAndOnlyOfAWholePayload) {
  const cv::Mat image = synthetic::colourful(61, 9);
  Result<Bytes> payload = (*make_colour_encoder("pgf", 6))->encode(image);
  ASSERT_TRUE(payload);
  const Result<cv::Size> size = colour_payload_size("pgf", *payload);
  ASSERT_TRUE(size) << size.reason();
  EXPECT_EQ(*size, image.size());
  EXPECT_FALSE(colour_payload_size("jpeg", *payload));
  EXPECT_FALSE(colour_payload_size("pgf", {}));
  payload->resize(payload->size() - 4);
  (*payload)[2] = (*payload)[3] = 0xff;  // 65535 columns
  seal(*payload);
  EXPECT_FALSE(colour_payload_size("pgf", *payload));
  payload->pop_back();
  EXPECT_FALSE(colour_payload_size("pgf", *payload));
}

}  // namespace
}  // namespace rprr
