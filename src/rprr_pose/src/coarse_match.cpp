// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_pose/coarse_match.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

namespace rprr {
namespace {

constexpr float kNearest = 0.1f;  // [m]
// Variance that counts as noise, so that flat patches do not correlate by chance, grey levels^2.
constexpr float kFlatVariance = 20.0f;
// Metres: what a camera's intrinsics throw further than that stays numbers in no projection.
constexpr float kFarthest = 1e5f;
constexpr float kFewest = 12.0f;  // cells that have to meet

float median_depth(const PreviewView& view, float fallback) {
  std::vector<float> known;
  std::copy_if(view.z.begin(), view.z.end(), std::back_inserter(known),
               [](float z) { return z > 0.0f; });
  if (known.empty()) return fallback;
  const auto middle = known.begin() + static_cast<std::ptrdiff_t>(known.size() / 2);
  std::nth_element(known.begin(), middle, known.end());
  return *middle;
}

float inverse_of(float z) {
  return z > 0.0f ? 1.0f / z : 0.0f;
}

}  // namespace

CoarseMatch::CoarseMatch(const PreviewView& moving, const PreviewView& fixed)
    : fixed_camera_(fixed.camera), typical_depth_(median_depth(moving, 2.0f)) {
  for (int r = 0; r < moving.height(); ++r) {
    for (int c = 0; c < moving.width(); ++c) {
      const auto i = static_cast<std::size_t>(r * moving.width() + c);
      const float z = moving.z[i] > 0.0f ? moving.z[i] : typical_depth_;
      const Eigen::Vector3f p = moving.camera.unproject(c, r, 1.0).cast<float>() * z;
      if (!(p.squaredNorm() < kFarthest * kFarthest)) continue;
      x_.push_back(p.x());
      y_.push_back(p.y());
      z_.push_back(p.z());
      moving_.push_back({moving.luma[i], moving.blue[i], moving.red[i], inverse_of(moving.z[i])});
    }
  }
  // Chunks are always full; what is added is never listed.
  const std::size_t full = (z_.size() + kChunk - 1) / kChunk * kChunk;
  x_.resize(full, 0.0f);
  y_.resize(full, 0.0f);
  z_.resize(full, 1.0f);
  const auto stride = static_cast<std::size_t>(fixed.width()) + 2;
  inside_.assign(stride * (static_cast<std::size_t>(fixed.height()) + 2), 0);
  fixed_.assign(inside_.size(), Lane::Zero());
  for (int r = 0; r < fixed.height(); ++r) {
    for (int c = 0; c < fixed.width(); ++c) {
      const auto i = static_cast<std::size_t>(r * fixed.width() + c);
      const std::size_t cell =
          static_cast<std::size_t>(r + 1) * stride + static_cast<std::size_t>(c + 1);
      inside_[cell] = 1;
      fixed_[cell] = {fixed.luma[i], fixed.blue[i], fixed.red[i], inverse_of(fixed.z[i])};
    }
  }
}

// Where the points of a chunk land. What lands outside is caught by the rim around the fixed view,
// so that nothing but the list's length depends on the data.
std::size_t CoarseMatch::land(const Eigen::Matrix3f& rotation, const Eigen::Vector3f& translation,
                              std::size_t begin, Landed& out) const {
  const Eigen::Matrix3f& r = rotation;
  const Eigen::Vector3f& t = translation;
  const auto last_column = static_cast<float>(fixed_camera_.width) + 1.5f;
  const auto last_row = static_cast<float>(fixed_camera_.height) + 1.5f;
  const float cx = fixed_camera_.cx + 1.5f, cy = fixed_camera_.cy + 1.5f;  // rim, rounding
  alignas(16) std::array<float, kChunk> depth;
  alignas(16) std::array<int, kChunk> column, row;
  for (std::size_t k = 0; k < kChunk; k += 4) {
    const Lane x = Lane::Map(x_.data() + begin + k);
    const Lane y = Lane::Map(y_.data() + begin + k);
    const Lane z = Lane::Map(z_.data() + begin + k);
    const Lane d = r(2, 0) * x + r(2, 1) * y + r(2, 2) * z + t[2];
    const Lane scale = d.max(kNearest).inverse();
    const Lane behind = (d - kNearest).min(0.0f) * 1e9f;  // pushes it off to the left
    const Lane u = fixed_camera_.fx * (r(0, 0) * x + r(0, 1) * y + r(0, 2) * z + t[0]) * scale;
    const Lane v = fixed_camera_.fy * (r(1, 0) * x + r(1, 1) * y + r(1, 2) * z + t[1]) * scale;
    Eigen::Map<Lane>(depth.data() + k) = d;
    using Index = Eigen::Array<int, 4, 1>;
    Eigen::Map<Index>(column.data() + k) =
        (u + behind + cx).max(0.0f).min(last_column).template cast<int>();
    Eigen::Map<Index>(row.data() + k) = (v + cy).max(0.0f).min(last_row).template cast<int>();
  }
  std::size_t n = 0;
  const std::size_t count = std::min(kChunk, moving_.size() - begin);
  for (std::size_t k = 0; k < count; ++k) {
    const int cell = row[k] * (fixed_camera_.width + 2) + column[k];
    out[n] = {static_cast<int>(begin + k), cell, depth[k]};
    n += inside_[static_cast<std::size_t>(cell)];
  }
  return n;
}

Eigen::Vector3d CoarseMatch::middle(const Pose& fixed_from_moving) const {
  const Eigen::Matrix3f rotation = fixed_from_moving.linear().cast<float>();
  const Eigen::Vector3f translation = fixed_from_moving.translation().cast<float>();
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  int n = 0;
  for (std::size_t i = 0; i < moving_.size(); ++i) {
    if (moving_[i][3] == 0.0f) continue;
    const Eigen::Vector3f p = rotation * Eigen::Vector3f(x_[i], y_[i], z_[i]) + translation;
    if (p.z() < kNearest) continue;
    if (fixed_camera_.index_of_ray(p.x() / p.z(), p.y() / p.z()) < 0) continue;
    sum += p;
    ++n;
  }
  if (n == 0) return {0.0, 0.0, 2.0};
  return (sum / static_cast<float>(n)).cast<double>();
}

CoarseScore CoarseMatch::judge(const Eigen::Matrix3f& rotation, const Eigen::Vector3f& translation,
                               float tolerance) const {
  Lane m = Lane::Zero(), f = Lane::Zero(), mm = Lane::Zero(), ff = Lane::Zero(), mf = Lane::Zero();
  float depths = 0.0f, agree = 0.0f;
  std::size_t landed = 0;
  const float steepness = 1.0f / tolerance;
  Landed places;
  for (std::size_t begin = 0; begin < z_.size(); begin += kChunk) {
    const std::size_t found = land(rotation, translation, begin, places);
    landed += found;
    for (std::size_t k = 0; k < found; ++k) {
      const Lane& one = moving_[static_cast<std::size_t>(places[k].point)];
      const Lane& other = fixed_[static_cast<std::size_t>(places[k].cell)];
      m += one, f += other, mm += one * one, ff += other * other, mf += one * other;
      // Before what the fixed camera saw lies free space; behind it there may be a surface.
      const float off = places[k].depth * other[3] - 1.0f;
      const float worst = off < 0.0f ? -1.0f : -0.25f;
      const float known = one[3] * other[3] > 0.0f ? 1.0f : 0.0f;
      depths += known;
      agree += known * std::max(1.0f - std::abs(off) * steepness, worst);
    }
  }
  CoarseScore score;
  const auto n = static_cast<float>(landed);
  if (n < kFewest) return score;
  const Lane variance_m = mm - m * m / n + kFlatVariance * n;
  const Lane variance_f = ff - f * f / n + kFlatVariance * n;
  const Lane correlation = (mf - m * f / n) / (variance_m * variance_f).sqrt();
  score.colour = correlation[0] + 0.5f * (correlation[1] + correlation[2]);
  score.depth = depths > 0.0f ? agree / depths : 0.3f;
  score.overlap = n / static_cast<float>(moving_.size());
  return score;
}

}  // namespace rprr
