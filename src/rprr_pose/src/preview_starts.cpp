// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_pose/preview_starts.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace rprr {
namespace {

constexpr double kDegree = M_PI / 180.0;
// Turns about the middle of the scene, yaw and pitch, degrees.
constexpr std::pair<double, double> kTurns[] = {{0, 0},  {-14, 0}, {14, 0}, {-32, 0},
                                                {32, 0}, {0, 12},  {0, -12}};
constexpr float kLeastOverlap = 0.12f;  // of the moving view's cells

struct Judged {
  Eigen::Matrix3d rotation;
  float forward = 0.0f;  // metres along the fixed optical axis
  float score = 0.0f;
};

// The moving view's cells as arrays that one rotation runs through.
struct Cells {
  std::vector<Eigen::Vector3f> rays;
  std::vector<float> q, luma, blue, red;
  float typical_q = 0.5f;  // median, for cells without depth
};

Cells cells_of(const PreviewView& view) {
  Cells cells;
  for (int r = 0; r < view.height(); ++r) {
    for (int c = 0; c < view.width(); ++c) {
      const auto i = static_cast<std::size_t>(r * view.width() + c);
      cells.rays.push_back(view.camera.unproject(c, r, 1.0).cast<float>());
      cells.q.push_back(view.z[i] > 0.0f ? 1.0f / view.z[i] : 0.0f);
      cells.luma.push_back(view.luma[i]);
      cells.blue.push_back(view.blue[i]);
      cells.red.push_back(view.red[i]);
    }
  }
  std::vector<float> known;
  std::copy_if(cells.q.begin(), cells.q.end(), std::back_inserter(known),
               [](float q) { return q > 0.0f; });
  if (!known.empty()) {
    const auto middle = known.begin() + static_cast<std::ptrdiff_t>(known.size() / 2);
    std::nth_element(known.begin(), middle, known.end());
    cells.typical_q = *middle;
  }
  return cells;
}

float correlation(float n, float a, float b, float aa, float bb, float ab) {
  const float va = aa - a * a / n;
  const float vb = bb - b * b / n;
  // A little constant variance, so that flat patches do not correlate by chance.
  const float floor = 20.0f * n;
  return (ab - a * b / n) / std::sqrt((va + floor) * (vb + floor));
}

float judge(const Cells& moving, const PreviewView& fixed, const Eigen::Matrix3f& rotation,
            float forward) {
  const auto fx = static_cast<float>(fixed.camera.fx), cx = static_cast<float>(fixed.camera.cx);
  const auto fy = static_cast<float>(fixed.camera.fy), cy = static_cast<float>(fixed.camera.cy);
  float n = 0, a = 0, b = 0, aa = 0, bb = 0, ab = 0;
  float ca = 0, cb = 0, caa = 0, cbb = 0, cab = 0;
  float da = 0, db = 0, daa = 0, dbb = 0, dab = 0;
  float depths = 0, agree = 0;
  for (std::size_t i = 0; i < moving.rays.size(); ++i) {
    Eigen::Vector3f ray = rotation * moving.rays[i];
    ray.z() += forward * (moving.q[i] > 0.0f ? moving.q[i] : moving.typical_q);
    if (ray.z() < 0.2f) continue;
    const float inverse = 1.0f / ray.z();
    const float u = fx * ray.x() * inverse + cx + 0.5f;
    const float v = fy * ray.y() * inverse + cy + 0.5f;
    if (!(u >= 0.0f && v >= 0.0f)) continue;
    const auto c = static_cast<int>(u);
    const auto r = static_cast<int>(v);
    if (c >= fixed.width() || r >= fixed.height()) continue;
    const auto j = static_cast<std::size_t>(r * fixed.width() + c);
    ++n;
    const float l = moving.luma[i], m = fixed.luma[j];
    a += l, b += m, aa += l * l, bb += m * m, ab += l * m;
    const float p = moving.blue[i], q = fixed.blue[j];
    ca += p, cb += q, caa += p * p, cbb += q * q, cab += p * q;
    const float s = moving.red[i], t = fixed.red[j];
    da += s, db += t, daa += s * s, dbb += t * t, dab += s * t;
    if (moving.q[i] > 0.0f && fixed.z[j] > 0.0f) {
      // Depth after the rotation; what translation changes is left open by the tolerance.
      const float ratio = moving.q[i] * inverse * fixed.z[j];
      ++depths;
      const float off = std::abs(ratio - 1.0f);
      agree += off < 0.5f ? 1.0f - 2.0f * off : 0.0f;
    }
  }
  const auto total = static_cast<float>(moving.rays.size());
  if (n < kLeastOverlap * total) return 0.0f;
  const float colour = correlation(n, a, b, aa, bb, ab) +
                       0.5f * correlation(n, ca, cb, caa, cbb, cab) +
                       0.5f * correlation(n, da, db, daa, dbb, dab);
  const float depth = depths > 0.0f ? agree / depths : 0.3f;
  return std::max(0.0f, 0.5f * colour + depth) * std::pow(n / total, 0.3f);
}

std::vector<Judged> best_rotations(const PreviewView& moving, const PreviewView& fixed,
                                   const StartRange& range) {
  const Cells cells = cells_of(moving);
  std::vector<Judged> all;
  const auto steps_of = [](double reach, double step) {
    return static_cast<int>(reach / step + 1e-9);
  };
  const double roll_step = 2.0 * range.step;
  const int yaws = steps_of(range.yaw, range.step);
  const int pitches = steps_of(range.pitch, range.step);
  const int rolls = steps_of(range.roll, roll_step);
  for (int i = -yaws; i <= yaws; ++i) {
    for (int j = -pitches; j <= pitches; ++j) {
      for (int k = -rolls; k <= rolls; ++k) {
        const double yaw = i * range.step;
        const double pitch = j * range.step;
        const double roll = k * roll_step;
        Judged one;
        one.rotation = (Eigen::AngleAxisd(yaw * kDegree, Eigen::Vector3d::UnitY()) *
                        Eigen::AngleAxisd(pitch * kDegree, Eigen::Vector3d::UnitX()) *
                        Eigen::AngleAxisd(roll * kDegree, Eigen::Vector3d::UnitZ()))
                           .toRotationMatrix();
        for (const float steps : {0.0f, -0.4f, 0.4f}) {
          one.forward = steps / cells.typical_q;
          one.score = judge(cells, fixed, one.rotation.cast<float>(), one.forward);
          all.push_back(one);
        }
      }
    }
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const Judged& l, const Judged& r) { return l.score > r.score; });
  std::vector<Judged> kept;
  for (const Judged& candidate : all) {
    if (kept.size() >= range.rotations || candidate.score <= 0.0f) break;
    const bool distinct = std::all_of(kept.begin(), kept.end(), [&](const Judged& other) {
      return rotation_angle(candidate.rotation * other.rotation.transpose()) >
                 1.6 * range.step * kDegree ||
             candidate.forward != other.forward;
    });
    if (distinct) kept.push_back(candidate);
  }
  return kept;
}

// Middle of what the moving view sees, in the fixed view's frame after the rotation: the mean point
// of the cells that land inside the fixed image.
Eigen::Vector3d middle_of(const PreviewView& moving, const PreviewView& fixed,
                          const Eigen::Matrix3d& rotation) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  int n = 0;
  for (std::size_t i = 0; i < moving.size(); ++i) {
    if (moving.z[i] == 0.0f) continue;
    const Eigen::Vector3d p = rotation * Eigen::Vector3d(moving.x[i], moving.y[i], moving.z[i]);
    if (p.z() < 0.1) continue;
    const Eigen::Vector2d pixel = fixed.camera.project(p);
    if (!fixed.camera.contains(pixel.x(), pixel.y())) continue;
    sum += p;
    ++n;
  }
  return n > 0 ? Eigen::Vector3d(sum / n) : Eigen::Vector3d(0, 0, 2);
}

}  // namespace

std::vector<Pose> find_starts(const PreviewView& moving_coarse, const PreviewView& fixed_coarse,
                              const StartRange& range) {
  std::vector<Pose> starts;
  for (const Judged& judged : best_rotations(moving_coarse, fixed_coarse, range)) {
    const Eigen::Vector3d middle = middle_of(moving_coarse, fixed_coarse, judged.rotation);
    for (const auto& [yaw, pitch] : kTurns) {
      const Eigen::Matrix3d turn = (Eigen::AngleAxisd(yaw * kDegree, Eigen::Vector3d::UnitY()) *
                                    Eigen::AngleAxisd(pitch * kDegree, Eigen::Vector3d::UnitX()))
                                       .toRotationMatrix();
      Pose start = Pose::Identity();
      start.linear() = turn * judged.rotation;
      start.translation() = middle - turn * middle + Eigen::Vector3d(0, 0, judged.forward);
      starts.push_back(start);
    }
  }
  return starts;
}

}  // namespace rprr
