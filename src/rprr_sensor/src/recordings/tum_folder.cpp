// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_sensor/recordings/tum_folder.hpp"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>

#include "recordings/tum_text.hpp"
#include "rprr_sensor/recordings/association.hpp"

namespace rprr {
namespace {

namespace fs = std::filesystem;

constexpr double kTumUnitsPerMetre = 5000.0;

bool is_file(const fs::path& path) {
  std::error_code ignored;
  return fs::is_regular_file(path, ignored);
}

struct CameraFile {
  Camera camera;
  double units_per_metre = kTumUnitsPerMetre;
  bool ground_truth = true;
  int frame_stride = 1;
};

Result<CameraFile> read_camera_file(const std::string& path) {
  CameraFile file;
  try {
    const YAML::Node yaml = YAML::LoadFile(path);
    for (const char* key : {"width", "height", "fx", "fy", "cx", "cy", "depth_units_per_metre"}) {
      if (!yaml[key]) return Error{path + ": the key '" + key + "' is missing"};
    }
    file.camera.width = yaml["width"].as<int>();
    file.camera.height = yaml["height"].as<int>();
    file.camera.fx = yaml["fx"].as<double>();
    file.camera.fy = yaml["fy"].as<double>();
    file.camera.cx = yaml["cx"].as<double>();
    file.camera.cy = yaml["cy"].as<double>();
    file.units_per_metre = yaml["depth_units_per_metre"].as<double>();
    if (yaml["ground_truth"]) file.ground_truth = yaml["ground_truth"].as<bool>();
    if (yaml["frame_stride"]) file.frame_stride = yaml["frame_stride"].as<int>();
  } catch (const YAML::Exception& e) {
    return Error{path + ": " + e.what()};
  }
  if (!file.camera.valid()) {
    return Error{path + ": sizes must be 1 to " + std::to_string(kMaxImageSide) +
                 ", focal lengths positive, all numbers finite"};
  }
  if (!std::isfinite(file.units_per_metre) || file.units_per_metre <= 0.0) {
    return Error{path + ": depth_units_per_metre must be a positive number"};
  }
  if (file.frame_stride < 1) return Error{path + ": frame_stride must be at least 1"};
  return file;
}

Result<std::vector<AssociatedFiles>> associate_lists(const fs::path& folder, double window_s) {
  const auto colour = read_file_list((folder / "rgb.txt").string());
  if (!colour) return Error{colour.reason()};
  const auto depth = read_file_list((folder / "depth.txt").string());
  if (!depth) return Error{depth.reason()};
  const auto stamps_of = [](const std::vector<StampedFile>& files) {
    std::vector<Stamp> stamps;
    for (const auto& file : files) stamps.push_back(file.stamp);
    return stamps;
  };
  std::vector<AssociatedFiles> associations;
  for (const auto& [c, d] :
       associate(stamps_of(*colour), stamps_of(*depth), from_seconds(window_s))) {
    associations.push_back({(*colour)[c], (*depth)[d]});
  }
  return associations;
}

Result<std::vector<AssociatedFiles>> find_entries(const fs::path& folder, double window_s) {
  const fs::path associations = folder / "associations.txt";
  if (is_file(associations)) return read_associations(associations.string());
  if (is_file(folder / "rgb.txt") && is_file(folder / "depth.txt")) {
    return associate_lists(folder, window_s);
  }
  return Error{folder.string() +
               ": has neither associations.txt nor rgb.txt and depth.txt; give a folder in the "
               "layout of the TUM RGB-D benchmark (unpack a .tgz first)"};
}

/// The error, if there is one.
std::optional<Error> attach_poses(const std::string& path, double window_s,
                                  std::vector<RgbdEntry>& entries) {
  const auto poses = read_poses(path);
  if (!poses) return Error{poses.reason()};
  std::vector<Stamp> stamps;
  for (const auto& pose : *poses) stamps.push_back(pose.stamp);
  for (auto& entry : entries) {
    const auto index = nearest_stamp(stamps, entry.stamp, from_seconds(window_s));
    if (index) entry.world_from_camera = (*poses)[*index].world_from_camera;
  }
  return std::nullopt;
}

/// An empty image where it cannot be read for whatever reason.
cv::Mat read_image(const std::string& path, int flags) {
  try {
    return cv::imread(path, flags);
  } catch (const cv::Exception&) {
    return {};
  }
}

std::string size_text(int width, int height) {
  return std::to_string(width) + "x" + std::to_string(height);
}

std::string image_problem(const std::string& path, const cv::Mat& image, const Camera& camera) {
  if (image.empty()) {
    return path + ": " + (is_file(path) ? "is not an image that can be read" : "does not exist");
  }
  if (image.cols != camera.width || image.rows != camera.height) {
    return path + ": is " + size_text(image.cols, image.rows) + ", the camera of the folder " +
           size_text(camera.width, camera.height) + "; mend width and height in camera.yaml";
  }
  return {};
}

}  // namespace

Camera tum_default_camera(const std::string& name) {
  const auto has = [&](const char* part) { return name.find(part) != std::string::npos; };
  // https://cvg.cit.tum.de/data/datasets/rgbd-dataset/file_formats
  if (has("freiburg1")) return {640, 480, 517.3, 516.5, 318.6, 255.3};
  if (has("freiburg2")) return {640, 480, 520.9, 521.0, 325.1, 249.7};
  if (has("freiburg3")) return {640, 480, 535.4, 539.2, 320.1, 247.6};
  return {640, 480, 525.0, 525.0, 319.5, 239.5};
}

Result<TumFolder> open_tum_folder(const std::string& path, const TumFolderOptions& options) {
  std::error_code ignored;
  const fs::path root(path);
  if (!fs::is_directory(root, ignored)) return Error{path + ": is not a folder"};

  CameraFile camera;
  camera.camera = tum_default_camera(fs::absolute(root, ignored).lexically_normal().string());
  if (is_file(root / "camera.yaml")) {
    auto read = read_camera_file((root / "camera.yaml").string());
    if (!read) return Error{read.reason()};
    camera = *read;
  }
  const auto files = find_entries(root, options.association_window_s);
  if (!files) return Error{files.reason()};
  if (files->empty()) return Error{path + ": no colour image has a depth image that belongs to it"};

  TumFolder folder;
  folder.path = path;
  folder.camera = camera.camera;
  folder.depth_unit = 1.0 / camera.units_per_metre;
  folder.frame_stride = camera.frame_stride;
  for (const auto& pair : *files) {
    folder.entries.push_back({pair.colour.stamp, pair.depth.stamp,
                              (root / pair.colour.file).string(), (root / pair.depth.file).string(),
                              std::nullopt});
  }
  std::stable_sort(folder.entries.begin(), folder.entries.end(),
                   [](const RgbdEntry& a, const RgbdEntry& b) { return a.stamp < b.stamp; });
  const fs::path poses = root / "groundtruth.txt";
  if (camera.ground_truth && is_file(poses)) {
    const auto error = attach_poses(poses.string(), options.ground_truth_window_s, folder.entries);
    if (error) return *error;
  }
  return folder;
}

Result<RgbdImage> TumFolder::load(const RgbdEntry& entry) const {
  RgbdImage image;
  image.bgr = read_image(entry.colour_path, cv::IMREAD_COLOR);
  const std::string colour_problem = image_problem(entry.colour_path, image.bgr, camera);
  if (!colour_problem.empty()) return Error{colour_problem};
  image.depth.counts = read_image(entry.depth_path, cv::IMREAD_UNCHANGED);
  image.depth.unit = depth_unit;
  const std::string depth_problem = image_problem(entry.depth_path, image.depth.counts, camera);
  if (!depth_problem.empty()) return Error{depth_problem};
  if (image.depth.counts.type() != CV_16UC1) {
    return Error{entry.depth_path + ": depth must be one channel of 16 bits (16-bit grey PNG)"};
  }
  return image;
}

Result<RgbdImage> TumFolder::load(std::size_t index) const {
  if (index >= entries.size()) {
    return Error{path + ": has " + std::to_string(entries.size()) + " entries, none has number " +
                 std::to_string(index)};
  }
  return load(entries[index]);
}

}  // namespace rprr
