// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_pose/preview_alignment.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace rprr {
namespace {

using Vector6f = Eigen::Matrix<float, 6, 1>;

// Lower triangle of a symmetric 6x6 matrix, row by row.
struct Symmetric6 {
  float at[21] = {};
  void add(const Vector6f& row, float weight) {
    int k = 0;
    for (int i = 0; i < 6; ++i) {
      const float scaled = weight * row[i];
      for (int j = 0; j <= i; ++j) at[k++] += scaled * row[j];
    }
  }
  Matrix6 full() const {
    Matrix6 out;
    int k = 0;
    for (int i = 0; i < 6; ++i) {
      for (int j = 0; j <= i; ++j) out(i, j) = out(j, i) = at[k++];
    }
    return out;
  }
};

// A camera in float32, for the inner loop.
struct Pinhole {
  float fx = 0, fy = 0, cx = 0, cy = 0;
  int width = 0, height = 0;
  Pinhole() = default;
  explicit Pinhole(const Camera& camera)
      : fx(static_cast<float>(camera.fx)),
        fy(static_cast<float>(camera.fy)),
        cx(static_cast<float>(camera.cx)),
        cy(static_cast<float>(camera.cy)),
        width(camera.width),
        height(camera.height) {}
  // Index of the pixel at the normalised coordinates, or -1.
  int index(float x, float y) const {
    const float u = fx * x + cx + 0.5f;
    const float v = fy * y + cy + 0.5f;
    if (!(u >= 0.0f && v >= 0.0f)) return -1;
    const auto c = static_cast<int>(u);
    const auto r = static_cast<int>(v);
    return c < width && r < height ? r * width + c : -1;
  }
};

constexpr float kNearest = 0.1f;
constexpr float kHuber = 1.5f;        // in sigmas
constexpr int kFewestResiduals = 40;  // below this a view is lost
constexpr float kFlat = 2.0f;         // metres: how far one cell's plane is trusted off its centre

struct Luma {
  float value, du, dv;  // and its slope by pixel of the luma image
};

// Bilinear value and slope; false outside.
bool sample(const float* image, int width, int height, float u, float v, Luma& out) {
  const int c = static_cast<int>(std::floor(u));
  const int r = static_cast<int>(std::floor(v));
  if (c < 0 || r < 0 || c + 1 >= width || r + 1 >= height) return false;
  const float fu = u - static_cast<float>(c);
  const float fv = v - static_cast<float>(r);
  const float* p = image + r * width + c;
  const float top = p[0] + fu * (p[1] - p[0]);
  const float bottom = p[width] + fu * (p[width + 1] - p[width]);
  out.value = top + fv * (bottom - top);
  out.du = (1.0f - fv) * (p[1] - p[0]) + fv * (p[width + 1] - p[width]);
  out.dv = bottom - top;
  return true;
}

float huber(float residual) {
  const float size = std::abs(residual);
  return size <= kHuber ? 1.0f : kHuber / size;
}

// Affine exposure: fixed luma is about gain * moving luma + offset.
struct Exposure {
  float gain = 1.0f;
  float offset = 0.0f;
};

struct Accumulator {
  Symmetric6 geometric;
  Symmetric6 photometric;
  Vector6f gradient = Vector6f::Zero();
  double chi2_geometry = 0, chi2_luma = 0;
  int geometry = 0, luma = 0;
  int cells = 0, close = 0, before = 0, behind = 0;
  // Moments for the next exposure.
  double m = 0, f = 0, mm = 0, ff = 0, mf = 0;

  void add(Symmetric6& information, const Vector6f& row, float residual, float weight) {
    information.add(row, weight);
    gradient.noalias() -= row * (weight * residual);
  }
  void see(float moving, float fixed) {
    m += moving, f += fixed, mm += moving * moving, ff += fixed * fixed, mf += moving * fixed;
  }
  double correlation() const {
    if (luma < kFewestResiduals) return 0.0;
    const double n = luma;
    const double vm = mm / n - m / n * m / n;
    const double vf = ff / n - f / n * f / n;
    return (mf / n - m / n * f / n) / std::sqrt((vm + 20.0) * (vf + 20.0));
  }
  Exposure exposure() const {
    if (luma < kFewestResiduals) return {};
    const double n = luma;
    const double variance = mm / n - m / n * m / n;
    const double covariance = mf / n - m / n * f / n;
    Exposure out;
    out.gain =
        static_cast<float>(variance > 25.0 ? std::clamp(covariance / variance, 0.4, 2.5) : 1.0);
    out.offset = static_cast<float>(f / n - out.gain * m / n);
    return out;
  }
};

// All that one iteration needs of the two views.
class Linearizer {
 public:
  Linearizer(const PreviewView& moving, const FixedView& fixed, const AlignmentOptions& options)
      : moving_(moving), options_(options), cells_(*fixed.cells) {
    const bool fine = !fixed.luma.empty();
    luma_ = fine ? fixed.luma.ptr<float>() : cells_.luma.data();
    luma_camera_ = Pinhole(fine ? fixed.luma_camera : cells_.camera);
    cell_camera_ = Pinhole(cells_.camera);
    metres_camera_ = Pinhole(fixed.metres_camera);
    metres_ = fixed.metres.empty() ? nullptr : fixed.metres.ptr<float>();
  }

  Accumulator at(const Pose& motion, float gate, const Exposure& exposure) const {
    const Eigen::Matrix3f rotation = motion.linear().cast<float>();
    const Eigen::Vector3f translation = motion.translation().cast<float>();
    Accumulator sums;
    for (std::size_t i = 0; i < moving_.size(); i += static_cast<std::size_t>(options_.stride)) {
      if (moving_.z[i] == 0.0f) continue;
      ++sums.cells;
      const Eigen::Vector3f p =
          rotation * Eigen::Vector3f(moving_.x[i], moving_.y[i], moving_.z[i]) + translation;
      if (p.z() < kNearest) continue;
      one(i, p, gate, exposure, sums);
    }
    return sums;
  }

 private:
  void one(std::size_t i, const Eigen::Vector3f& p, float gate, const Exposure& exposure,
           Accumulator& sums) const {
    const float inverse = 1.0f / p.z();
    const float x = p.x() * inverse;
    const float y = p.y() * inverse;
    const int index = cell_camera_.index(x, y);
    if (index < 0) return;
    const auto j = static_cast<std::size_t>(index);
    const float z = fixed_depth(j, x, y);
    if (z == 0.0f) return;
    const float off = p.z() - z;
    if (std::abs(off) > gate) {
      ++(off < 0.0f ? sums.before : sums.behind);
      return;
    }
    ++sums.close;
    const bool surface = cells_.nx[j] != 0.0f || cells_.ny[j] != 0.0f || cells_.nz[j] != 0.0f;
    if (surface) {
      // The fixed surface's point on the same ray, so that only the normal part of `off` counts.
      const Eigen::Vector3f n(cells_.nx[j], cells_.ny[j], cells_.nz[j]);
      const float facing = n.x() * x + n.y() * y + n.z();
      const float residual = facing * off;
      const float sigma_m = moving_.sigma[i] * facing;
      const float sigma_f = cells_.sigma[j] * facing;
      const float variance = sigma_m * sigma_m + sigma_f * sigma_f + 2.5e-5f;
      const float normalised = residual / std::sqrt(variance);
      Vector6f row;
      row.head<3>() = n;
      row.tail<3>() = p.cross(n);
      const float weight = huber(normalised);
      sums.add(sums.geometric, row, residual, weight / variance);
      sums.chi2_geometry += weight * normalised * normalised;
      ++sums.geometry;
    }
    photometric(i, p, x, y, exposure, sums);
  }

  void photometric(std::size_t i, const Eigen::Vector3f& p, float x, float y,
                   const Exposure& exposure, Accumulator& sums) const {
    const float fx = luma_camera_.fx;
    const float fy = luma_camera_.fy;
    Luma luma;
    if (!sample(luma_, luma_camera_.width, luma_camera_.height, fx * x + luma_camera_.cx,
                fy * y + luma_camera_.cy, luma)) {
      return;
    }
    sums.see(moving_.luma[i], luma.value);
    ++sums.luma;
    const float residual = luma.value - exposure.gain * moving_.luma[i] - exposure.offset;
    const float normalised = residual / options_.luma_sigma;
    const float weight = huber(normalised);
    sums.chi2_luma += weight * normalised * normalised;
    // d(luma)/dp by the projection, then dp/dtwist = [I | -[p]x].
    const float inverse = 1.0f / p.z();
    const Eigen::Vector3f slope(luma.du * fx * inverse, luma.dv * fy * inverse,
                                -(luma.du * fx * x + luma.dv * fy * y) * inverse);
    Vector6f row;
    row.head<3>() = slope;
    row.tail<3>() = p.cross(slope);
    sums.add(sums.photometric, row, residual, weight / (options_.luma_sigma * options_.luma_sigma));
  }

  float fixed_depth(std::size_t cell, float x, float y) const {
    if (!metres_) {
      // The cell's plane, met by the ray through the point.
      const float z = cells_.z[cell];
      if (z == 0.0f) return 0.0f;
      const float facing = cells_.nx[cell] * x + cells_.ny[cell] * y + cells_.nz[cell];
      if (std::abs(facing) < 0.1f) return z;
      const float distance =
          cells_.nx[cell] * cells_.x[cell] + cells_.ny[cell] * cells_.y[cell] + cells_.nz[cell] * z;
      const float met = distance / facing;
      return std::abs(met - z) < 0.1f * kFlat ? met : z;
    }
    const int index = metres_camera_.index(x, y);
    return index < 0 ? 0.0f : metres_[index];
  }

  const PreviewView& moving_;
  const AlignmentOptions& options_;
  const PreviewView& cells_;
  const float* luma_;
  const float* metres_ = nullptr;
  Pinhole luma_camera_, cell_camera_, metres_camera_;
};

}  // namespace

bool align(const PreviewView& moving, const FixedView& fixed, const AlignmentOptions& options,
           Pose& motion, AlignmentSums& sums) {
  const Linearizer linearizer(moving, fixed, options);
  const float shrink = std::pow(options.last_gate / options.gate,
                                1.0f / static_cast<float>(std::max(1, options.iterations - 1)));
  float gate = options.gate;
  Exposure exposure;
  // A first look, for the exposure alone.
  exposure = linearizer.at(motion, gate, exposure).exposure();
  for (int i = 0; i < options.iterations; ++i) {
    const Accumulator found = linearizer.at(motion, gate, exposure);
    sums.geometric = found.geometric.full();
    sums.information = sums.geometric + found.photometric.full();
    sums.chi2_geometry = found.chi2_geometry;
    sums.chi2_luma = found.chi2_luma;
    sums.geometry = found.geometry;
    sums.luma = found.luma;
    sums.cells = found.cells;
    sums.close = found.close;
    sums.before = found.before;
    sums.behind = found.behind;
    sums.correlation = found.correlation();
    if (found.geometry + found.luma < kFewestResiduals) return false;
    Matrix6 damped = sums.information;
    damped.diagonal() *= 1.0 + 1e-4;
    damped.diagonal().array() += 1e-3;
    const Twist step = damped.ldlt().solve(found.gradient.cast<double>());
    if (!step.allFinite() || step.head<3>().norm() > 2.0 || step.tail<3>().norm() > 1.0)
      return false;
    motion = exp_se3(step) * motion;
    if (step.head<3>().norm() < 2e-4 && step.tail<3>().norm() < 1e-4 && gate <= options.last_gate) {
      break;
    }
    exposure = found.exposure();
    gate = std::max(gate * shrink, options.last_gate);
  }
  return true;
}

}  // namespace rprr
