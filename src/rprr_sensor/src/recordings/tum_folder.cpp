// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_sensor/recordings/tum_folder.hpp"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <limits>
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
  std::string remark;
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
  if (file.camera.fy < 0.0) {  // ICL-NUIM writes it so, for a y axis that points up
    file.camera.fy = -file.camera.fy;
    file.remark = path + ": fy is negative; taken as " + std::to_string(file.camera.fy) +
                  ", with y down as images have it. True poses must be of that frame";
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

// What is told of a folder: each on a line of its own.
void add_remark(std::string& remark, const std::string& text) {
  if (text.empty()) return;
  remark += (remark.empty() ? "" : "\n") + text;
}

Result<std::vector<AssociatedFiles>> associate_lists(const fs::path& folder, double window_s,
                                                     const IsFile& is_listed, std::string& remark) {
  const auto colour = read_file_list((folder / "rgb.txt").string(), is_listed);
  if (!colour) return Error{colour.reason()};
  const auto depth = read_file_list((folder / "depth.txt").string(), is_listed);
  if (!depth) return Error{depth.reason()};
  add_remark(remark, colour->remark);
  add_remark(remark, depth->remark);
  const auto stamps_of = [](const std::vector<StampedFile>& files) {
    std::vector<Stamp> stamps;
    stamps.reserve(files.size());
    for (const auto& file : files) stamps.push_back(file.stamp);
    return stamps;
  };
  std::vector<AssociatedFiles> associations;
  for (const auto& [c, d] :
       associate(stamps_of(colour->entries), stamps_of(depth->entries), from_seconds(window_s))) {
    associations.push_back({colour->entries[c], depth->entries[d]});
  }
  return associations;
}

Result<std::vector<AssociatedFiles>> find_entries(const fs::path& folder, double window_s,
                                                  std::string& remark) {
  const IsFile is_listed = [&](const std::string& name) { return is_file(folder / name); };
  const fs::path associations = folder / "associations.txt";
  if (is_file(associations)) {
    const auto list = read_associations(associations.string(), is_listed);
    if (!list) return Error{list.reason()};
    add_remark(remark, list->remark);
    return list->entries;
  }
  if (is_file(folder / "rgb.txt") && is_file(folder / "depth.txt")) {
    return associate_lists(folder, window_s, is_listed, remark);
  }
  return Error{folder.string() +
               ": has neither associations.txt nor rgb.txt and depth.txt; give a folder in the "
               "layout of the TUM RGB-D benchmark (unpack a .tgz first)"};
}

std::string seconds_text(Duration duration) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g s", to_seconds(duration));
  return text;
}

// How far the first image is from any pose.
Duration distance(const std::vector<Stamp>& poses, Stamp stamp) {
  Duration least = std::numeric_limits<Duration>::max();
  for (const Stamp pose : poses) least = std::min(least, std::abs(pose - stamp));
  return least;
}

/// The error, if there is one.
std::optional<Error> attach_poses(const std::string& path, double window_s, TumFolder& folder) {
  const auto poses = read_poses(path);
  if (!poses) return Error{poses.reason()};
  add_remark(folder.remark, poses->remark);
  std::vector<Stamp> stamps;
  for (const auto& pose : poses->entries) stamps.push_back(pose.stamp);
  std::size_t met = 0;
  for (auto& entry : folder.entries) {
    const auto index = nearest_stamp(stamps, entry.stamp, from_seconds(window_s));
    if (!index) continue;
    entry.world_from_camera = poses->entries[*index].world_from_camera;
    ++met;
  }
  if (met == 0 && !stamps.empty()) {
    add_remark(folder.remark,
               path + ": none of its " + std::to_string(stamps.size()) + " poses is within " +
                   seconds_text(from_seconds(window_s)) + " of an image; the first image is " +
                   seconds_text(distance(stamps, folder.entries.front().stamp)) +
                   " from the nearest: are they of another recording or another clock?");
  }
  return std::nullopt;
}

// A JPEG that is cut off ends without its end marker; libjpeg fills the rest with grey.
bool is_cut_jpeg(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  char begin[2] = {};
  if (!file.read(begin, 2) || begin[0] != '\xff' || begin[1] != '\xd8') return false;
  constexpr std::streamoff kTail = 4096;  // some writers pad the end
  file.seekg(0, std::ios::end);
  const std::streamoff size = file.tellg();
  const std::streamoff from = std::max<std::streamoff>(2, size - kTail);
  file.seekg(from);
  std::string tail(static_cast<std::size_t>(size - from), '\0');
  file.read(tail.data(), size - from);
  return tail.find("\xff\xd9") == std::string::npos;
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
  if (is_cut_jpeg(path)) return path + ": is cut off: the JPEG has no end";
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
  TumFolder folder;
  add_remark(folder.remark, camera.remark);
  const auto files = find_entries(root, options.association_window_s, folder.remark);
  if (!files) return Error{files.reason()};
  if (files->empty()) return Error{path + ": no colour image has a depth image that belongs to it"};

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
    const auto error = attach_poses(poses.string(), options.ground_truth_window_s, folder);
    if (error) return *error;
  }
  return folder;
}

Result<RgbdImage> TumFolder::load(const RgbdEntry& entry) const {
  RgbdImage image;
  image.bgr = read_image(entry.colour_path, cv::IMREAD_COLOR | cv::IMREAD_IGNORE_ORIENTATION);
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
