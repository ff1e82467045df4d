// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_station/scene_cloud.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>

#include "rprr_geometry/pixel_map.hpp"

namespace rprr {
namespace {

bool is_whole_image(const RebuiltFrame& frame) {
  const cv::Size size(frame.camera.width, frame.camera.height);
  return frame.camera.valid() && frame.bgr.size() == size && frame.bgr.type() == CV_8UC3 &&
         frame.depth.counts.size() == size && frame.depth.counts.type() == CV_16UC1 &&
         frame.depth.unit > 0;
}

// The reference's frame to this one's.
Pose motion_of(const RebuiltFrame& frame) {
  return frame.sparse ? frame.b_from_a : Pose::Identity();
}

// Whether a view shows the surface of points that another one sees.
class Onlooker {
 public:
  Onlooker(const RebuiltFrame& view, const RebuiltFrame& other, const SceneCloudOptions& options)
      : counts_(view.depth.counts),
        unit_(static_cast<float>(view.depth.unit)),
        map_(other.camera, view.camera, motion_of(view) * motion_of(other).inverse(),
             other.depth.unit),
        options_(options) {}

  bool shows(int u, int v, float counts) const {
    const Eigen::Vector3f at =
        counts * (map_.row(v) + static_cast<float>(u) * map_.step) + map_.offset;
    if (!(at.z() >= kNearestDepth)) return false;
    const float x = std::floor(at.x() / at.z() + 0.5f);
    const float y = std::floor(at.y() / at.z() + 0.5f);
    // A pixel out of the image still lies beside one in it.
    if (!(x >= -1.0f && y >= -1.0f && x <= static_cast<float>(counts_.cols) &&
          y <= static_cast<float>(counts_.rows))) {
      return false;
    }
    const float range = options_.agree_metres + options_.agree_share * at.z();
    const int column = static_cast<int>(x);
    const int row = static_cast<int>(y);
    for (int j = std::max(row - 1, 0); j <= std::min(row + 1, counts_.rows - 1); ++j) {
      const auto* depth = counts_.ptr<std::uint16_t>(j);
      for (int i = std::max(column - 1, 0); i <= std::min(column + 1, counts_.cols - 1); ++i) {
        if (depth[i] != 0 && std::abs(unit_ * static_cast<float>(depth[i]) - at.z()) <= range) {
          return true;
        }
      }
    }
    return false;
  }

 private:
  const cv::Mat& counts_;
  float unit_;
  PixelMap map_;
  const SceneCloudOptions& options_;
};

// Points of a frame that none of the others shows, of each step-th row and column.
void add_points(const RebuiltFrame& frame, const std::vector<Onlooker>& others, int step,
                std::vector<ScenePoint>& points) {
  const Pose to_reference = motion_of(frame).inverse();
  const BlockGrid grid(frame.camera.width, frame.camera.height);
  const auto is_new = [&](int u, int v, std::uint16_t counts) {
    if (frame.sparse && !frame.received_depth[grid.index_of_pixel(u, v)]) return false;
    return std::none_of(others.begin(), others.end(), [&](const Onlooker& other) {
      return other.shows(u, v, static_cast<float>(counts));
    });
  };
  for (int v = 0; v < frame.camera.height; v += step) {
    const auto* depth = frame.depth.counts.ptr<std::uint16_t>(v);
    const auto* colours = frame.bgr.ptr<std::uint8_t>(v);
    for (int u = 0; u < frame.camera.width; u += step) {
      if (depth[u] == 0 || !is_new(u, v, depth[u])) continue;
      const Eigen::Vector3d point =
          to_reference * frame.camera.unproject(u, v, depth[u] * frame.depth.unit);
      const auto* colour = colours + 3 * u;
      points.push_back({point.cast<float>(), {colour[0], colour[1], colour[2]}});
    }
  }
}

}  // namespace

SceneCloud::SceneCloud(SceneCloudOptions options) : options_(options) {
  options_.references = std::max<std::size_t>(options_.references, 1);
  options_.views = std::max<std::size_t>(options_.views, 1);
  options_.most_points = std::max<std::size_t>(options_.most_points, 1);
}

bool SceneCloud::add(const RebuiltFrame& frame) {
  if (!is_whole_image(frame)) return false;
  if (!frame.sparse) {
    auto& held = held_[frame.robot];
    if (Held* same = find(frame.robot, frame.stamp)) {
      *same = {frame, {}};
      return false;
    }
    if (held.size() >= options_.references) held.pop_front();
    held.push_back({frame, {}});
    return false;
  }
  const BlockGrid& grid = frame.received_depth.grid();
  Held* held = find(frame.reference, frame.reference_stamp);
  if (held == nullptr || grid.width != frame.camera.width || grid.height != frame.camera.height ||
      !is_rigid(frame.b_from_a)) {
    return false;
  }
  auto& views = held->views;
  const auto same = [&](const RebuiltFrame& view) { return view.robot == frame.robot; };
  views.erase(std::remove_if(views.begin(), views.end(), same), views.end());
  if (views.size() >= options_.views) views.pop_front();
  views.push_back(frame);
  latest_robot_ = frame.reference;
  latest_stamp_ = frame.reference_stamp;
  return true;
}

void SceneCloud::make(Scene& scene) const {
  scene = Scene{{}, {}, 0, std::move(scene.points)};
  scene.points.clear();
  const auto robot = held_.find(latest_robot_);
  if (robot == held_.end()) return;
  const auto held = std::find_if(robot->second.begin(), robot->second.end(), [&](const Held& one) {
    return one.reference.stamp == latest_stamp_;
  });
  if (held == robot->second.end()) return;
  scene.robot = held->reference.robot;
  scene.frame_id = held->reference.frame_id;
  scene.stamp = held->reference.stamp;

  std::vector<const RebuiltFrame*> frames{&held->reference};
  for (const RebuiltFrame& view : held->views) frames.push_back(&view);
  std::size_t most = 0;
  for (const RebuiltFrame* frame : frames) most += frame->depth.counts.total();
  int step = 1;
  const auto kept = [&] {
    const auto apart = static_cast<std::size_t>(step);
    return most / (apart * apart);
  };
  while (kept() > options_.most_points) ++step;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    std::vector<Onlooker> others;
    for (std::size_t k = 0; k < i; ++k) others.emplace_back(*frames[k], *frames[i], options_);
    add_points(*frames[i], others, step, scene.points);
  }
}

void SceneCloud::clear() {
  held_.clear();
}

SceneCloud::Held* SceneCloud::find(const std::string& robot, Stamp stamp) {
  const auto found = held_.find(robot);
  if (found == held_.end()) return nullptr;
  for (Held& held : found->second) {
    if (held.reference.stamp == stamp) return &held;
  }
  return nullptr;
}

}  // namespace rprr
