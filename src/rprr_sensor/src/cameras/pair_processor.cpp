// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_sensor/cameras/pair_processor.hpp"

#include <string>
#include <utility>

namespace rprr {
namespace {

/// Empty if an image has the size that its calibration says.
std::string size_fault(const cv::Mat& image, const Camera& camera, const std::string& what) {
  if (image.cols == camera.width && image.rows == camera.height) return {};
  return what + " images have " + std::to_string(image.cols) + "x" + std::to_string(image.rows) +
         " pixels, their calibration is for " + std::to_string(camera.width) + "x" +
         std::to_string(camera.height) + ": calibrate in the mode that is used";
}

Camera nominal_camera(int width, int height, double focal_length) {
  const double scaled = focal_length * width / 640.0;
  return {width, height, scaled, scaled, 0.5 * (width - 1), 0.5 * (height - 1)};
}

}  // namespace

RgbdCalibration nominal_calibration(int width, int height) {
  RgbdCalibration calibration;
  calibration.colour = LensCalibration::pinhole(nominal_camera(width, height, 525.0));
  calibration.depth = LensCalibration::pinhole(nominal_camera(width, height, 580.0));
  calibration.colour_from_depth.translation().x() = -0.025;
  return calibration;
}

PairProcessor::PairProcessor(const RgbdCalibration& calibration, DepthFormat format,
                             Rectification colour, Rectification depth)
    : calibration_(calibration),
      format_(format),
      colour_(std::move(colour)),
      depth_(std::move(depth)),
      disparity_(calibration.disparity),
      registration_(calibration.depth.rectified, calibration.colour.rectified,
                    calibration.colour_from_depth) {
}

Result<PairProcessor> PairProcessor::create(const RgbdCalibration& calibration,
                                            DepthFormat format) {
  auto colour = Rectification::create(calibration.colour);
  if (!colour) return Error{"colour camera: " + colour.reason()};
  auto depth = Rectification::create(calibration.depth);
  if (!depth) return Error{"depth camera: " + depth.reason()};
  if (!is_rigid(calibration.colour_from_depth)) {
    return Error{"the pose from depth to colour camera is not a rigid motion"};
  }
  return PairProcessor(calibration, format, std::move(*colour), std::move(*depth));
}

Result<RgbdImage> PairProcessor::process(const DevicePair& pair) {
  const bool registered = format_ == DepthFormat::registered_mm;
  const Camera& depth_camera = registered ? calibration_.colour.camera : calibration_.depth.camera;
  std::string fault = size_fault(pair.colour.pixels, calibration_.colour.camera, "colour");
  if (fault.empty()) fault = size_fault(pair.depth.pixels, depth_camera, "depth");
  if (!fault.empty()) return Error{fault};

  RgbdImage image;
  image.bgr = colour_.colour(pair.colour.pixels);
  if (registered) {
    image.depth = {colour_.depth(pair.depth.pixels), 0.001};
    return image;
  }
  DepthFrame seen = format_ == DepthFormat::disparity ? disparity_.depth(pair.depth.pixels)
                                                      : DepthFrame{pair.depth.pixels, 0.001};
  seen.counts = depth_.depth(seen.counts);
  image.depth = registration_.apply(seen);
  return image;
}

}  // namespace rprr
