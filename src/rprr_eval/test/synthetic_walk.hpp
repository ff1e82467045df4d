// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "rprr_sensor/recordings/tum_writer.hpp"
#include "rprr_synthetic/sensor_model.hpp"
#include "rprr_synthetic/trajectory.hpp"

namespace rprr {

/// The room that these tests see, built once a process.
inline const Scene& test_room() {
  static const Scene room = make_room(1);
  return room;
}

/// Frames of a walk, by their numbers in it: neighbours overlap (0.06 m, 4 deg), those 50 apart
/// look the other way.
struct WalkFrame {
  Pose world_from_camera;
  RgbdImage image;
};
inline WalkFrame walk_frame(int number, int width = 320, int height = 240) {
  const Pose pose = single_walk(number + 1, 1).back();
  return {pose, sense(test_room(), example_sensor_a(width, height), pose,
                      static_cast<std::uint32_t>(number))};
}

/// A folder in the TUM layout with those frames of the walk.
inline void write_walk(const std::string& path, const std::vector<int>& numbers, int width = 320,
                       int height = 240) {
  auto writer =
      TumWriter::create(path, example_sensor_a(width, height).camera, 0.001, true, "a test's walk");
  ASSERT_TRUE(writer) << writer.reason();
  Stamp stamp = 0;
  for (const int number : numbers) {
    const WalkFrame frame = walk_frame(number, width, height);
    const auto added =
        writer->add(stamp += from_seconds(1.0), frame.image, frame.world_from_camera);
    ASSERT_TRUE(added) << added.reason();
  }
}

}  // namespace rprr
