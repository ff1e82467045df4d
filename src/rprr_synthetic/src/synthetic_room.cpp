// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <utility>

#include "furniture.hpp"
#include "rprr_synthetic/synthetic_scene.hpp"

namespace rprr {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kHalfLength = 3.2;  // metres along x
constexpr double kHalfWidth = 2.6;   // metres along y
constexpr double kHeight = 2.7;

using Vec = Eigen::Vector3d;
using Piece = void (*)(Furnisher&);

/// Where wall and floor meet at (x, y); y of the place points along `facing` into the room.
Pose wall_place(double x, double y, double facing) {
  Pose pose = Pose::Identity();
  pose.translation() = Vec(x, y, 0.0);
  pose.linear() = Eigen::AngleAxisd(facing - kPi / 2.0, Vec::UnitZ()).toRotationMatrix();
  return pose;
}

Material wall_material(Furnisher& f) {
  switch (f.random().below(4)) {
    case 0:
      return {Pattern::bricks, srgb(165, 95, 75), srgb(190, 180, 165), f.seed()};
    case 1:
      return {Pattern::plaster, srgb(225, 210, 180), srgb(200, 180, 150), f.seed()};
    case 2:
      return {Pattern::plaster, srgb(180, 200, 200), srgb(150, 170, 170), f.seed()};
    default:
      return {Pattern::plaster, srgb(230, 228, 220), srgb(200, 200, 190), f.seed()};
  }
}

void add_shell(Furnisher& f) {
  const double x = kHalfLength;
  const double y = kHalfWidth;
  f.box({-x, -y, -0.1}, {x, y, 0.0},
        {Pattern::planks, srgb(185, 140, 95), srgb(125, 85, 50), f.seed()});
  f.box({-x, -y, kHeight}, {x, y, kHeight + 0.1},
        {Pattern::plaster, srgb(235, 235, 230), srgb(220, 220, 215), f.seed()});
  f.box({-x - 0.1, -y, 0.0}, {-x, y, kHeight}, wall_material(f));
  f.box({x, -y, 0.0}, {x + 0.1, y, kHeight}, wall_material(f));
  f.box({-x, -y - 0.1, 0.0}, {x, -y, kHeight}, wall_material(f));
  f.box({-x, y, 0.0}, {x, y + 0.1, kHeight}, wall_material(f));
  f.box({-1.3, -0.9, 0.0}, {1.3, 0.9, 0.012},
        {Pattern::carpet, srgb(150, 50, 45), srgb(205, 175, 130), f.seed()});
}

void add_wall_pieces(Furnisher& f) {
  std::array<Piece, 10> pieces = {
      add_bookshelf,       add_desk,     add_sofa,      add_kitchen_counter, add_cupboard,
      add_plant_and_boxes, add_wardrobe, add_bookshelf, add_door_and_lamp,   add_desk};
  for (std::size_t i = pieces.size() - 1; i > 0; --i) {
    std::swap(pieces[i],
              pieces[static_cast<std::size_t>(f.random().below(static_cast<int>(i) + 1))]);
  }
  std::vector<Pose> places;
  for (const double x : {-2.0, 0.0, 2.0}) {
    places.push_back(wall_place(x, -kHalfWidth, kPi / 2.0));
    places.push_back(wall_place(x, kHalfWidth, -kPi / 2.0));
  }
  for (const double y : {-0.75, 1.15}) {
    places.push_back(wall_place(-kHalfLength, -y, 0.0));
    places.push_back(wall_place(kHalfLength, y, kPi));
  }
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    f.move_to(places[i]);
    pieces[i](f);
  }
}

void add_clutter(Furnisher& f) {
  const int count = 8;
  const double start = f.random().between(0.0, 2.0 * kPi);
  for (int i = 0; i < count; ++i) {
    const double angle = start + 2.0 * kPi * (i + f.random().between(-0.2, 0.2)) / count;
    f.move_to(wall_place(1.75 * std::cos(angle), 1.45 * std::sin(angle), angle));
    add_floor_clutter(f);
  }
}

}  // namespace

Scene make_room(std::uint32_t seed) {
  std::vector<Primitive> primitives;
  Random random(seed);
  Furnisher furnisher(primitives, random);
  add_shell(furnisher);
  add_wall_pieces(furnisher);
  add_clutter(furnisher);
  return {std::move(primitives), Vec(0.3, -0.2, 2.45)};
}

}  // namespace rprr
