// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "rprr_geometry/result.hpp"
#include "rprr_geometry/se3.hpp"
#include "rprr_geometry/stamp.hpp"

namespace rprr {

/// "1305031790.645155" to nanoseconds without a detour over double, which would lose 100 ns.
/// Nothing where it is not a plain decimal number that fits.
std::optional<Stamp> parse_stamp(const std::string& text);
/// Seconds with nine decimals: what parse_stamp reads back exactly.
std::string format_stamp(Stamp stamp);

struct StampedFile {
  Stamp stamp = 0;
  std::string file;  // as written in the list
};
struct AssociatedFiles {
  StampedFile colour;
  StampedFile depth;
};
struct StampedPose {
  Stamp stamp = 0;
  Pose world_from_camera = Pose::Identity();
};

/// rgb.txt, depth.txt. Errors of all three name the file, the line and what was expected.
Result<std::vector<StampedFile>> read_file_list(const std::string& path);
/// associations.txt.
Result<std::vector<AssociatedFiles>> read_associations(const std::string& path);
/// groundtruth.txt, ordered by stamp.
Result<std::vector<StampedPose>> read_poses(const std::string& path);

}  // namespace rprr
