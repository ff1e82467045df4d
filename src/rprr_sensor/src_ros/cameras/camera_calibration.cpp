// SPDX-License-Identifier: BSD-3-Clause
#include "cameras/camera_calibration.hpp"

#include <sensor_msgs/distortion_models.h>

#include <algorithm>
#include <cctype>
#include <vector>

#include "rprr_ros/camera_info.hpp"
#include "rprr_ros/conversions.hpp"

namespace rprr {
namespace {

/// Names of cameras have letters, digits and underscores only.
std::string camera_name(const std::string& what, const std::string& serial) {
  std::string name = what + "_" + (serial.empty() ? "camera" : serial);
  std::replace_if(
      name.begin(), name.end(),
      [](char c) { return std::isalnum(static_cast<unsigned char>(c)) == 0; }, '_');
  return name;
}

Camera camera_of(const sensor_msgs::CameraInfo& info, double fx, double fy, double cx, double cy) {
  return {static_cast<int>(info.width), static_cast<int>(info.height), fx, fy, cx, cy};
}

LensCalibration lens_from_info(const sensor_msgs::CameraInfo& info) {
  LensCalibration lens;
  lens.camera = camera_of(info, info.K[0], info.K[4], info.K[2], info.K[5]);
  lens.distortion = info.D;
  const bool rectified = info.P[0] > 0.0;
  lens.rectified =
      rectified ? camera_of(info, info.P[0], info.P[5], info.P[2], info.P[6]) : lens.camera;
  return lens;
}

sensor_msgs::CameraInfo info_from_lens(const LensCalibration& lens) {
  sensor_msgs::CameraInfo info = info_from_camera(lens.rectified, std_msgs::Header());
  const Camera& raw = lens.camera;
  info.K = {raw.fx, 0.0, raw.cx, 0.0, raw.fy, raw.cy, 0.0, 0.0, 1.0};
  info.D = lens.distortion;
  if (info.D.empty()) info.D.assign(5, 0.0);
  info.distortion_model = info.D.size() == 8 ? sensor_msgs::distortion_models::RATIONAL_POLYNOMIAL
                                             : sensor_msgs::distortion_models::PLUMB_BOB;
  return info;
}

bool same(const sensor_msgs::CameraInfo& one, const sensor_msgs::CameraInfo& two) {
  return one.width == two.width && one.height == two.height && one.K == two.K && one.D == two.D &&
         one.P == two.P;
}

}  // namespace

CameraCalibration::CameraCalibration(const ros::NodeHandle& camera_nh, const CameraOptions& options,
                                     Health& health)
    : health_(health),
      colour_url_(options.camera_info_url),
      depth_url_(options.depth_info_url),
      colour_(ros::NodeHandle(camera_nh, "rgb"), "rgb_camera", colour_url_),
      depth_(ros::NodeHandle(camera_nh, "depth"), "depth_camera", depth_url_),
      colour_from_depth_(colour_from_depth(options)),
      disparity_(options.disparity) {
}

void CameraCalibration::load(const std::string& serial) {
  colour_.setCameraName(camera_name("rgb", serial));
  depth_.setCameraName(camera_name("depth", serial));
  colour_.loadCameraInfo(colour_url_);
  depth_.loadCameraInfo(depth_url_);
}

LensCalibration CameraCalibration::lens(camera_info_manager::CameraInfoManager& manager,
                                        const std::string& what, const LensCalibration& nominal) {
  const sensor_msgs::CameraInfo info = manager.getCameraInfo();
  const std::string url = what == "colour" ? "~camera_info_url" : "~depth_info_url";
  if (!manager.isCalibrated()) {
    health_.show(what + " calibration", "nominal");
    health_.warn(what + " calibration",
                 "the " + what +
                     " camera is not calibrated: taking nominal intrinsics, which makes "
                     "poses less exact. Calibrate it (docs/sensors.md), or set " +
                     url);
    return nominal;
  }
  LensCalibration lens = lens_from_info(info);
  const auto usable = Rectification::create(lens);
  std::string fault = usable.reason();
  if (usable &&
      (lens.camera.width != nominal.camera.width || lens.camera.height != nominal.camera.height)) {
    fault = "it is for " + std::to_string(info.width) + "x" + std::to_string(info.height) +
            " pixels, the camera gives " + std::to_string(nominal.camera.width) + "x" +
            std::to_string(nominal.camera.height);
  }
  if (info.distortion_model == sensor_msgs::distortion_models::EQUIDISTANT) {
    fault =
        "distortion model equidistant is not known here, only plumb_bob and "
        "rational_polynomial";
  }
  health_.show(what + " calibration", fault.empty() ? "its own" : "nominal");
  if (fault.empty()) return lens;
  health_.error(what + " calibration", "the calibration of the " + what + " camera (" + url +
                                           ") does not fit: " + fault +
                                           "; taking nominal intrinsics. Calibrate anew");
  return nominal;
}

RgbdCalibration CameraCalibration::get(int width, int height, bool depth_needed) {
  RgbdCalibration calibration = nominal_calibration(width, height);
  calibration.colour = lens(colour_, "colour", calibration.colour);
  if (depth_needed) calibration.depth = lens(depth_, "depth", calibration.depth);
  calibration.colour_from_depth = colour_from_depth_;
  calibration.disparity = disparity_;
  colour_seen_ = colour_.getCameraInfo();
  depth_seen_ = depth_.getCameraInfo();
  colour_info_ = info_from_lens(calibration.colour);
  return calibration;
}

bool CameraCalibration::changed() {
  return !same(colour_.getCameraInfo(), colour_seen_) || !same(depth_.getCameraInfo(), depth_seen_);
}

}  // namespace rprr
