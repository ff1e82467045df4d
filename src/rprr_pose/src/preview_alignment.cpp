// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_pose/preview_alignment.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "agreement_weights.hpp"
#include "row_sums.hpp"
#include "rprr_pose/pinhole.hpp"

namespace rprr {
namespace {

constexpr std::size_t kChunk =
    128;                          // points that are projected at once, so that they stay in cache
constexpr float kNearest = 0.1f;  // [m] a point nearer to the fixed camera is left out
constexpr float kHuber = 1.5f;    // residuals beyond so many sigmas count less
constexpr int kFewestResiduals = 40;  // with fewer residuals the view is lost
constexpr float kFlat = 0.2f;         // [m] how far off its centre a cell's plane is trusted
// True poses of views that overlap little must not lose to wrong ones that overlap much.
constexpr double kOverlapPower = 0.2;
constexpr float kMeanToSigma = 1.2533f;  // sqrt(pi / 2): from mean deviation to sigma, if normal
constexpr float kCommonError = 0.005f;   // [m] sigma of the error that neighbours' depths share
// The covariance was too small by this factor: `rprr_eval consistency --first-seed 1`.
constexpr double kUnseen = 2.65;
constexpr double kTilesOfModel = 8.0;  // the residuals' variance counts as much as so many tiles

// A step is damped a little, relatively and absolutely, where nothing holds the pose.
constexpr double kRelativeDamping = 1e-4;
constexpr double kAbsoluteDamping = 1e-3;  // [1/m^2], [1/rad^2]
// A longer step has lost the view, and a shorter one ends the iteration.
constexpr double kLongestStep = 2.0;    // [m]
constexpr double kLargestTurn = 1.0;    // [rad]
constexpr double kShortestStep = 2e-4;  // [m]
constexpr double kSmallestTurn = 1e-4;  // [rad]

struct Luma {
  float value, du, dv;  // and its slope by pixel of the luma image
};

// Bilinear value and slope; false outside.
bool sample(const float* image, int width, int height, float u, float v, Luma& out) {
  if (!(u >= 0.0f && v >= 0.0f && u < static_cast<float>(width - 1) &&
        v < static_cast<float>(height - 1))) {
    return false;
  }
  const auto c = static_cast<int>(u);
  const auto r = static_cast<int>(v);
  const float fu = u - static_cast<float>(c);
  const float fv = v - static_cast<float>(r);
  const float* p = image + r * width + c;
  const float top = p[1] - p[0];
  const float bottom = p[width + 1] - p[width];
  out.du = top + fv * (bottom - top);
  out.dv = p[width] - p[0] + fu * (bottom - top);
  out.value = p[0] + fu * top + fv * out.dv;
  return true;
}

// Weight of a residual by its square, in units of its variance.
float huber(float squared) {
  return squared <= kHuber * kHuber ? 1.0f : kHuber / std::sqrt(squared);
}

// Affine exposure: fixed luma is about gain * moving luma + offset, give or take sigma.
struct Exposure {
  float gain = 1.0f;
  float offset = 0.0f;
  float sigma = 0.0f;
};

// Gradients by tile.
struct Tiles {
  std::vector<Twist> gradients;
  std::vector<int> residuals;

  void add(std::size_t tile, const Row& row, float weight) {
    if (tile >= gradients.size()) {
      gradients.resize(tile + 1, Twist::Zero());
      residuals.resize(tile + 1, 0);
    }
    for (int i = 0; i < 6; ++i) {
      gradients[tile][i] += static_cast<double>(weight * row.at[6] * row.at[i]);
    }
    ++residuals[tile];
  }
};

struct Sums {
  RowSums geometric, photometric;
  Tiles* tiles = nullptr;  // if they are wanted
  int geometry = 0, luma = 0;
  int close = 0, before = 0, behind = 0;
  float deviation = 0.0f;  // sum of absolute luma residuals
  // Moments of moving and fixed luma, for the next exposure.
  double m = 0, f = 0, mm = 0, ff = 0, mf = 0;

  void see(float moving, float fixed) {
    m += moving, f += fixed, mm += moving * moving, ff += fixed * fixed, mf += moving * fixed;
  }
  double correlation() const {
    if (luma < kFewestResiduals) return 0.0;
    const double n = luma;
    const double vm = mm / n - m / n * m / n;
    const double vf = ff / n - f / n * f / n;
    // A little constant variance, so that flat patches do not correlate by chance.
    return (mf / n - m / n * f / n) / std::sqrt((vm + 20.0) * (vf + 20.0));
  }
  Exposure exposure(const AlignmentOptions& options) const {
    Exposure out;
    out.sigma = options.most_luma_sigma;
    if (luma < kFewestResiduals) return out;
    const double n = luma;
    const double variance = mm / n - m / n * m / n;
    const double covariance = mf / n - m / n * f / n;
    out.gain =
        static_cast<float>(variance > 25.0 ? std::clamp(covariance / variance, 0.4, 2.5) : 1.0);
    out.offset = static_cast<float>(f / n - out.gain * m / n);
    out.sigma = std::clamp(kMeanToSigma * deviation / static_cast<float>(luma),
                           options.least_luma_sigma, options.most_luma_sigma);
    return out;
  }
};

// All that one iteration needs of the two views.
class Linearizer {
 public:
  Linearizer(const MovingPoints& moving, const FixedView& fixed)
      : moving_(moving), cells_(*fixed.cells) {
    const bool fine = !fixed.luma.empty();
    luma_ = fine ? fixed.luma.ptr<float>() : cells_.luma.data();
    luma_camera_ = Pinhole(fine ? fixed.luma_camera : cells_.camera);
    cell_camera_ = Pinhole(cells_.camera);
    metres_camera_ = Pinhole(fixed.metres_camera);
    metres_ = fixed.metres.empty() ? nullptr : fixed.metres.ptr<float>();
  }

  Sums at(const Pose& fixed_from_moving, float gate, const Exposure& exposure,
          Tiles* tiles = nullptr) const {
    Sums sums;
    sums.tiles = tiles;
    Projected projected;
    for (std::size_t begin = 0; begin < moving_.size(); begin += kChunk) {
      const std::size_t count = std::min(kChunk, moving_.size() - begin);
      project(fixed_from_moving, begin, count, projected);
      for (std::size_t k = 0; k < count; ++k) {
        if (projected.z[k] < kNearest) continue;
        one(begin + k, {projected.x[k], projected.y[k], projected.z[k]}, gate, exposure, sums);
      }
    }
    return sums;
  }

 private:
  // A moved point: the ray (x, y, 1) that it is on, and its depth.
  struct Place {
    float x, y, z;
  };
  struct Projected {
    std::array<float, kChunk> x, y, z;
  };

  void project(const Pose& fixed_from_moving, std::size_t begin, std::size_t count,
               Projected& out) const {
    const Eigen::Matrix3f r = fixed_from_moving.linear().cast<float>();
    const Eigen::Vector3f t = fixed_from_moving.translation().cast<float>();
    const float* x = moving_.x.data() + begin;
    const float* y = moving_.y.data() + begin;
    const float* z = moving_.z.data() + begin;
    for (std::size_t k = 0; k < count; ++k) {
      const float depth = r(2, 0) * x[k] + r(2, 1) * y[k] + r(2, 2) * z[k] + t[2];
      const float inverse = 1.0f / depth;
      out.x[k] = (r(0, 0) * x[k] + r(0, 1) * y[k] + r(0, 2) * z[k] + t[0]) * inverse;
      out.y[k] = (r(1, 0) * x[k] + r(1, 1) * y[k] + r(1, 2) * z[k] + t[1]) * inverse;
      out.z[k] = depth;
    }
  }

  void one(std::size_t i, const Place& p, float gate, const Exposure& exposure, Sums& sums) const {
    const int index = cell_camera_.index_of_ray(p.x, p.y);
    if (index < 0) return;
    const auto j = static_cast<std::size_t>(index);
    const float z = fixed_depth(j, p.x, p.y);
    if (z == 0.0f) return;
    const float off = p.z - z;
    if (std::abs(off) > gate) {
      ++(off < 0.0f ? sums.before : sums.behind);
      return;
    }
    ++sums.close;
    const float nx = cells_.nx[j], ny = cells_.ny[j], nz = cells_.nz[j];
    if (nx != 0.0f || ny != 0.0f || nz != 0.0f) {
      // The fixed surface's point on the same ray, so that only the normal part of `off` counts.
      const float facing = nx * p.x + ny * p.y + nz;
      const float noise = moving_.variance[i] + cells_.sigma[j] * cells_.sigma[j];
      const float variance = noise * facing * facing + kCommonError * kCommonError;
      const float residual = facing * off;
      const Row row{{nx, ny, nz, p.z * (p.y * nz - ny), p.z * (nx - p.x * nz),
                     p.z * (p.x * ny - p.y * nx), residual, 0.0f}};
      const float weight = huber(residual * residual / variance) / variance;
      sums.geometric.add(row, weight);
      if (sums.tiles) sums.tiles->add(moving_.tile[i], row, weight);
      ++sums.geometry;
    }
    photometric(i, p, exposure, sums);
  }

  void photometric(std::size_t i, const Place& p, const Exposure& exposure, Sums& sums) const {
    const float fx = luma_camera_.fx;
    const float fy = luma_camera_.fy;
    Luma luma;
    if (!sample(luma_, luma_camera_.width, luma_camera_.height, fx * p.x + luma_camera_.cx,
                fy * p.y + luma_camera_.cy, luma)) {
      return;
    }
    sums.see(moving_.luma[i], luma.value);
    ++sums.luma;
    const float residual = luma.value - exposure.gain * moving_.luma[i] - exposure.offset;
    sums.deviation += std::abs(residual);
    // d(luma)/dp by the projection, then dp/dtwist = [I | -[p]x]; the depth cancels in the turn.
    const float gx = luma.du * fx;
    const float gy = luma.dv * fy;
    const float gz = -(gx * p.x + gy * p.y);
    const float inverse = 1.0f / p.z;
    const Row row{{gx * inverse, gy * inverse, gz * inverse, p.y * gz - gy, gx - p.x * gz,
                   p.x * gy - p.y * gx, residual, 0.0f}};
    const float variance = exposure.sigma * exposure.sigma;
    const float weight = huber(residual * residual / variance) / variance;
    sums.photometric.add(row, weight);
    if (sums.tiles) sums.tiles->add(moving_.tile[i], row, weight);
  }

  float fixed_depth(std::size_t cell, float x, float y) const {
    if (metres_) {
      const int index = metres_camera_.index_of_ray(x, y);
      return index < 0 ? 0.0f : metres_[index];
    }
    // The cell's plane, met by the ray through the point.
    const float z = cells_.z[cell];
    if (z == 0.0f) return 0.0f;
    const float nx = cells_.nx[cell], ny = cells_.ny[cell], nz = cells_.nz[cell];
    const float facing = nx * x + ny * y + nz;
    if (std::abs(facing) < 0.1f) return z;
    const float met = (nx * cells_.x[cell] + ny * cells_.y[cell] + nz * z) / facing;
    return std::abs(met - z) < kFlat ? met : z;
  }

  const MovingPoints& moving_;
  const PreviewView& cells_;
  const float* luma_;
  const float* metres_ = nullptr;
  Pinhole luma_camera_, cell_camera_, metres_camera_;
};

void store(const Sums& found, std::size_t points, const Exposure& exposure, AlignmentSums& sums) {
  sums.geometric = found.geometric.information();
  sums.information = sums.geometric + found.photometric.information();
  sums.chi2_geometry = found.geometric.squares();
  sums.chi2_luma = found.photometric.squares();
  sums.luma_sigma = static_cast<double>(exposure.sigma);
  sums.geometry = found.geometry;
  sums.luma = found.luma;
  sums.points = static_cast<int>(points);
  sums.close = found.close;
  sums.before = found.before;
  sums.behind = found.behind;
  sums.correlation = found.correlation();
}

void store(const Tiles& tiles, AlignmentSums& sums) {
  sums.scatter.setZero();
  sums.tiles = 0;
  for (std::size_t i = 0; i < tiles.gradients.size(); ++i) {
    if (tiles.residuals[i] == 0) continue;
    sums.scatter += tiles.gradients[i] * tiles.gradients[i].transpose();
    ++sums.tiles;
  }
}

Twist step_of(const Sums& found, const Matrix6& information) {
  Matrix6 damped = information;
  damped.diagonal() *= 1.0 + kRelativeDamping;
  damped.diagonal().array() += kAbsoluteDamping;
  return damped.ldlt().solve(-(found.geometric.gradient() + found.photometric.gradient()));
}

}  // namespace

double AlignmentSums::score() const {
  const int met = close + before + behind;
  if (met == 0) return 0.0;
  const double agreement = (close - kViolatingWeight * before - kHiddenWeight * behind) / met;
  if (agreement <= 0.0 || correlation <= 0.0) return 0.0;
  return agreement * correlation * std::pow(static_cast<double>(met) / points, kOverlapPower);
}

MovingPoints points_of(const PreviewView& view, int stride) {
  MovingPoints points;
  const std::size_t most = view.size() / static_cast<std::size_t>(stride) + 1;
  for (auto* array : {&points.x, &points.y, &points.z, &points.variance, &points.luma}) {
    array->reserve(most);
  }
  points.tile.reserve(most);
  const int tiles = (view.width() + kTileCells - 1) / kTileCells;
  const int shift = std::max(1, stride / 2);
  for (int r = 0; r < view.height(); ++r) {
    for (int c = (stride - r * shift % stride) % stride; c < view.width(); c += stride) {
      const auto i = static_cast<std::size_t>(r * view.width() + c);
      if (view.z[i] == 0.0f) continue;
      points.x.push_back(view.x[i]);
      points.y.push_back(view.y[i]);
      points.z.push_back(view.z[i]);
      points.variance.push_back(view.sigma[i] * view.sigma[i]);
      points.luma.push_back(view.luma[i]);
      points.tile.push_back(static_cast<std::uint16_t>(r / kTileCells * tiles + c / kTileCells));
    }
  }
  return points;
}

bool align(const MovingPoints& moving, const FixedView& fixed, const AlignmentOptions& options,
           Pose& fixed_from_moving, AlignmentSums& sums) {
  const Linearizer linearizer(moving, fixed);
  const float shrink = std::pow(options.last_gate / options.gate,
                                1.0f / static_cast<float>(std::max(1, options.iterations - 1)));
  float gate = options.gate;
  // A first look, for the exposure alone.
  Exposure exposure = linearizer.at(fixed_from_moving, gate, {}).exposure(options);
  exposure.sigma = options.most_luma_sigma;
  for (int i = 0; i < options.iterations; ++i) {
    const Sums found = linearizer.at(fixed_from_moving, gate, exposure);
    store(found, moving.size(), exposure, sums);
    if (found.geometry + found.luma < kFewestResiduals) return false;
    const Twist step = step_of(found, sums.information);
    const double metres = step.head<3>().norm();
    const double radians = step.tail<3>().norm();
    if (!step.allFinite() || metres > kLongestStep || radians > kLargestTurn) return false;
    fixed_from_moving = exp_se3(step) * fixed_from_moving;
    if (metres < kShortestStep && radians < kSmallestTurn && gate <= options.last_gate) break;
    exposure = found.exposure(options);
    gate = std::max(gate * shrink, options.last_gate);
  }
  if (options.scatter) {
    Tiles tiles;
    linearizer.at(fixed_from_moving, options.last_gate, exposure, &tiles);
    store(tiles, sums);
  }
  return true;
}

// Neighbouring cells share errors of the sensor, so that the number of residuals promises too much.
// What such errors do to the estimate is taken from the residuals' sums over tiles. Where tiles are
// few, the residuals' own variance counts as well. Neither sees the coding, or noise in the slopes
// that residuals are projected on: that is the factor kUnseen.
Matrix6 covariance_of(const AlignmentSums& sums) {
  const double freedom = std::max(1, sums.geometry + sums.luma - 6);
  const double scale = std::max(1.0, (sums.chi2_geometry + sums.chi2_luma) / freedom);
  Matrix6 information = sums.information;
  information.diagonal().array() += 1.0;
  const Matrix6 inverse = information.inverse();
  const double tiles = sums.tiles;
  const Matrix6 clustered = tiles / std::max(1.0, tiles - 6.0) * inverse * sums.scatter * inverse;
  return kUnseen * (tiles * clustered + kTilesOfModel * scale * inverse) / (tiles + kTilesOfModel);
}

double worst_sigma(const Eigen::Matrix3d& covariance) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(covariance, Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(0.0, eigen.eigenvalues().maxCoeff()));
}

}  // namespace rprr
