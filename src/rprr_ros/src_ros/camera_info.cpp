// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_ros/camera_info.hpp"

#include <image_geometry/pinhole_camera_model.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <sstream>

#include "rprr_wire/camera_wire.hpp"

namespace rprr {
namespace {

constexpr double kLeastDistortion = 2.0;  // [px] at an image's corner: below, nobody sees it
constexpr double kLeastRotation = 0.2;    // [deg]
constexpr double kDegree = 57.29577951308232;

bool is_same(const ImageSize& a, const ImageSize& b) {
  return a.width == b.width && a.height == b.height;
}

ImageSize size_of(const sensor_msgs::CameraInfo& info) {
  return {static_cast<int>(info.width), static_cast<int>(info.height)};
}

// With P, so that all that follows looks there only.
sensor_msgs::CameraInfo with_projection(sensor_msgs::CameraInfo info) {
  if (info.P[0] == 0.0) {
    info.P = {info.K[0], 0, info.K[2], 0, 0, info.K[4], info.K[5], 0, 0, 0, 1, 0};
  }
  return info;
}

Camera camera_of(double fx, double fy, double cx, double cy, const ImageSize& size) {
  return {size.width, size.height, fx, fy, cx, cy};
}

Result<Camera> checked(const Camera& camera) {
  if (!camera.valid()) return Error{"no usable intrinsics (K and P) or size; calibrate the camera"};
  return rounded_for_wire(camera);
}

// How far the lens moves the image's corner [px], by the radial coefficients, which do most.
double distortion_at_corner(const sensor_msgs::CameraInfo& info) {
  const auto& k = info.K;
  if (info.D.size() < 2 || !(k[0] > 0.0) || !(k[4] > 0.0)) return 0.0;
  const double x = std::max(k[2], info.width - k[2]) / k[0];
  const double y = std::max(k[5], info.height - k[5]) / k[4];
  const double r2 = x * x + y * y;
  const double k3 = info.D.size() > 4 ? info.D[4] : 0.0;
  const double radial = r2 * (info.D[0] + r2 * (info.D[1] + r2 * k3));
  return std::abs(radial) * std::hypot(x * k[0], y * k[4]);
}

double rotation_degrees(const sensor_msgs::CameraInfo& info) {
  const double trace = info.R[0] + info.R[4] + info.R[8];
  if (trace == 0.0) return 0.0;  // not set
  return kDegree * std::acos(std::clamp((trace - 1.0) / 2.0, -1.0, 1.0));
}

}  // namespace

std::string text_of(const ImageSize& size) {
  return std::to_string(size.width) + "x" + std::to_string(size.height);
}

Result<Camera> camera_from_info(const sensor_msgs::CameraInfo& info, const ImageSize& image) {
  sensor_msgs::CameraInfo full = with_projection(info);
  if (full.width == 0 && full.height == 0) {
    full.width = static_cast<std::uint32_t>(image.width);
    full.height = static_cast<std::uint32_t>(image.height);
  }
  if (is_same(size_of(full), image)) {
    return checked(camera_of(full.P[0], full.P[5], full.P[2], full.P[6], image));
  }
  image_geometry::PinholeCameraModel model;
  ImageSize reduced;
  try {
    model.fromCameraInfo(full);
    reduced = {model.reducedResolution().width, model.reducedResolution().height};
  } catch (const std::exception& error) {
    return Error{std::string("camera_info is not usable: ") + error.what()};
  }
  if (!is_same(reduced, image)) {
    const bool is_full = is_same(reduced, size_of(full));
    return Error{"the image is " + text_of(image) + " but camera_info says " +
                 text_of(size_of(full)) +
                 (is_full ? "" : ", " + text_of(reduced) + " with region of interest and binning") +
                 "; use the camera_info of this resolution"};
  }
  return checked(camera_of(model.fx(), model.fy(), model.cx(), model.cy(), image));
}

Result<Camera> camera_from_info(const sensor_msgs::CameraInfo& info) {
  return camera_from_info(info, size_of(info));
}

sensor_msgs::CameraInfo info_from_camera(const Camera& camera, const std_msgs::Header& header) {
  sensor_msgs::CameraInfo info;
  info.header = header;
  info.width = static_cast<std::uint32_t>(camera.width);
  info.height = static_cast<std::uint32_t>(camera.height);
  info.distortion_model = "plumb_bob";
  info.D.assign(5, 0.0);
  info.K = {camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1};
  info.R = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  info.P = {camera.fx, 0, camera.cx, 0, 0, camera.fy, camera.cy, 0, 0, 0, 1, 0};
  return info;
}

std::string doubt_of(const sensor_msgs::CameraInfo& info) {
  std::ostringstream text;
  text.precision(2);
  const double rotation = rotation_degrees(info);
  if (rotation > kLeastRotation) {
    text << "it has a rectification rotation R of " << rotation
         << " deg: the optical frame in tf must be that of the rectified camera, since R is not "
            "applied";
    return text.str();
  }
  const double distortion = distortion_at_corner(info);
  const bool may_be_raw = info.P[0] == 0.0 || (info.P[0] == info.K[0] && info.P[5] == info.K[4]);
  if (may_be_raw && distortion > kLeastDistortion) {
    text << "its lens moves the corners by " << std::lround(distortion)
         << " px and P is no other than K, so the images look unrectified: feed rectified ones "
            "(image_proc), since distortion is not modelled";
  }
  return text.str();
}

}  // namespace rprr
