// SPDX-License-Identifier: BSD-3-Clause
#include "furniture.hpp"

#include <cmath>

namespace rprr {
namespace {

using Vec = Eigen::Vector3d;

Material oak(Furnisher& f) {
  return {Pattern::wood, srgb(205, 165, 115), srgb(140, 95, 55), f.seed()};
}

Material any_wood(Furnisher& f) {
  static const int tones[4][6] = {{205, 165, 115, 140, 95, 55},
                                  {150, 100, 65, 85, 50, 30},
                                  {225, 205, 175, 180, 150, 115},
                                  {110, 75, 55, 60, 38, 28}};
  const int* t = tones[f.random().below(4)];
  return {Pattern::wood, srgb(t[0], t[1], t[2]), srgb(t[3], t[4], t[5]), f.seed()};
}

Eigen::Vector3f any_colour(Furnisher& f) {
  static const int colours[8][3] = {{170, 60, 50},   {60, 95, 150}, {210, 170, 70}, {85, 130, 80},
                                    {190, 185, 175}, {90, 70, 110}, {60, 130, 135}, {200, 120, 70}};
  const int* c = colours[f.random().below(8)];
  return srgb(c[0], c[1], c[2]);
}

Material any_fabric(Furnisher& f) {
  const Eigen::Vector3f base = any_colour(f);
  return {Pattern::fabric, base, any_colour(f), f.seed()};
}

Material any_speckle(Furnisher& f) {
  const Eigen::Vector3f base = any_colour(f);
  return {Pattern::speckle, base, base * 0.35f, f.seed()};
}

Material cardboard(Furnisher& f) {
  return {Pattern::cardboard, srgb(190, 150, 105), srgb(60, 50, 40), f.seed()};
}

Material poster(Furnisher& f) {
  return {Pattern::poster, any_colour(f), any_colour(f), f.seed()};
}

Material printed(Furnisher& f) {
  return {Pattern::text, srgb(235, 232, 222), srgb(50, 50, 70), f.seed()};
}

Material metal(Furnisher& f) {
  return {Pattern::plaster, srgb(125, 126, 130), srgb(80, 80, 85), f.seed(), 0.5f};
}

Material leaves(Furnisher& f) {
  return {Pattern::foliage, srgb(110, 160, 70), srgb(30, 65, 30), f.seed()};
}

void hang_poster(Furnisher& f, double x, double low, double width, double height) {
  f.box({x - width / 2, 0.0, low}, {x + width / 2, 0.025, low + height}, poster(f));
}

/// A row of things on a board from x0 to x1: books in groups, now and then an ornament.
void fill_board(Furnisher& f, double x0, double x1, double z, double depth, double room_above) {
  Random& r = f.random();
  double x = x0 + 0.01;
  while (x < x1 - 0.12) {
    const double width = std::min(r.between(0.10, 0.34), x1 - 0.01 - x);
    const int kind = r.below(7);
    if (kind == 0) {
      f.cylinder({x + 0.07, 0.5 * depth, z}, 0.05, r.between(0.10, 0.8 * room_above),
                 any_speckle(f));
      x += 0.15;
    } else if (kind == 1) {
      f.sphere({x + 0.075, 0.5 * depth, z + 0.065}, 0.065, any_speckle(f));
      x += 0.16;
    } else if (kind == 2) {
      x += r.between(0.04, 0.10);
    } else {
      const Material m{Pattern::books, any_colour(f), any_colour(f), f.seed()};
      f.box({x, 0.04, z},
            {x + width, r.between(0.6, 0.95) * depth, z + r.between(0.6, 0.88) * room_above}, m);
      x += width + 0.004;
    }
  }
}

void legs(Furnisher& f, const Vec& low, const Vec& high, double radius, const Material& m) {
  for (const double x : {low.x() + radius, high.x() - radius}) {
    for (const double y : {low.y() + radius, high.y() - radius}) {
      f.cylinder({x, y, low.z()}, radius, high.z() - low.z(), m);
    }
  }
}

void add_chair(Furnisher& f, double x, double y) {
  const Material frame = any_wood(f);
  f.box({x - 0.22, y - 0.22, 0.42}, {x + 0.22, y + 0.22, 0.48}, any_fabric(f));
  legs(f, {x - 0.22, y - 0.22, 0.0}, {x + 0.22, y + 0.22, 0.42}, 0.02, frame);
  f.box({x - 0.22, y + 0.18, 0.62}, {x + 0.22, y + 0.22, 0.92}, frame);
  f.box({x - 0.22, y + 0.18, 0.48}, {x - 0.18, y + 0.22, 0.62}, frame);
  f.box({x + 0.18, y + 0.18, 0.48}, {x + 0.22, y + 0.22, 0.62}, frame);
}

}  // namespace

Eigen::Vector3f srgb(int red, int green, int blue) {
  const auto linear = [](int value) {
    return static_cast<float>(std::pow(static_cast<double>(value) / 255.0, 2.2));
  };
  return {linear(blue), linear(green), linear(red)};
}

void Furnisher::add(Shape shape, const Vec& centre, const Vec& half, double yaw,
                    const Material& material) {
  Primitive primitive;
  primitive.shape = shape;
  Pose place_from_local = Pose::Identity();
  place_from_local.translation() = centre;
  place_from_local.linear() = Eigen::AngleAxisd(yaw, Vec::UnitZ()).toRotationMatrix();
  primitive.world_from_local = place_ * place_from_local;
  primitive.half_size = half;
  primitive.material = material;
  primitives_.push_back(primitive);
}

void Furnisher::box(const Vec& low, const Vec& high, const Material& material, double yaw) {
  add(Shape::box, 0.5 * (low + high), 0.5 * (high - low), yaw, material);
}

void Furnisher::cylinder(const Vec& foot, double radius, double height, const Material& material) {
  add(Shape::cylinder, foot + Vec(0.0, 0.0, 0.5 * height), {radius, radius, 0.5 * height}, 0.0,
      material);
}

void Furnisher::sphere(const Vec& centre, double radius, const Material& material) {
  add(Shape::sphere, centre, Vec::Constant(radius), 0.0, material);
}

void add_bookshelf(Furnisher& f) {
  const Material wood = any_wood(f);
  const double depth = 0.32;
  const double height = f.random().between(1.75, 2.1);
  f.box({-0.85, 0.0, 0.0}, {-0.82, depth, height}, wood);
  f.box({0.82, 0.0, 0.0}, {0.85, depth, height}, wood);
  f.box({-0.02, 0.0, 0.0}, {0.01, depth, height}, wood);
  f.box({-0.85, 0.0, 0.0}, {0.85, 0.015, height}, wood);
  const int boards = 5;
  const double gap = (height - 0.06) / boards;
  for (int i = 0; i <= boards; ++i) {
    const double z = 0.03 + gap * i;
    f.box({-0.82, 0.0, z - 0.012}, {0.82, depth, z + 0.012}, wood);
    if (i == boards) break;
    fill_board(f, -0.82, -0.02, z + 0.012, depth, gap - 0.024);
    fill_board(f, 0.01, 0.82, z + 0.012, depth, gap - 0.024);
  }
}

void add_desk(Furnisher& f) {
  const Material wood = any_wood(f);
  f.box({-0.85, 0.02, 0.71}, {0.85, 0.74, 0.75}, wood);
  legs(f, {-0.83, 0.05, 0.0}, {0.83, 0.72, 0.71}, 0.03, metal(f));
  f.box({0.35, 0.06, 0.15}, {0.80, 0.70, 0.70}, any_wood(f));
  f.cylinder({-0.1, 0.25, 0.75}, 0.12, 0.015, metal(f));
  f.box({-0.13, 0.22, 0.75}, {-0.07, 0.25, 0.95}, metal(f));
  const Material display{Pattern::screen, srgb(40, 42, 50), srgb(220, 220, 220), f.seed(), 0.05f};
  f.box({-0.40, 0.25, 0.86}, {0.20, 0.28, 1.22}, display);
  f.box({-0.30, 0.48, 0.75}, {0.12, 0.62, 0.775},
        {Pattern::text, srgb(50, 50, 55), srgb(190, 190, 190), f.seed()});
  f.box({-0.75, 0.35, 0.75}, {-0.54, 0.65, 0.757}, printed(f), 0.3);
  f.box({0.35, 0.30, 0.75}, {0.56, 0.60, 0.79}, printed(f), -0.2);
  f.cylinder({0.68, 0.35, 0.75}, 0.04, 0.10, any_speckle(f));
  f.cylinder({-0.66, 0.16, 0.75}, 0.06, 0.16, any_speckle(f));
  fill_board(f, 0.30, 0.84, 0.75, 0.22, 0.27);
  hang_poster(f, -0.45, 1.35, 0.6, 0.8);
  hang_poster(f, 0.40, 1.40, 0.8, 0.55);
  add_chair(f, f.random().between(-0.35, 0.15), 0.92);
}

void add_sofa(Furnisher& f) {
  const Material cloth = any_fabric(f);
  f.box({-0.9, 0.05, 0.08}, {0.9, 0.88, 0.42}, cloth);
  f.box({-0.9, 0.05, 0.42}, {0.9, 0.28, 0.85}, cloth);
  f.box({-0.94, 0.05, 0.08}, {-0.76, 0.88, 0.62}, cloth);
  f.box({0.76, 0.05, 0.08}, {0.94, 0.88, 0.62}, cloth);
  f.box({-0.70, 0.28, 0.42}, {-0.28, 0.45, 0.78}, any_fabric(f), 0.15);
  f.box({0.25, 0.28, 0.42}, {0.68, 0.44, 0.80}, any_fabric(f), -0.2);
  f.box({-0.15, 0.45, 0.42}, {0.15, 0.68, 0.45}, printed(f), 0.5);
  hang_poster(f, -0.45, 1.15, 0.75, 1.0);
  hang_poster(f, 0.48, 1.25, 0.85, 0.6);
}

void add_cupboard(Furnisher& f) {
  const Material wood = any_wood(f);
  const double top = f.random().between(0.78, 0.95);
  f.box({-0.8, 0.0, 0.08}, {0.8, 0.42, top}, wood);
  for (const double x : {-0.53, 0.0, 0.53}) {
    f.box({x - 0.25, 0.42, 0.12}, {x + 0.25, 0.44, top - 0.05}, any_wood(f));
    f.sphere({x + 0.19, 0.46, 0.5 * top + 0.1}, 0.018, metal(f));
  }
  fill_board(f, -0.78, 0.1, top, 0.30, 0.30);
  f.cylinder({0.35, 0.2, top}, 0.09, 0.22, any_speckle(f));
  f.sphere({0.35, 0.2, top + 0.36}, 0.19, leaves(f));
  f.sphere({0.62, 0.22, top + 0.11}, 0.11, any_speckle(f));
  hang_poster(f, -0.3, 1.42, 0.95, 0.7);
  hang_poster(f, 0.62, 1.55, 0.42, 0.55);
}

void add_kitchen_counter(Furnisher& f) {
  const Material front = any_wood(f);
  f.box({-0.95, 0.0, 0.1}, {0.95, 0.58, 0.86}, front);
  f.box({-0.95, 0.0, 0.86}, {0.95, 0.62, 0.90},
        {Pattern::speckle, srgb(150, 145, 140), srgb(70, 68, 70), f.seed()});
  f.box({-0.95, 0.0, 0.90}, {0.95, 0.012, 1.45},
        {Pattern::tiles, srgb(220, 215, 200), any_colour(f), f.seed()});
  f.box({-0.95, 0.0, 1.45}, {-0.05, 0.34, 2.1}, front);
  for (const double x : {-0.73, -0.27}) {
    f.box({x - 0.21, 0.34, 1.48}, {x + 0.21, 0.36, 2.07}, any_wood(f));
  }
  f.box({0.15, 0.0, 1.55}, {0.95, 0.24, 1.58}, oak(f));
  fill_board(f, 0.15, 0.95, 1.58, 0.22, 0.28);
  f.box({-0.80, 0.12, 0.90}, {-0.35, 0.46, 1.16},
        {Pattern::screen, srgb(30, 30, 32), srgb(120, 120, 120), f.seed(), 0.25f});
  f.cylinder({0.0, 0.3, 0.90}, 0.07, 0.21, metal(f));
  f.cylinder({0.22, 0.22, 0.90}, 0.05, 0.14, any_speckle(f));
  f.cylinder({0.36, 0.30, 0.90}, 0.045, 0.26, any_speckle(f));
  f.box({0.50, 0.18, 0.90}, {0.62, 0.30, 1.17}, poster(f), 0.4);
  f.cylinder({0.78, 0.34, 0.90}, 0.13, 0.07, any_speckle(f));
  f.sphere({0.76, 0.34, 1.0}, 0.045, any_speckle(f));
  for (const double x : {-0.63, 0.0, 0.63}) {
    f.box({x - 0.3, 0.58, 0.14}, {x + 0.3, 0.60, 0.83}, front);
    f.box({x - 0.08, 0.60, 0.76}, {x + 0.08, 0.625, 0.78}, metal(f));
  }
}

void add_plant_and_boxes(Furnisher& f) {
  f.cylinder({-0.6, 0.35, 0.0}, 0.19, 0.38, any_speckle(f));
  f.cylinder({-0.6, 0.35, 0.38}, 0.02, 0.5, oak(f));
  const double spread = f.random().between(0.15, 0.22);
  f.sphere({-0.62, 0.38, 1.05}, 0.30, leaves(f));
  f.sphere({-0.62 + spread, 0.45, 1.32}, 0.22, leaves(f));
  f.sphere({-0.70 - spread, 0.33, 1.28}, 0.19, leaves(f));
  f.box({0.0, 0.08, 0.0}, {0.62, 0.60, 0.42}, cardboard(f), 0.08);
  f.box({0.08, 0.12, 0.42}, {0.56, 0.52, 0.76}, cardboard(f), -0.15);
  f.box({0.15, 0.15, 0.76}, {0.48, 0.45, 0.98}, cardboard(f), 0.3);
  f.box({0.66, 0.15, 0.0}, {0.92, 0.50, 0.30}, cardboard(f), -0.3);
  hang_poster(f, 0.35, 1.25, 0.7, 0.95);
}

void add_wardrobe(Furnisher& f) {
  const Material body = any_wood(f);
  f.box({-0.75, 0.0, 0.0}, {0.75, 0.55, 2.05}, body);
  for (const double x : {-0.37, 0.37}) {
    f.box({x - 0.35, 0.55, 0.10}, {x + 0.35, 0.575, 1.05}, any_wood(f));
    f.box({x - 0.35, 0.55, 1.10}, {x + 0.35, 0.575, 2.0}, any_wood(f));
    f.cylinder({x * 0.25, 0.60, 0.98}, 0.012, 0.25, metal(f));
  }
  f.box({0.12, 0.575, 1.35}, {0.50, 0.58, 1.85}, poster(f));
  f.box({-0.55, 0.575, 1.45}, {-0.30, 0.58, 1.80}, printed(f));
  f.box({-0.6, 0.05, 2.05}, {-0.05, 0.48, 2.35}, cardboard(f), 0.1);
  f.box({0.1, 0.08, 2.05}, {0.6, 0.5, 2.28}, cardboard(f), -0.1);
}

void add_door_and_lamp(Furnisher& f) {
  f.box({-0.50, 0.0, 0.0}, {0.42, 0.05, 2.08}, any_wood(f));
  f.box({-0.40, 0.05, 1.15}, {0.32, 0.065, 1.95}, poster(f));
  f.box({-0.40, 0.05, 0.15}, {0.32, 0.065, 0.95}, any_wood(f));
  f.sphere({0.33, 0.09, 1.02}, 0.035, metal(f));
  f.cylinder({0.72, 0.3, 0.0}, 0.14, 0.03, metal(f));
  f.cylinder({0.72, 0.3, 0.03}, 0.015, 1.4, metal(f));
  f.cylinder({0.72, 0.3, 1.35}, 0.19, 0.28, any_fabric(f));
  f.cylinder({-0.78, 0.28, 0.0}, 0.15, 0.55, any_fabric(f));
  f.box({-0.95, 0.12, 0.55}, {-0.62, 0.44, 0.60}, printed(f), 0.2);
}

void add_floor_clutter(Furnisher& f) {
  Random& r = f.random();
  const double size = r.between(0.14, 0.22);
  switch (r.below(4)) {
    case 0:
      f.sphere({0.0, 0.0, size}, size, any_fabric(f));
      break;
    case 1:
      f.cylinder({0.0, 0.0, 0.0}, size + 0.06, 0.38, any_fabric(f));
      break;
    case 2:
      f.box({-size, -0.16, 0.0}, {size, 0.16, 0.26}, cardboard(f), r.between(-1.0, 1.0));
      break;
    default:
      f.box({-0.2, -0.15, 0.36}, {0.2, 0.15, 0.40}, any_wood(f));
      legs(f, {-0.19, -0.14, 0.0}, {0.19, 0.14, 0.36}, 0.018, oak(f));
      f.cylinder({0.06, 0.03, 0.40}, 0.045, 0.12, any_speckle(f));
  }
}

}  // namespace rprr
