// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_view/crack_filter.hpp"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>

namespace rprr {
namespace {

cv::Mat plane(float metres, int width = 64, int height = 48) {
  return cv::Mat(height, width, CV_32FC1, cv::Scalar(metres));
}

int changed(const cv::Mat& mended) {
  return cv::countNonZero(mended);
}

TEST(CrackFilter, LeavesASoundImageAlone) {
  cv::Mat metres = plane(2.0f);
  metres(cv::Rect(20, 0, 44, 48)).setTo(3.0f);  // a depth edge is no artefact
  const cv::Mat before = metres.clone();
  cv::Mat mended;
  CrackFilter().mend(metres, mended);
  EXPECT_EQ(changed(mended), 0);
  EXPECT_EQ(cv::norm(metres, before, cv::NORM_INF), 0);
}

TEST(CrackFilter, ClosesCracksInAnyDirection) {
  cv::Mat metres = plane(2.0f);
  metres.col(10).setTo(0);
  metres.row(30).setTo(0);
  for (int i = 0; i < 20; ++i) metres.at<float>(5 + i, 30 + i) = 0;
  metres(cv::Rect(50, 5, 2, 20)).setTo(0);  // two pixels wide
  cv::Mat mended;
  CrackFilter().mend(metres, mended);
  const cv::Mat inner = metres(cv::Rect(1, 1, 62, 46));  // the rim has no neighbours on both sides
  EXPECT_EQ(cv::countNonZero(inner == 0), 0);
  EXPECT_EQ(cv::countNonZero(inner != 2.0f), 0);
  EXPECT_EQ(mended.at<std::uint8_t>(20, 10), 255);
  EXPECT_EQ(mended.at<std::uint8_t>(20, 12), 0) << "valid pixels are not touched";
}

TEST(CrackFilter, LeavesDisocclusionsOpen) {
  cv::Mat metres = plane(2.0f);
  metres(cv::Rect(20, 10, 16, 20)).setTo(0);  // too wide
  metres(cv::Rect(45, 0, 19, 48)).setTo(1.0f);
  metres(cv::Rect(42, 0, 3, 48)).setTo(0);  // narrow, but between two surfaces
  cv::Mat mended;
  CrackFilter().mend(metres, mended);
  EXPECT_EQ(changed(mended(cv::Rect(42, 0, 3, 48))), 0);
  EXPECT_EQ(metres.at<float>(20, 28), 0.0f);
  // Corners of the large hole are closed in diagonally at most.
  EXPECT_GT(cv::countNonZero(metres(cv::Rect(20, 10, 16, 20)) == 0), 16 * 20 - 20);
}

TEST(CrackFilter, WindowSetsHowWideACrackMayBe) {
  for (const int width : {1, 3, 5, 7}) {
    cv::Mat metres = plane(2.0f);
    metres(cv::Rect(20, 0, width, 48)).setTo(0);
    cv::Mat mended;
    CrackFilterOptions options;
    options.largest_window = 5;
    CrackFilter(options).mend(metres, mended);
    const bool open = metres.at<float>(24, 20 + width / 2) == 0.0f;
    EXPECT_EQ(open, width > 3) << "crack of " << width << " pixels";
  }
}

TEST(CrackFilter, RemovesBackgroundThatShinesThrough) {
  cv::Mat metres = plane(1.0f);
  metres.at<float>(20, 20) = 3.0f;
  metres.at<float>(30, 40) = 3.0f;
  metres.at<float>(30, 41) = 3.0f;  // two together
  metres.at<float>(10, 10) = 0.5f;  // a stray pixel before the surface
  cv::Mat mended;
  CrackFilter().mend(metres, mended);
  EXPECT_EQ(cv::norm(metres, plane(1.0f), cv::NORM_INF), 0);
  EXPECT_EQ(changed(mended), 4);
}

TEST(CrackFilter, GhostsGoWhereverTheyAreInARow) {
  for (int u = 1; u < 100; ++u) {
    for (const float ghost : {1.0f, 3.0f}) {
      cv::Mat metres = plane(2.0f, 101, 3);
      metres.at<float>(1, u) = ghost;
      cv::Mat mended;
      CrackFilter().mend(metres, mended);
      EXPECT_EQ(metres.at<float>(1, u), 2.0f) << "column " << u;
      EXPECT_EQ(changed(mended), 1) << "column " << u;
    }
  }
}

TEST(CrackFilter, GhostsNeedOneSurfaceAround) {
  cv::Mat metres = plane(1.0f);
  metres(cv::Rect(20, 0, 44, 48)).setTo(2.0f);
  metres.at<float>(24, 20) = 4.0f;  // between four of one and four of another
  metres.at<float>(24, 19) = 1.0f;
  metres.at<float>(23, 21) = 1.0f;
  cv::Mat mended;
  CrackFilter().mend(metres, mended);
  EXPECT_EQ(metres.at<float>(24, 20), 4.0f);
}

TEST(CrackFilter, NeighboursWithoutDepthDoNotVote) {
  cv::Mat metres = plane(0.0f);
  metres.at<float>(20, 20) = 1.0f;
  metres.at<float>(20, 21) = 3.0f;
  cv::Mat mended;
  CrackFilter().mend(metres, mended);
  EXPECT_EQ(metres.at<float>(20, 20), 1.0f);
  EXPECT_EQ(changed(mended), 0);
}

TEST(CrackFilter, StepsCanBeSwitchedOff) {
  CrackFilterOptions neither;
  neither.cracks = neither.ghosts = false;
  cv::Mat metres = plane(1.0f);
  metres.at<float>(20, 20) = 3.0f;
  metres.at<float>(30, 30) = 0.0f;
  cv::Mat mended;
  CrackFilter(neither).mend(metres, mended);
  EXPECT_EQ(changed(mended), 0);
}

TEST(CrackFilter, TinyImages) {
  for (const cv::Size size : {cv::Size(1, 1), cv::Size(2, 1), cv::Size(1, 5), cv::Size(3, 3)}) {
    cv::Mat metres = plane(1.0f, size.width, size.height);
    metres.at<float>(0, 0) = 0;
    cv::Mat mended;
    CrackFilter().mend(metres, mended);
    EXPECT_EQ(mended.size(), size);
  }
}

}  // namespace
}  // namespace rprr
