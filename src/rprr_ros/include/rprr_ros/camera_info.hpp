// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sensor_msgs/CameraInfo.h>

#include <string>

#include "rprr_geometry/camera.hpp"
#include "rprr_geometry/result.hpp"

namespace rprr {

/// Size of an image [px].
struct ImageSize {
  int width = 0;
  int height = 0;
};
/// "640x480".
std::string text_of(const ImageSize& size);

/// Intrinsics of a rectified image of that size: P where it is set, else K. Region of interest and
/// binning are applied as sensor_msgs/CameraInfo defines them, unless the image has the full size
/// in spite of them. Where camera_info leaves its size at 0, it is the image's.
///
/// Errors: no usable intrinsics; a size that is not the image's, with both.
Result<Camera> camera_from_info(const sensor_msgs::CameraInfo& info, const ImageSize& image);
/// The same for an image of the size that camera_info says.
Result<Camera> camera_from_info(const sensor_msgs::CameraInfo& info);

/// A rectified camera without distortion; intrinsics in K and P.
sensor_msgs::CameraInfo info_from_camera(const Camera& camera, const std_msgs::Header& header);

/// What camera_info says and RPRR does not model, with the remedy: lens distortion of an image that
/// is hardly rectified, or a rectification rotation. Empty: nothing.
std::string doubt_of(const sensor_msgs::CameraInfo& info);

}  // namespace rprr
