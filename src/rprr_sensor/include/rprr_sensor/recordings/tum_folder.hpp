// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "rprr_geometry/camera.hpp"
#include "rprr_geometry/result.hpp"
#include "rprr_geometry/rgbd_image.hpp"
#include "rprr_geometry/se3.hpp"
#include "rprr_geometry/stamp.hpp"

namespace rprr {

/// One colour image and the depth image that belongs to it.
struct RgbdEntry {
  Stamp stamp = 0;                        // of the colour image; names the entry
  Stamp depth_stamp = 0;                  // of the depth image
  std::string colour_path;                // absolute, or relative to the working directory
  std::string depth_path;                 // absolute, or relative to the working directory
  std::optional<Pose> world_from_camera;  // optical frame into the world, where known
};

struct TumFolderOptions {
  double association_window_s = 0.02;   // colour to depth, where there is no associations.txt
  double ground_truth_window_s = 0.02;  // colour stamp to nearest pose
};

/// A recording of one RGB-D camera in the layout of the TUM RGB-D benchmark, depth registered to
/// colour.
struct TumFolder {
  std::string path;
  Camera camera;
  double depth_unit = 0.001;       // metres per count
  int frame_stride = 1;            // original frames between two entries
  std::vector<RgbdEntry> entries;  // ascending stamps
  /// What a person should know about how the folder was understood: lines left out, poses that
  /// meet no image, a focal length that was turned round. Empty: nothing.
  std::string remark;

  /// Reads the images of an entry, as the sensor gave them: an orientation noted by EXIF is not
  /// applied, since depth would not turn with it. Errors name the file: not there, not an image or
  /// cut off, another size than the camera's, depth that is not of 16 bits.
  Result<RgbdImage> load(const RgbdEntry& entry) const;
  /// The same by number; an error where there is no such entry.
  Result<RgbdImage> load(std::size_t index) const;
};

/// Opens either of two layouts; images are not read yet.
///
/// With `camera.yaml` (width, height, fx, fy, cx, cy, depth_units_per_metre; optional ground_truth
/// and frame_stride). Without it the folder counts as an original TUM sequence: 640x480, 5000 depth
/// units per metre, intrinsics by the name of the folder (freiburg1, freiburg2, freiburg3), else
/// 525, 525, 319.5, 239.5.
///
/// Entries come from `associations.txt` (lines `stamp colour-file stamp depth-file`), else from
/// `rgb.txt` and `depth.txt` (lines `stamp file`), associated by their stamps. `groundtruth.txt`
/// (lines `stamp tx ty tz qx qy qz qw`, camera to world) is used where it is there, unless
/// camera.yaml says `ground_truth: false`; entries without a pose near enough have none.
///
/// Lines that start with '#' and empty lines are skipped; other lines that cannot be read are left
/// out and told in the remark. Errors name the file, the line and what to do: no line of a list
/// can be read, or camera.yaml is not usable.
Result<TumFolder> open_tum_folder(const std::string& path, const TumFolderOptions& options = {});

/// What the ROS community and the TUM benchmark use for a Kinect whose sequence or camera name
/// contains freiburg1, freiburg2 or freiburg3, else 525, 525, 319.5, 239.5. 640x480.
Camera tum_default_camera(const std::string& name);

}  // namespace rprr
