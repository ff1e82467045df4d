// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_geometry/depth_survey.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <opencv2/core.hpp>

namespace rprr {
namespace {

// Depth from 1.5 to 3.5 m in the left half of the image, in the unit; nothing in the right half.
DepthFrame half_a_room(double unit) {
  DepthFrame frame{cv::Mat::zeros(120, 160, CV_16UC1), unit};
  for (int v = 0; v < frame.height(); ++v) {
    for (int u = 0; u < frame.width() / 2; ++u) {
      frame.counts.at<std::uint16_t>(v, u) = static_cast<std::uint16_t>(1500 + 25 * u);
    }
  }
  return frame;
}

TEST(DepthSurvey, TellsShareAndMedian) {
  const DepthSurvey survey = survey_depth(half_a_room(0.001));
  EXPECT_NEAR(survey.share_read, 0.5, 0.02);
  EXPECT_NEAR(survey.median, 2.5, 0.1);
  EXPECT_FALSE(survey.is_implausible());
}

TEST(DepthSurvey, AWrongUnitIsImplausible) {
  EXPECT_TRUE(survey_depth(half_a_room(0.01)).is_implausible());
  EXPECT_TRUE(survey_depth(half_a_room(0.00001)).is_implausible());
}

TEST(DepthSurvey, NothingReadIsNotAWrongUnit) {
  const DepthSurvey survey = survey_depth({cv::Mat::zeros(120, 160, CV_16UC1), 0.001});
  EXPECT_EQ(survey.share_read, 0.0);
  EXPECT_EQ(survey.median, 0.0);
  EXPECT_FALSE(survey.is_implausible());
}

TEST(DepthSurvey, CountsWhatIsBeyondALimit) {
  cv::Mat metres(120, 160, CV_32FC1, cv::Scalar(2.0));
  metres.colRange(0, 40) = 20.0f;
  metres.colRange(40, 80) = std::numeric_limits<float>::quiet_NaN();
  EXPECT_NEAR(share_beyond(metres, 13.1), 1.0 / 3.0, 1e-9);
  EXPECT_EQ(share_beyond(metres, 20.0), 0.0);
  EXPECT_EQ(share_beyond(cv::Mat(), 1.0), 0.0);
}

}  // namespace
}  // namespace rprr
