// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "rprr_synthetic/random.hpp"
#include "rprr_synthetic/synthetic_scene.hpp"

namespace rprr {

/// Adds solids in a frame of its own: for a piece at a wall x runs along the wall, y into the room
/// and z up, with the origin where wall and floor meet in the middle of the piece's place.
class Furnisher {
 public:
  Furnisher(std::vector<Primitive>& primitives, Random& random)
      : primitives_(primitives), random_(random) {}

  void move_to(const Pose& world_from_place) { place_ = world_from_place; }
  Random& random() { return random_; }
  std::uint32_t seed() { return static_cast<std::uint32_t>(random_.bits() >> 40); }

  /// `low` and `high` are opposite corners; turned by `yaw` about the box's own middle.
  void box(const Eigen::Vector3d& low, const Eigen::Vector3d& high, const Material& material,
           double yaw = 0.0);
  /// Standing on `foot`.
  void cylinder(const Eigen::Vector3d& foot, double radius, double height,
                const Material& material);
  void sphere(const Eigen::Vector3d& centre, double radius, const Material& material);

 private:
  void add(Shape shape, const Eigen::Vector3d& centre, const Eigen::Vector3d& half, double yaw,
           const Material& material);

  std::vector<Primitive>& primitives_;
  Random& random_;
  Pose place_ = Pose::Identity();
};

/// Linear BGR of an sRGB colour as picked on a screen, 0 to 255.
Eigen::Vector3f srgb(int red, int green, int blue);

// Pieces that stand at a wall, at most 1.9 m wide and 0.9 m deep but for the chair of the desk.
void add_bookshelf(Furnisher& f);
void add_desk(Furnisher& f);
void add_sofa(Furnisher& f);
void add_cupboard(Furnisher& f);
void add_kitchen_counter(Furnisher& f);
void add_plant_and_boxes(Furnisher& f);
void add_wardrobe(Furnisher& f);
void add_door_and_lamp(Furnisher& f);
/// Something low on the floor, around the frame's origin.
void add_floor_clutter(Furnisher& f);

}  // namespace rprr
