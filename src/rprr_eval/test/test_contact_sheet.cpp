// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_eval/report/contact_sheet.hpp"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>

namespace rprr {
namespace {

const cv::Vec3b kRed(0, 0, 255);
const cv::Vec3b kBlue(255, 0, 0);

cv::Mat filled(int width, int height, const cv::Vec3b& colour) {
  return cv::Mat(height, width, CV_8UC3, cv::Scalar(colour[0], colour[1], colour[2]));
}

int pixels(const cv::Mat& sheet, const cv::Vec3b& colour) {
  cv::Mat found;
  cv::inRange(sheet, colour, colour, found);
  return cv::countNonZero(found);
}

// Where a colour is on the sheet.
cv::Point centre(const cv::Mat& sheet, const cv::Vec3b& colour) {
  cv::Mat found;
  cv::inRange(sheet, colour, colour, found);
  long x = 0;
  long y = 0;
  for (int v = 0; v < found.rows; ++v) {
    for (int u = 0; u < found.cols; ++u) {
      if (found.at<std::uint8_t>(v, u) == 0) continue;
      x += u;
      y += v;
    }
  }
  const int count = std::max(cv::countNonZero(found), 1);
  return {static_cast<int>(x / count), static_cast<int>(y / count)};
}

TEST(ContactSheet, ShowsEveryPictureAtTheWidthAskedFor) {
  const cv::Mat sheet =
      contact_sheet({{"one", filled(320, 240, kRed)}, {"two", filled(320, 240, kBlue)}}, 160);
  EXPECT_EQ(sheet.type(), CV_8UC3);
  EXPECT_EQ(pixels(sheet, kRed), 160 * 120);
  EXPECT_EQ(pixels(sheet, kBlue), 160 * 120);
  EXPECT_EQ(centre(sheet, kRed).y, centre(sheet, kBlue).y) << "side by side";
  EXPECT_LT(centre(sheet, kRed).x, centre(sheet, kBlue).x) << "in the order given";
  cv::Mat dark;
  cv::inRange(sheet, cv::Scalar::all(0), cv::Scalar::all(120), dark);
  EXPECT_GT(cv::countNonZero(dark), 20) << "captions";
}

TEST(ContactSheet, TwoInARow) {
  const cv::Mat sheet = contact_sheet(
      {{"", filled(64, 48, kRed)}, {"", filled(64, 48, {7, 7, 7})}, {"", filled(64, 48, kBlue)}},
      64);
  EXPECT_EQ(centre(sheet, kRed).x, centre(sheet, kBlue).x);
  EXPECT_LT(centre(sheet, kRed).y, centre(sheet, kBlue).y);
}

TEST(ContactSheet, AMissingPictureLeavesItsPlaceGrey) {
  const cv::Vec3b grey(190, 190, 190);
  const cv::Mat sheet = contact_sheet({{"none", {}}, {"one", filled(320, 240, kRed)}}, 160);
  EXPECT_EQ(pixels(sheet, kRed), 160 * 120) << "the others keep their shape";
  EXPECT_GE(pixels(sheet, grey), 160 * 120);
  EXPECT_FALSE(contact_sheet({{"none", {}}, {"none", {}}}, 160).empty());
}

TEST(ContactSheet, PicturesOfOtherSizesAreScaled) {
  const cv::Mat sheet =
      contact_sheet({{"", filled(324, 244, kRed)}, {"", filled(640, 480, kBlue)}}, 162);
  EXPECT_EQ(pixels(sheet, kRed), 162 * 122);
  EXPECT_EQ(pixels(sheet, kBlue), 162 * 122);
}

}  // namespace
}  // namespace rprr
