// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_synthetic/sensor_model.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>
#include <set>

#include "rprr_synthetic/trajectory.hpp"

namespace rprr {
namespace {

const Camera kCamera{320, 240, 262.5, 262.5, 159.5, 119.5};

/// A wall at `metres`, with a board from columns 140 to 179 at half that distance.
ExactView wall(float metres, bool board) {
  ExactView view{cv::Mat(240, 320, CV_32FC1, cv::Scalar(metres)),
                 cv::Mat(240, 320, CV_32FC3, cv::Scalar::all(0.2)),
                 cv::Mat(240, 320, CV_32FC1, cv::Scalar(1.0))};
  if (board) view.metres.colRange(140, 180).setTo(0.5f * metres);
  return view;
}

DepthSensorModel plain() {
  DepthSensorModel model;
  model.rim = false;
  return model;
}

TEST(DepthSensor, NoiseIsThatOfAKinect) {
  for (const float z : {1.0f, 2.0f, 3.5f}) {
    const DepthFrame frame = sense_depth(wall(z, false), kCamera, plain(), 5);
    cv::Mat metres;
    frame.counts.convertTo(metres, CV_64F, frame.unit);
    cv::Scalar mean;
    cv::Scalar deviation;
    cv::meanStdDev(metres, mean, deviation);
    // Half a step of noise and the quantisation's 1/sqrt(12) of a step.
    const double expected = std::hypot(1.425e-3, 2.85e-3 / std::sqrt(12.0)) * z * z;
    EXPECT_NEAR(mean[0], z, 0.3 * 2.85e-3 * z * z) << "at " << z << " m";
    EXPECT_NEAR(deviation[0], expected, 0.25 * expected + 0.0003) << "at " << z << " m";
  }
}

TEST(DepthSensor, ValuesLieOnDisparitySteps) {
  const DepthFrame frame = sense_depth(wall(3.0f, true), kCamera, plain(), 5);
  std::set<std::uint16_t> values;
  for (const auto count : cv::Mat_<std::uint16_t>(frame.counts)) {
    if (count == 0) continue;
    values.insert(count);
    const double steps = 1.0 / (count * 0.001) / 2.85e-3;
    const double tolerance = 0.0006 / (count * 0.001) / (count * 0.001) / 2.85e-3;
    ASSERT_NEAR(steps, std::round(steps), tolerance) << count;
  }
  EXPECT_GT(values.size(), 4u);
  EXPECT_LT(values.size(), 24u);
}

TEST(DepthSensor, OutOfRangeIsInvalid) {
  EXPECT_EQ(cv::countNonZero(sense_depth(wall(0.45f, false), kCamera, plain(), 1).counts), 0);
  EXPECT_EQ(cv::countNonZero(sense_depth(wall(5.5f, false), kCamera, plain(), 1).counts), 0);
  EXPECT_EQ(cv::countNonZero(sense_depth(wall(0.0f, false), kCamera, plain(), 1).counts), 0);
}

TEST(DepthSensor, ShadowLiesLeftOfTheForegroundWithTheWidthOfTheParallax) {
  DepthSensorModel model = plain();
  model.edge_jitter = 0.0;
  const DepthFrame frame = sense_depth(wall(2.0f, true), kCamera, model, 2);
  // f b (1/1 - 1/2) = 262.5 * 0.075 / 2 = 9.8 pixels.
  for (int v = 0; v < 240; v += 40) {
    for (int u = 132; u < 140; ++u) EXPECT_EQ(frame.metres(u, v), 0.0) << u;
    EXPECT_GT(frame.metres(127, v), 1.9);
    EXPECT_GT(frame.metres(141, v), 0.9);
    EXPECT_GT(frame.metres(182, v), 1.9) << "no shadow to the right";
  }
  model.baseline = 0.0;
  EXPECT_EQ(cv::countNonZero(sense_depth(wall(2.0f, true), kCamera, model, 2).counts), 320 * 240);
}

TEST(DepthSensor, SurfacesThatSwallowInfraredAreInvalid) {
  ExactView view = wall(2.0f, false);
  view.infrared.rowRange(0, 100).setTo(0.0f);
  const DepthFrame frame = sense_depth(view, kCamera, plain(), 2);
  EXPECT_EQ(cv::countNonZero(frame.counts.rowRange(0, 100)), 0);
  EXPECT_EQ(cv::countNonZero(frame.counts.rowRange(100, 240)), 140 * 320);
}

TEST(DepthSensor, RimOfARegisteredImage) {
  DepthSensorModel model;
  const DepthFrame frame = sense_depth(wall(2.0f, false), kCamera, model, 2);
  EXPECT_EQ(cv::countNonZero(frame.counts.colRange(0, 4)), 0);
  EXPECT_EQ(cv::countNonZero(frame.counts.colRange(312, 320)), 0);
  EXPECT_GT(cv::countNonZero(frame.counts), 300 * 230);
}

TEST(ColourSensor, ExposureGainAndNoise) {
  ColourSensorModel model;
  model.vignetting = 0.0;
  const auto statistics = [&](cv::Scalar& deviation) {
    cv::Scalar mean;
    cv::meanStdDev(sense_colour(wall(2.0f, false), model, 3), mean, deviation);
    return mean;
  };
  cv::Scalar deviation;
  const cv::Scalar normal = statistics(deviation);
  EXPECT_NEAR(normal[0], 255.0 * std::pow(0.2, 1.0 / 2.2), 1.0);
  EXPECT_NEAR(deviation[1], model.noise, 0.5);
  model.exposure = 1.5;
  model.gain = {0.8, 1.0, 1.2};
  const cv::Scalar changed = statistics(deviation);
  for (int c = 0; c < 3; ++c) {
    const double light = 0.2 * 1.5 * model.gain[static_cast<std::size_t>(c)];
    EXPECT_NEAR(changed[c], 255.0 * std::pow(light, 1.0 / 2.2), 1.0);
  }
}

TEST(ColourSensor, CornersAreDarker) {
  const cv::Mat image = sense_colour(wall(2.0f, false), ColourSensorModel(), 3);
  EXPECT_LT(cv::mean(image(cv::Rect(0, 0, 16, 16)))[1],
            cv::mean(image(cv::Rect(152, 112, 16, 16)))[1] - 3.0);
}

TEST(Sensor, RoomThroughTheSensorIsDeterministicAndHasHoles) {
  const Scene room = make_room(2);
  const SensorModel sensor = example_sensor_b(320, 240);
  const Pose pose = single_walk(1, 2)[0];
  const RgbdImage one = sense(room, sensor, pose, 7);
  const RgbdImage two = sense(room, sensor, pose, 7);
  const RgbdImage other = sense(room, sensor, pose, 8);
  EXPECT_EQ(cv::norm(one.bgr, two.bgr, cv::NORM_INF), 0.0);
  EXPECT_EQ(cv::norm(one.depth.counts, two.depth.counts, cv::NORM_INF), 0.0);
  EXPECT_GT(cv::norm(one.bgr, other.bgr, cv::NORM_INF), 0.0) << "another seed, other noise";
  const double valid = cv::countNonZero(one.depth.counts) / (320.0 * 240.0);
  EXPECT_GT(valid, 0.7);
  EXPECT_LT(valid, 0.97);
}

}  // namespace
}  // namespace rprr
