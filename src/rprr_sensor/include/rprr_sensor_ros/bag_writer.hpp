// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "rprr_geometry/camera.hpp"
#include "rprr_geometry/result.hpp"
#include "rprr_sensor_ros/recording.hpp"

namespace rosbag {
class Bag;
}

namespace rprr {

enum class DepthEncoding {
  automatic,    // 16UC1 where the unit is 1 mm, else 32FC1
  millimetres,  // 16UC1; refused where it would round
  metres        // 32FC1, whole multiples of the unit
};

/// Whose topics and frames a bag has.
enum class BagShape {
  rprr,  // /<robot>/camera/..., <robot>_rgb_optical_frame, /<robot>/ground_truth/pose
  tum    // /camera/..., 32FC1, slash-prefixed frames, poses on /tf: as the TUM benchmark's bags
};

/// Writes what RGB-D cameras saw into one bag, which is whole or not there: it is written beside
/// its place, as PATH.part, and finish() renames it. Without finish() the part is removed.
class BagWriter {
 public:
  /// `compression` is none, bz2 or lz4. An existing file is replaced at the end.
  static Result<BagWriter> create(const std::string& path, const std::string& compression);
  BagWriter(BagWriter&&) noexcept;
  BagWriter& operator=(BagWriter&&) noexcept;
  ~BagWriter();

  /// Writes a frame, its camera_info and its pose. `robot` names topics and frames of the rprr
  /// shape, where colour and depth have one stamp; in the tum shape depth keeps its own. Returns
  /// the number of messages. Errors: a stamp that bags cannot hold (zero, negative), an encoding
  /// that would round, a full disk.
  Result<int> add(const RecordedFrame& frame, const Camera& camera, const std::string& robot,
                  BagShape shape, DepthEncoding encoding);

  /// Closes the bag and puts it in its place; nothing can be added any more. The path, or why it
  /// is not there.
  Result<std::string> finish();

 private:
  BagWriter(const std::string& path, std::unique_ptr<rosbag::Bag> bag);

  std::string path_;
  std::unique_ptr<rosbag::Bag> bag_;
};

}  // namespace rprr
