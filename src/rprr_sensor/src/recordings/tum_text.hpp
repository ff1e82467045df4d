// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "rprr_geometry/result.hpp"
#include "rprr_geometry/se3.hpp"
#include "rprr_geometry/stamp.hpp"

namespace rprr {

/// "1305031790.645155" to nanoseconds without a detour over double, which would lose 100 ns. Whole
/// numbers that are too large for seconds are milliseconds (13 digits), microseconds (16) or
/// nanoseconds (19), as other tools write them. Nothing where it is no number that fits.
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

/// What could be read of a list.
template <typename Entry>
struct TextList {
  std::vector<Entry> entries;
  std::string remark;  // how many lines were left out, with the first of them; empty: none
};

/// Whether a name, as written in a list, is that of a file: names may hold blanks, and further
/// columns may follow them.
using IsFile = std::function<bool(const std::string& name)>;

/// The lists of the TUM benchmark as the field writes them: with a byte order mark, with blanks,
/// tabs, commas or semicolons between columns, with header rows and further columns. Lines that
/// cannot be read are left out. Errors name the file, a line and what was expected: there is no
/// such file, or no line of it could be read.
///
/// rgb.txt, depth.txt: stamp file.
Result<TextList<StampedFile>> read_file_list(const std::string& path, const IsFile& is_file);
/// associations.txt: stamp colour-file stamp depth-file; depth first where the names say so.
Result<TextList<AssociatedFiles>> read_associations(const std::string& path, const IsFile& is_file);
/// groundtruth.txt: stamp tx ty tz qx qy qz qw, ordered by stamp. Where a header names qw before
/// qx, as EuRoC's do, qw comes first.
Result<TextList<StampedPose>> read_poses(const std::string& path);

}  // namespace rprr
