// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <optional>

#include "rprr_eval/turntable/turntable.hpp"
#include "rprr_synthetic/random.hpp"
#include "rprr_synthetic/sensor_model.hpp"
#include "rprr_synthetic/trajectory.hpp"
#include "rprr_wire/camera_wire.hpp"

namespace rprr {
namespace {

constexpr double kDegree = M_PI / 180.0;
constexpr double kTableRadius = 0.35;
constexpr double kDistance = 1.1;  // from the camera to the point that it looks at
constexpr double kElevation = 30.0 * kDegree;
constexpr double kGazeHeight = 0.08;
constexpr int kObjects = 9;

struct Place {
  Eigen::Vector2d centre;
  double radius;
};

// A free place on the table, if one is found.
std::optional<Place> free_place(const std::vector<Place>& taken, double radius, Random& random) {
  for (int attempt = 0; attempt < 60; ++attempt) {
    const double angle = random.between(0.0, 2.0 * M_PI);
    const double reach = std::sqrt(random.unit()) * (kTableRadius - radius);
    const Place place{{reach * std::cos(angle), reach * std::sin(angle)}, radius};
    const bool free = std::none_of(taken.begin(), taken.end(), [&](const Place& other) {
      return (other.centre - place.centre).norm() < other.radius + radius;
    });
    if (free) return place;
  }
  return std::nullopt;
}

Material any_material(Random& random) {
  static constexpr Pattern kPatterns[] = {Pattern::wood, Pattern::speckle, Pattern::poster,
                                          Pattern::text, Pattern::cardboard};
  const auto colour = [&random] {
    return Eigen::Vector3d(random.between(0.1, 0.8), random.between(0.1, 0.8),
                           random.between(0.1, 0.8))
        .cast<float>()
        .eval();
  };
  Material material;
  material.pattern = kPatterns[random.below(5)];
  material.colour = colour();
  material.second = colour();
  material.seed = static_cast<std::uint32_t>(random.bits());
  return material;
}

// The n-th object: large ones first, so that they find a place.
Primitive any_object(int n, Random& random) {
  Primitive object;
  object.material = any_material(random);
  const double scale = n < 3 ? 1.0 : (n < 6 ? 0.75 : 0.55);
  switch (random.below(5)) {
    case 0:
      object.shape = Shape::sphere;
      object.half_size.setConstant(scale * random.between(0.06, 0.09));
      break;
    case 1:
      object.shape = Shape::cylinder;
      object.half_size.setConstant(scale * random.between(0.04, 0.08));
      object.half_size.z() = scale * random.between(0.08, 0.15);
      break;
    default:
      object.shape = Shape::box;
      object.half_size =
          scale * Eigen::Vector3d(random.between(0.04, 0.09), random.between(0.04, 0.09),
                                  random.between(0.05, 0.15));
  }
  return object;
}

SensorModel tripod_sensor(int width) {
  return example_sensor_a(width, width * 3 / 4);
}

}  // namespace

Scene make_turntable(std::uint32_t seed) {
  Random random(seed);
  std::vector<Primitive> primitives(1);
  Primitive& table = primitives.front();
  table.shape = Shape::cylinder;
  table.half_size = {kTableRadius, kTableRadius, 0.01};
  table.world_from_local.translation().z() = -0.01;
  table.material = any_material(random);
  std::vector<Place> taken;
  for (int n = 0; n < kObjects; ++n) {
    Primitive object = any_object(n, random);
    const double radius =
        object.shape == Shape::box ? object.half_size.head<2>().norm() : object.half_size.x();
    const std::optional<Place> place = free_place(taken, radius, random);
    if (!place) continue;
    taken.push_back(*place);
    object.world_from_local.translation() << place->centre, object.half_size.z();
    object.world_from_local.rotate(
        Eigen::AngleAxisd(random.between(0.0, M_PI), Eigen::Vector3d::UnitZ()));
    primitives.push_back(object);
  }
  return {std::move(primitives), Eigen::Vector3d(0.5, -0.3, 2.0)};
}

Pose turntable_camera(double degrees) {
  const double angle = degrees * kDegree;
  const double along = kDistance * std::cos(kElevation);
  const Eigen::Vector3d eye(along * std::cos(angle), along * std::sin(angle),
                            kGazeHeight + kDistance * std::sin(kElevation));
  return look_along(eye, angle + M_PI, -kElevation, 0.0);
}

TurntableViews render_turntable(std::uint32_t seed, const TurntableOptions& options) {
  const Scene scene = make_turntable(seed);
  const SensorModel sensor = tripod_sensor(options.width);
  TurntableViews views;
  const int steps = static_cast<int>(std::lround(options.last_degrees / options.step_degrees));
  for (int k = 0; k <= steps; ++k) {
    const double degrees = k * options.step_degrees;
    const Pose pose = turntable_camera(degrees);
    const RgbdImage image = sense(scene, sensor, pose, seed * 1000 + static_cast<std::uint32_t>(k));
    auto frame = std::make_shared<RgbdFrame>();
    frame->stamp = from_seconds(1.0 + k);
    frame->frame_id = "turntable_rgb_optical_frame";
    frame->camera = rounded_for_wire(sensor.camera);
    frame->depth = image.depth;
    frame->bgr = image.bgr;
    views.degrees.push_back(degrees);
    views.frames.push_back(std::move(frame));
    views.world_from_camera.push_back(pose);
  }
  return views;
}

}  // namespace rprr
