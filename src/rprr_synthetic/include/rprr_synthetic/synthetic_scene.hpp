// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "rprr_geometry/camera.hpp"
#include "rprr_geometry/se3.hpp"

namespace rprr {

enum class Shape { box, sphere, cylinder };

/// Procedural textures, all with structure from the size of a hand down to a few millimetres.
enum class Pattern {
  plaster,
  wood,
  planks,
  bricks,
  tiles,
  fabric,
  carpet,
  speckle,
  poster,
  text,
  books,
  screen,
  foliage,
  cardboard
};

struct Material {
  Pattern pattern = Pattern::plaster;
  Eigen::Vector3f colour = Eigen::Vector3f::Constant(0.5f);  // linear BGR reflectance, 0 to 1
  Eigen::Vector3f second = Eigen::Vector3f::Constant(0.3f);  // the pattern's other colour
  std::uint32_t seed = 0;  // what tells two surfaces of one pattern apart
  float infrared = 1.0f;   // share of a depth sensor's light that comes back
};

/// A solid. Boxes extend half_size along each axis of their own frame; spheres have the radius
/// half_size.x(); cylinders stand along z with the radius half_size.x() and half the height
/// half_size.z().
struct Primitive {
  Shape shape = Shape::box;
  Pose world_from_local = Pose::Identity();
  Eigen::Vector3d half_size = Eigen::Vector3d::Constant(0.5);  // [m]
  Material material;
};

/// What a perfect RGB-D camera would see.
struct ExactView {
  cv::Mat metres;    // CV_32FC1, depth along the optical axis; 0 where there is no surface
  cv::Mat radiance;  // CV_32FC3, linear BGR, about 0 to 1
  cv::Mat infrared;  // CV_32FC1, how much of a depth sensor's light comes back, 0 to 1
};

/// A static scene: solids under a lamp that casts soft shadows. World frame of REP-103: z up,
/// metres. Surfaces reflect diffusely, so all cameras see the same colours.
class Scene {
 public:
  /// Bakes the lamp's shadows, which takes a few 100 ms.
  Scene(std::vector<Primitive> primitives, const Eigen::Vector3d& lamp);

  const std::vector<Primitive>& primitives() const { return primitives_; }

  /// The view of a camera whose optical frame is placed by world_from_camera. One ray through each
  /// pixel centre; textures finer than a pixel fade out. A camera inside a solid does not see it.
  /// Colour, not depth, is the mean of four rays where solids meet.
  ExactView render(const Camera& camera, const Pose& world_from_camera) const;

  /// How much light falls on a surface with that normal at that place.
  float light(const Eigen::Vector3f& world, const Eigen::Vector3f& normal) const;

 private:
  float lamp_visibility(const Eigen::Vector3f& world) const;
  void bake_shadows();

  std::vector<Primitive> primitives_;
  Eigen::Vector3f lamp_;
  cv::Mat shadow_;  // CV_32FC1, distance from the lamp to the first surface below, by direction
};

/// A furnished room, about 6.4 x 5.2 x 2.7 m, centred on the world's origin with the floor at z =
/// 0: shelves with books, desks, sofas, cupboards, posters, clutter. The seed shuffles furniture
/// and colours. Within 1.2 m of the centre nothing rises above 0.6 m.
Scene make_room(std::uint32_t seed);

/// A straight corridor along the world's x, 2 m wide and 2.5 m high, floor at z = 0, its ends out
/// of reach of a depth camera in the middle: depth says nothing of a move along it, only the tiles
/// and the pictures on both walls do. The seed chooses these.
Scene make_corridor(std::uint32_t seed);

}  // namespace rprr
