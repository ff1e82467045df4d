// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <string>
#include <vector>

#include "rprr_geometry/stamp.hpp"
#include "rprr_station/station.hpp"

namespace rprr {

struct SceneCloudOptions {
  /// Two depths are of one surface if they differ by less than this: metres plus a share of depth.
  float agree_metres = 0.02f;
  float agree_share = 0.015f;
  std::size_t references = 4;           // whole frames kept per robot, for sparse frames to come
  std::size_t views = 4;                // sparse frames kept per reference; the oldest goes
  std::size_t most_points = 1'000'000;  // of a scene; beyond, only each k-th row and column counts
};

struct ScenePoint {
  Eigen::Vector3f position;  // in the reference's optical frame [m]
  std::array<std::uint8_t, 3> bgr;
};

/// One scene from all that saw it at a time.
struct Scene {
  std::string robot;     // the reference
  std::string frame_id;  // as it wrote it
  Stamp stamp = 0;       // of its frame
  std::vector<ScenePoint> points;
};

/// Joins the station's views into one cloud in which no surface is there twice: all of the
/// reference's points, and of each sparse frame that refers to it those that are new. New is what
/// the sender sent depth of (all other depth of a sparse frame came from the reference itself) and
/// what neither the reference nor a view before it shows: where the point would be in their depth
/// images there is, a pixel around, no depth that agrees.
///
/// Keeps frames (their images are shared, not copied) in bounded number; one object serves one
/// thread.
class SceneCloud {
 public:
  explicit SceneCloud(SceneCloudOptions options = {});

  /// Takes in a frame as the station rebuilt it. True if it makes a scene: it is sparse and its
  /// reference is known.
  bool add(const RebuiltFrame& frame);
  /// The scene of the sparse frame for which add() was true last; nothing if there is none. The
  /// points' memory is used again.
  void make(Scene& scene) const;
  /// Forgets all frames.
  void clear();

 private:
  struct Held {
    RebuiltFrame reference;
    std::deque<RebuiltFrame> views;
  };
  Held* find(const std::string& robot, Stamp stamp);

  SceneCloudOptions options_;
  std::map<std::string, std::deque<Held>> held_;  // by the reference's robot, oldest first
  std::string latest_robot_;
  Stamp latest_stamp_ = 0;
};

}  // namespace rprr
