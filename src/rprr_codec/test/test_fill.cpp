// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_codec/fill.hpp"

#include <gtest/gtest.h>

#include "rprr_codec/colour_codec.hpp"
#include "rprr_geometry/block_mask.hpp"
#include "rprr_synthetic/coded_images.hpp"
#include "rprr_wire/bytes.hpp"

namespace rprr {
namespace {

TEST(Fill, SentPixelsAreNeverAltered) {
  SmoothFill smooth;
  for (const auto& [width, height] :
       std::vector<std::pair<int, int>>{{640, 480}, {541, 363}, {9, 1}, {1, 9}, {17, 23}}) {
    const cv::Mat image = synthetic::colourful(width, height);
    const BlockGrid grid(width, height);
    for (const double share : {0.0, 0.05, 0.5, 1.0}) {
      const BlockMask sent = synthetic::some_blocks(grid, share);
      const cv::Mat before = image.clone();
      for (const cv::Mat& filled : {smooth.fill(image, sent), black_fill(image, sent)}) {
        EXPECT_TRUE(synthetic::same(synthetic::only(filled, sent), synthetic::only(image, sent)))
            << width << "x" << height << " share " << share;
      }
      EXPECT_TRUE(synthetic::same(image, before)) << "the input was written to";
    }
  }
}

TEST(Fill, NothingSentIsBlack) {
  SmoothFill smooth;
  const cv::Mat image = synthetic::colourful(64, 48);
  const BlockMask none(BlockGrid(64, 48));
  EXPECT_EQ(cv::norm(smooth.fill(image, none), cv::NORM_INF), 0.0);
  EXPECT_EQ(cv::norm(black_fill(image, none), cv::NORM_INF), 0.0);
}

TEST(Fill, AConstantImageIsContinuedExactly) {
  SmoothFill smooth;
  const cv::Mat image(120, 160, CV_8UC3, cv::Scalar(10, 120, 250));
  const BlockMask sent = synthetic::some_blocks(BlockGrid(160, 120), 0.1);
  cv::Mat unsent_changed = image.clone();
  unsent_changed.setTo(cv::Scalar(99, 99, 99), ~sent.to_image());
  EXPECT_LE(cv::norm(smooth.fill(unsent_changed, sent), image, cv::NORM_INF), 1.0)
      << "what is not sent shows through";
}

TEST(Fill, StaysWithinTheRangeOfWhatIsSent) {
  SmoothFill smooth;
  cv::Mat image = synthetic::colourful(160, 120);
  const BlockMask sent = synthetic::some_blocks(BlockGrid(160, 120), 0.2);
  double low = 0.0;
  double high = 0.0;
  cv::Mat plane;
  cv::extractChannel(image, plane, 0);
  cv::minMaxLoc(plane, &low, &high, nullptr, nullptr, sent.to_image());
  image.setTo(cv::Scalar(255, 0, 255), ~sent.to_image());
  cv::extractChannel(smooth.fill(image, sent), plane, 0);
  double filled_low = 0.0;
  double filled_high = 0.0;
  cv::minMaxLoc(plane, &filled_low, &filled_high);
  EXPECT_GE(filled_low, low - 1);
  EXPECT_LE(filled_high, high + 1);
}

TEST(Fill, KnownPixelsOfReducedImagesAreNeverAltered) {
  SmoothFill smooth;
  for (const int reduction : {1, 2, 4, 8}) {
    const BlockGrid grid(163, 122);
    const cv::Mat image =
        synthetic::colourful((163 + reduction - 1) / reduction, (122 + reduction - 1) / reduction);
    for (const double share : {0.0, 0.3, 1.0}) {
      const BlockMask known = synthetic::some_blocks(grid, share);
      cv::Mat smoothed = image.clone();
      cv::Mat blackened = image.clone();
      smooth.fill_in_place(smoothed, known, reduction);
      black_out(blackened, known, reduction);
      for (int v = 0; v < image.rows; ++v) {
        for (int u = 0; u < image.cols; ++u) {
          const bool is_known = known[grid.index_of_pixel(u * reduction, v * reduction)];
          const auto pixel = image.at<cv::Vec3b>(v, u);
          EXPECT_EQ(blackened.at<cv::Vec3b>(v, u), is_known ? pixel : cv::Vec3b());
          if (is_known) {
            EXPECT_EQ(smoothed.at<cv::Vec3b>(v, u), pixel);
          }
        }
      }
    }
  }
}

TEST(Fill, SmoothCostsLessThanBlack) {
  SmoothFill smooth;
  const cv::Mat image = synthetic::colourful(640, 480);
  const BlockMask sent = synthetic::some_blocks(BlockGrid(640, 480), 0.2);
  const auto encoder = make_colour_encoder("pgf");
  ASSERT_TRUE(encoder);
  const Result<Bytes> smooth_bytes = (*encoder)->encode(smooth.fill(image, sent), 5);
  const Result<Bytes> black_bytes = (*encoder)->encode(black_fill(image, sent), 5);
  ASSERT_TRUE(smooth_bytes && black_bytes);
  EXPECT_LT(static_cast<double>(smooth_bytes->size()),
            0.8 * static_cast<double>(black_bytes->size()));
}

}  // namespace
}  // namespace rprr
