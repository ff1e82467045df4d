// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "rprr_eval/measure/frame_source.hpp"
#include "rprr_geometry/relative_pose.hpp"
#include "rprr_synthetic/sensor_model.hpp"
#include "rprr_synthetic/trajectory.hpp"
#include "rprr_wire/camera_wire.hpp"

namespace rprr {

/// Two views of the synthetic room with noise and colour, and their M_ab.
struct RoomViews {
  RgbdFrame a, b;
  Pose truth;
};

inline RoomViews room_views(double metres, double degrees) {
  const Scene room = make_room(1);
  const SensorModel sensor = example_sensor_a(320, 240);
  const Pose at_a = look_along({0.2, 0.1, 1.3}, 0.4, -0.2, 0.0);
  const Pose at_b = look_along({0.2, 0.1 + metres, 1.3}, 0.4 + degrees * M_PI / 180.0, -0.2, 0.0);
  RoomViews views;
  views.truth = relative_pose_of(at_a, at_b);
  const auto fill = [&](RgbdFrame& frame, const Pose& pose, std::uint32_t noise) {
    const RgbdImage image = sense(room, sensor, pose, noise);
    frame.stamp = from_seconds(1.0);
    frame.camera = rounded_for_wire(sensor.camera);
    frame.depth = image.depth;
    frame.bgr = image.bgr;
  };
  fill(views.a, at_a, 1);
  fill(views.b, at_b, 2);
  return views;
}

}  // namespace rprr
