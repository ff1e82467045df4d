// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_sensor/cameras/rectification.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <string>

namespace rprr {
namespace {

cv::Matx33d matrix(const Camera& camera) {
  return {camera.fx, 0.0, camera.cx, 0.0, camera.fy, camera.cy, 0.0, 0.0, 1.0};
}

bool same(const Camera& one, const Camera& two) {
  return one.width == two.width && one.height == two.height && one.fx == two.fx &&
         one.fy == two.fy && one.cx == two.cx && one.cy == two.cy;
}

}  // namespace

Result<Rectification> Rectification::create(const LensCalibration& calibration) {
  const auto& distortion = calibration.distortion;
  if (!calibration.camera.valid() || !calibration.rectified.valid()) {
    return Error{
        "the calibration is not that of a camera: sizes and focal lengths must be above 0"};
  }
  const std::size_t count = distortion.size();
  if (count != 0 && count != 4 && count != 5 && count != 8) {
    return Error{
        "a lens has 0, 4, 5 or 8 distortion coefficients (plumb_bob, "
        "rational_polynomial), not " +
        std::to_string(count)};
  }
  if (!std::all_of(distortion.begin(), distortion.end(),
                   [](double d) { return std::isfinite(d); })) {
    return Error{"the distortion coefficients are not all finite"};
  }
  Rectification rectification;
  const bool straight =
      std::all_of(distortion.begin(), distortion.end(), [](double d) { return d == 0.0; });
  if (straight && same(calibration.camera, calibration.rectified)) return rectification;
  const cv::Size size(calibration.rectified.width, calibration.rectified.height);
  cv::Mat x, y;
  cv::initUndistortRectifyMap(matrix(calibration.camera), distortion, cv::noArray(),
                              matrix(calibration.rectified), size, CV_32FC1, x, y);
  cv::convertMaps(x, y, rectification.map_, rectification.interpolation_, CV_16SC2, false);
  cv::Mat unused;
  cv::convertMaps(x, y, rectification.nearest_, unused, CV_16SC2, true);
  return rectification;
}

cv::Mat Rectification::colour(const cv::Mat& image) const {
  if (!needed()) return image;
  cv::Mat rectified;
  cv::remap(image, rectified, map_, interpolation_, cv::INTER_LINEAR, cv::BORDER_CONSTANT);
  return rectified;
}

cv::Mat Rectification::depth(const cv::Mat& counts) const {
  if (!needed()) return counts;
  cv::Mat rectified;
  cv::remap(counts, rectified, nearest_, cv::noArray(), cv::INTER_NEAREST, cv::BORDER_CONSTANT);
  return rectified;
}

}  // namespace rprr
