// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <camera_info_manager/camera_info_manager.h>
#include <ros/ros.h>
#include <sensor_msgs/CameraInfo.h>

#include <string>

#include "cameras/camera_options.hpp"
#include "rprr_ros/health.hpp"
#include "rprr_sensor/cameras/pair_processor.hpp"

namespace rprr {

/// Calibrations of one camera's two lenses by its serial number: files, and what calibrators set
/// while it runs (services rgb/set_camera_info and depth/set_camera_info in the namespace given).
class CameraCalibration {
 public:
  /// health must outlive this.
  CameraCalibration(const ros::NodeHandle& camera_nh, const CameraOptions& options, Health& health);

  /// Reads the files of that serial number ("" where it has none).
  void load(const std::string& serial);
  /// For images of that size. What is not calibrated, or for another size, is nominal, with a
  /// warning that says how to calibrate.
  RgbdCalibration get(int width, int height, bool depth_needed);
  /// Whether a calibrator has set something since the last get().
  bool changed();
  /// The colour camera's calibration as it came: the raw image in K and D, the rectified one in P.
  const sensor_msgs::CameraInfo& colour_info() const { return colour_info_; }

 private:
  LensCalibration lens(camera_info_manager::CameraInfoManager& manager, const std::string& what,
                       const LensCalibration& nominal);

  Health& health_;
  std::string colour_url_;
  std::string depth_url_;
  camera_info_manager::CameraInfoManager colour_;
  camera_info_manager::CameraInfoManager depth_;
  Pose colour_from_depth_;
  DisparityModel disparity_;
  sensor_msgs::CameraInfo colour_seen_;  // as the managers had it
  sensor_msgs::CameraInfo depth_seen_;
  sensor_msgs::CameraInfo colour_info_;
};

}  // namespace rprr
