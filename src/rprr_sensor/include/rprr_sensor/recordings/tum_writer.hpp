// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <fstream>
#include <optional>
#include <string>

#include "rprr_sensor/recordings/tum_folder.hpp"

namespace rprr {

/// Writes a folder that open_tum_folder reads: PNG images, associations.txt, groundtruth.txt and
/// camera.yaml. Every entry is on disk when add() returns.
class TumWriter {
 public:
  /// Makes the folder (and its parents) and camera.yaml. An existing recording is not overwritten.
  /// `note` is a comment at the head of camera.yaml.
  static Result<TumWriter> create(const std::string& path, const Camera& camera, double depth_unit,
                                  bool ground_truth, const std::string& note);

  /// Appends an entry; stamps must ascend. Sizes, the depth unit and, with ground truth, the pose
  /// are checked. Errors name the file.
  Result<RgbdEntry> add(Stamp stamp, const RgbdImage& image,
                        const std::optional<Pose>& world_from_camera);

 private:
  TumWriter() = default;

  std::string path_;
  Camera camera_;
  double depth_unit_ = 0.0;
  bool ground_truth_ = false;
  std::optional<Stamp> last_;
  std::ofstream associations_;
  std::ofstream poses_;
};

}  // namespace rprr
