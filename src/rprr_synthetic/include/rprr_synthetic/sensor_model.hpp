// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <opencv2/core/mat.hpp>

#include "rprr_geometry/camera.hpp"
#include "rprr_geometry/depth_frame.hpp"
#include "rprr_geometry/rgbd_image.hpp"
#include "rprr_synthetic/synthetic_scene.hpp"

namespace rprr {

/// A structured-light depth camera of the Kinect's kind, registered to its colour camera.
struct DepthSensorModel {
  double min_metres = 0.5;       // nearer surfaces give no reading [m]
  double max_metres = 5.0;       // farther surfaces give no reading [m]
  double step = 2.85e-3;         // quantisation is step * z^2 [m], that is, even steps of 1/z [1/m]
  double noise = 1.425e-3;       // sigma is noise * z^2 [m] before quantisation [1/m]
  int correlation = 7;           // side of the window that noise is averaged over [px]
  double baseline = 0.075;       // projector to the right of the camera [m]; 0: no shadows
  double edge_jitter = 1.0;      // how far depth edges stray from the true ones, sigma [px]
  double least_infrared = 0.12;  // surfaces that return less give no reading
  bool rim = true;               // no readings along the sides, as registered images have them
};

/// A cheap colour camera with its own idea of exposure and white.
struct ColourSensorModel {
  double exposure = 1.0;
  std::array<double, 3> gain = {1.0, 1.0, 1.0};  // white balance, BGR
  double vignetting = 0.15;                      // light lost in the corners, share
  double blur = 0.6;                             // sigma of the optics, pixels
  double noise = 1.5;                            // sigma at mid grey, of 255
};

/// Depth as the sensor gives it, counts of 1 mm. The same view, camera, model and seed give the
/// same frame.
DepthFrame sense_depth(const ExactView& view, const Camera& camera, const DepthSensorModel& model,
                       std::uint32_t seed);

/// Colour as the sensor gives it, CV_8UC3 (BGR, gamma-coded). The same input gives the same output.
cv::Mat sense_colour(const ExactView& view, const ColourSensorModel& model, std::uint32_t seed);

/// An RGB-D camera: its geometry and its faults.
struct SensorModel {
  Camera camera;
  DepthSensorModel depth;
  ColourSensorModel colour;
};

/// What the sensor delivers at world_from_camera.
RgbdImage sense(const Scene& scene, const SensorModel& sensor, const Pose& world_from_camera,
                std::uint32_t seed);

/// Two sensors that differ as two cheap cameras do: focal length, centre, exposure, white balance.
/// Intrinsics scale with the width; pixels are square.
SensorModel example_sensor_a(int width = 640, int height = 480);
SensorModel example_sensor_b(int width = 640, int height = 480);

}  // namespace rprr
