// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>

#include "rprr_geometry/camera.hpp"
#include "rprr_geometry/depth_frame.hpp"
#include "rprr_geometry/result.hpp"
#include "rprr_geometry/rgbd_image.hpp"
#include "rprr_geometry/se3.hpp"
#include "rprr_geometry/stamp.hpp"

namespace rprr {

/// One entry of a recording, read.
struct RecordedFrame {
  Stamp stamp = 0;  // of the colour image; names the frame
  RgbdImage image;
  std::optional<Pose> world_from_camera;  // optical frame into the world, where known
  std::optional<Stamp> depth_stamp;       // where the depth image has a stamp of its own
};

/// What one RGB-D camera saw, from a folder or from a bag: entries by number, read when asked for.
class Recording {
 public:
  virtual ~Recording() = default;

  virtual const Camera& camera() const = 0;
  virtual std::size_t size() const = 0;
  /// Errors name the file or topic.
  virtual Result<RecordedFrame> load(std::size_t index) = 0;
  /// What a person should know about how the source was understood; empty if nothing.
  virtual std::string remark() const { return {}; }
};

struct RecordingOptions {
  double association_window_s = 0.02;  // colour to depth, where they are not associated yet
  DepthUnits depth{0.001, 0.0002};     // of a bag's images
  std::optional<Camera> camera;        // instead of what the source says
  std::string colour_topic;            // of a bag; empty: found by its name
  std::string depth_topic;             // of a bag; empty: found by its name
};

/// Opens a folder (open_tum_folder) or a bag of one camera. Of a bag's image topics these are
/// taken:
///   colour  .../camera/rgb/image_rect_color, else .../camera/rgb/image_color
///   depth   .../camera/depth_registered/image_rect, else .../camera/depth/image
/// with camera_info beside the colour (without it: options.camera, else tum_default_camera for the
/// bag's name) and poses from .../ground_truth/pose, else from /tf as the colour image's frame in
/// "world". Leading slashes of frames do not matter. The whole bag is read once to learn its
/// stamps.
Result<std::unique_ptr<Recording>> open_recording(const std::string& path,
                                                  const RecordingOptions& options = {});

}  // namespace rprr
