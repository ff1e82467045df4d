// SPDX-License-Identifier: BSD-3-Clause
#include <utility>

#include "furniture.hpp"
#include "rprr_synthetic/synthetic_scene.hpp"

namespace rprr {
namespace {

constexpr double kHalfLength = 12.0;  // metres along x
constexpr double kHalfWidth = 1.0;    // metres along y
constexpr double kHeight = 2.5;
constexpr double kFlush = 0.004;  // less than a depth sensor tells from the wall

Material paint(Furnisher& f) {
  const int shade = f.random().below(40);
  return {Pattern::plaster, srgb(235 - shade, 225 - shade, 205 - shade),
          srgb(205 - shade, 195 - shade, 180 - shade), f.seed()};
}

Material picture(Furnisher& f) {
  const Pattern pattern = f.random().below(2) == 0 ? Pattern::poster : Pattern::text;
  const int red = 60 + f.random().below(160);
  const int green = 60 + f.random().below(160);
  return {pattern, srgb(red, green, 90), srgb(220, 255 - green, 150), f.seed()};
}

// One or two pictures on every metre of the wall at y.
void hang_pictures(Furnisher& f, double y) {
  for (double x = -4.0; x < 4.0; x += f.random().between(0.6, 1.2)) {
    const Material material = picture(f);
    const double low = f.random().between(0.7, 1.3);
    const double width = f.random().between(0.25, 0.6);
    const double height = f.random().between(0.3, 0.8);
    f.box({x, y - kFlush, low}, {x + width, y + kFlush, low + height}, material);
  }
}

}  // namespace

Scene make_corridor(std::uint32_t seed) {
  std::vector<Primitive> primitives;
  Random random(seed);
  Furnisher f(primitives, random);
  const double x = kHalfLength;
  const double y = kHalfWidth;
  f.box({-x, -y, -0.1}, {x, y, 0.0},
        {Pattern::tiles, srgb(170, 165, 155), srgb(120, 115, 110), f.seed()});
  f.box({-x, -y, kHeight}, {x, y, kHeight + 0.1}, paint(f));
  f.box({-x, -y - 0.1, 0.0}, {x, -y, kHeight}, paint(f));
  f.box({-x, y, 0.0}, {x, y + 0.1, kHeight}, paint(f));
  hang_pictures(f, -y);
  hang_pictures(f, y);
  return {std::move(primitives), Eigen::Vector3d(0.1, 0.2, 2.3)};
}

}  // namespace rprr
