// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <opencv2/core.hpp>

#include "rprr_sensor/cameras/pair_processor.hpp"
#include "rprr_synthetic/sensor_model.hpp"
#include "rprr_synthetic/trajectory.hpp"

namespace rprr {

/// What a nominal Kinect sees of the synthetic room, and what is true.
struct SyntheticKinect {
  RgbdCalibration calibration = nominal_calibration(640, 480);
  cv::Mat bgr;        // of the colour camera
  cv::Mat truth;      // CV_32FC1, metres, of the colour camera
  cv::Mat disparity;  // CV_16UC1, of the depth camera; beyond 0.5 to 5 m none

  SyntheticKinect() {
    const Scene room = make_room(4);
    const Pose world_from_colour = single_walk(1, 4)[0];
    const ExactView colour = room.render(calibration.colour.camera, world_from_colour);
    const ExactView depth =
        room.render(calibration.depth.camera, world_from_colour * calibration.colour_from_depth);
    bgr = sense_colour(colour, ColourSensorModel(), 1);
    truth = colour.metres;
    disparity.create(depth.metres.size(), CV_16UC1);
    for (int v = 0; v < disparity.rows; ++v) {
      for (int u = 0; u < disparity.cols; ++u) {
        const float z = depth.metres.at<float>(v, u);
        disparity.at<std::uint16_t>(v, u) = z > 0.5f && z < 5.0f ? disparity_of(z) : kNoDisparity;
      }
    }
  }
};

/// How an image of depth in millimetres compares with the truth.
struct DepthAgreement {
  double coverage = 0.0;  // share of pixels with depth
  double near = 0.0;      // of these, share within 1.5 steps of the sensor and 4 mm
};

inline DepthAgreement compare_depth(const cv::Mat& millimetres, const cv::Mat& truth) {
  int valid = 0, near = 0;
  for (int v = 0; v < truth.rows; ++v) {
    for (int u = 0; u < truth.cols; ++u) {
      const double z = 0.001 * millimetres.at<std::uint16_t>(v, u);
      const double exact = truth.at<float>(v, u);
      if (z == 0.0) continue;
      ++valid;
      near += std::abs(z - exact) < 0.004 + 1.5 * 2.9e-3 * exact * exact ? 1 : 0;
    }
  }
  return {valid / static_cast<double>(truth.total()), valid > 0 ? near / double(valid) : 0.0};
}

}  // namespace rprr
