// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_sensor/recordings/tum_writer.hpp"

#include <cmath>
#include <filesystem>
#include <iomanip>
#include <limits>
#include <opencv2/imgcodecs.hpp>

#include "recordings/tum_text.hpp"

namespace rprr {
namespace {

namespace fs = std::filesystem;

bool write_image(const std::string& path, const cv::Mat& image) {
  try {
    return cv::imwrite(path, image);
  } catch (const cv::Exception&) {
    return false;
  }
}

void write_camera(std::ostream& out, const Camera& camera, double depth_unit, bool ground_truth,
                  const std::string& note) {
  out << "# " << note << "\n"
      << std::setprecision(12) << "width: " << camera.width << "\nheight: " << camera.height
      << "\nfx: " << camera.fx << "\nfy: " << camera.fy << "\ncx: " << camera.cx
      << "\ncy: " << camera.cy << "\ndepth_units_per_metre: " << 1.0 / depth_unit
      << "\nground_truth: " << (ground_truth ? "true" : "false") << "\nframe_stride: 1\n";
}

void write_pose(std::ostream& out, Stamp stamp, const Pose& pose) {
  const Eigen::Quaterniond q(pose.rotation());
  const auto& t = pose.translation();
  out << format_stamp(stamp) << std::setprecision(12);
  for (const double value : {t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w()}) out << ' ' << value;
  out << std::endl;
}

}  // namespace

Result<TumWriter> TumWriter::create(const std::string& path, const Camera& camera,
                                    double depth_unit, bool ground_truth, const std::string& note) {
  if (!camera.valid()) return Error{"the camera to write is not valid"};
  if (!std::isfinite(depth_unit) || depth_unit <= 0.0) return Error{"depth unit is not positive"};
  const fs::path root(path);
  std::error_code error;
  if (fs::exists(root / "associations.txt", error)) {
    return Error{path + ": holds a recording already; remove it or choose another folder"};
  }
  fs::create_directories(root / "rgb", error);
  if (!error) fs::create_directories(root / "depth", error);
  if (error) return Error{path + ": cannot be made: " + error.message()};

  TumWriter writer;
  writer.path_ = path;
  writer.camera_ = camera;
  writer.depth_unit_ = depth_unit;
  writer.ground_truth_ = ground_truth;
  std::ofstream yaml(root / "camera.yaml");
  write_camera(yaml, camera, depth_unit, ground_truth, note);
  writer.associations_.open(root / "associations.txt");
  if (ground_truth) {
    writer.poses_.open(root / "groundtruth.txt");
    writer.poses_ << "# timestamp tx ty tz qx qy qz qw, camera to world" << std::endl;
  }
  if (!yaml.flush() || !writer.associations_ || (ground_truth && !writer.poses_)) {
    return Error{path + ": cannot be written to"};
  }
  return writer;
}

Result<RgbdEntry> TumWriter::add(Stamp stamp, const RgbdImage& image,
                                 const std::optional<Pose>& world_from_camera) {
  const cv::Size size(camera_.width, camera_.height);
  if (image.bgr.type() != CV_8UC3 || image.bgr.size() != size) {
    return Error{"colour is not bgr8 of the camera's size"};
  }
  if (image.depth.counts.type() != CV_16UC1 || image.depth.counts.size() != size) {
    return Error{"depth is not of 16 bits and the camera's size"};
  }
  if (std::abs(image.depth.unit - depth_unit_) > 1e-12) {
    return Error{"depth has another unit than the folder"};
  }
  if (stamp < 0 || (last_ && stamp <= *last_)) return Error{"stamps do not ascend"};
  if (ground_truth_ && (!world_from_camera || !is_rigid(*world_from_camera))) {
    return Error{"the pose of the entry is missing or not a rigid motion"};
  }
  const std::string name = format_stamp(stamp);
  const fs::path root(path_);
  RgbdEntry entry{stamp, stamp, (root / "rgb" / (name + ".png")).string(),
                  (root / "depth" / (name + ".png")).string(), world_from_camera};
  if (!write_image(entry.colour_path, image.bgr)) {
    return Error{entry.colour_path + ": cannot be written"};
  }
  if (!write_image(entry.depth_path, image.depth.counts)) {
    return Error{entry.depth_path + ": cannot be written"};
  }
  associations_ << name << " rgb/" << name << ".png " << name << " depth/" << name << ".png"
                << std::endl;
  if (ground_truth_) write_pose(poses_, stamp, *world_from_camera);
  if (!associations_ || (ground_truth_ && !poses_)) {
    return Error{path_ + ": cannot be written to (disk full?)"};
  }
  last_ = stamp;
  return entry;
}

}  // namespace rprr
