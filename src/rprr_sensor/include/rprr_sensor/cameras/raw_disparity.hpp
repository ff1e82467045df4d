// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "rprr_geometry/depth_frame.hpp"

namespace rprr {

/// What the 11 bits of a Kinect's raw depth mean: 1/z = offset - step * raw, z in metres. The
/// defaults are those of a nominal Kinect, whose projector is 7.5 cm from its camera and whose
/// reference plane is at 1.2 m.
struct DisparityModel {
  double offset = 3.1532;   // 1/m
  double step = 2.8944e-3;  // 1/m for each count
};

/// Raw values have 11 bits; the largest says "no reading".
constexpr int kDisparityValues = 2048;
constexpr std::uint16_t kNoDisparity = 2047;

/// Raw disparity to millimetres, by a table.
class DisparityTable {
 public:
  explicit DisparityTable(const DisparityModel& model = {});

  /// Millimetres; 0 = none: kNoDisparity, what is behind infinity or farther than 10 m, and values
  /// that do not have 11 bits.
  std::uint16_t millimetres(std::uint16_t raw) const {
    return raw < kDisparityValues ? table_[raw] : std::uint16_t{0};
  }
  /// A new frame of 1 mm from raw values, CV_16UC1.
  DepthFrame depth(const cv::Mat& raw) const;

 private:
  std::vector<std::uint16_t> table_;
};

/// The raw value of a depth in metres, kNoDisparity where there is none: what a Kinect would say.
std::uint16_t disparity_of(double metres, const DisparityModel& model = {});

}  // namespace rprr
