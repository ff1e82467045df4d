// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_pose/preview_starts.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <utility>

namespace rprr {
namespace {

constexpr double kDegree = M_PI / 180.0;
// The numbers of the search weigh right poses against time. `rprr_eval poses` and `rprr_eval
// timing` print what they give (docs/pose.md).

// A starting pose with a smaller overlap, as a share of the moving view's cells, is dropped.
constexpr float kLeastOverlap = 0.12f;
// Score: colour counts half of depth, and overlap little, since true poses may overlap by half.
constexpr float kColourWeight = 0.5f;
constexpr float kOverlapPower = 0.3f;

// First stage: rotations, each with steps of the fixed camera along its axis [typical depths].
constexpr std::array<float, 5> kForward = {0.0f, -0.3f, 0.3f, -0.55f, 0.6f};
constexpr double kRollSteps = 2.0;      // cameras roll less than they turn: wider steps do
constexpr double kRotationApart = 1.6;  // rotations that go on differ by so many steps, or
constexpr double kForwardApart = 0.2;   // their steps along the axis by this [typical depths]

// Second stage: turns about the middle of the scene [degrees], with the camera nearer or farther
// [typical depths].
constexpr std::array<double, 11> kYawTurns = {0, -15, 15, -30, 30, -45, 45, -60, 60, -75, 75};
constexpr std::array<double, 5> kPitchTurns = {0, -14, 14, -28, 28};
constexpr std::array<float, 3> kNearer = {0.0f, -0.2f, 0.2f};
constexpr double kTurnApart = 6.0;    // [degrees] poses that go on differ by so much, or
constexpr double kPlaceApart = 0.08;  // by this [typical depths]; after the climb by half of both

// How far depths may differ, relatively. After a rotation alone parallax moves them; with a shift
// they should agree better.
constexpr float kRotationTolerance = 0.5f;
constexpr float kMotionTolerance = 0.3f;

// The climb's first step in each direction, and the sizes of later ones relative to it.
constexpr double kClimbDegrees = 8.0;
constexpr double kClimbDepths = 0.15;  // [typical depths]
constexpr std::array<double, 4> kClimb = {1.0, 1.0, 0.6, 0.36};

// matches_along looks so many steps either way.
constexpr int kProbes = 20;
constexpr double kProbeStep = 0.18;  // [m]
constexpr int kFewestSteps = 2;      // a match nearer than so many steps is the pose itself
constexpr std::size_t kMostPeaks = 2;

struct Judged {
  Pose a_from_b = Pose::Identity();
  float score = 0.0f;
};

bool better(const Judged& left, const Judged& right) {
  return left.score > right.score;
}

float score_of(const CoarseScore& found) {
  if (found.overlap < kLeastOverlap) return 0.0f;
  return std::max(0.0f, kColourWeight * found.colour + found.depth) *
         std::pow(found.overlap, kOverlapPower);
}

Eigen::Matrix3d turn_of(double yaw, double pitch, double roll) {
  return (Eigen::AngleAxisd(yaw * kDegree, Eigen::Vector3d::UnitY()) *
          Eigen::AngleAxisd(pitch * kDegree, Eigen::Vector3d::UnitX()) *
          Eigen::AngleAxisd(roll * kDegree, Eigen::Vector3d::UnitZ()))
      .toRotationMatrix();
}

void judge(const CoarseMatch& match, float tolerance, Judged& one) {
  one.score = score_of(match.judge(one.a_from_b.linear().cast<float>(),
                                   one.a_from_b.translation().cast<float>(), tolerance));
}

// The best that are far enough from all better ones.
std::vector<Judged> distinct(std::vector<Judged> all, std::size_t most, double metres,
                             double degrees) {
  std::stable_sort(all.begin(), all.end(), better);
  const double least_cosine = std::cos(degrees * kDegree);
  std::vector<Judged> kept;
  for (const Judged& one : all) {
    if (kept.size() >= most || one.score <= 0.0f) break;
    const bool is_new = std::all_of(kept.begin(), kept.end(), [&](const Judged& other) {
      const Eigen::Matrix3d& l = one.a_from_b.linear();
      const Eigen::Matrix3d& r = other.a_from_b.linear();
      return (one.a_from_b.translation() - other.a_from_b.translation()).norm() > metres ||
             0.5 * (l.cwiseProduct(r).sum() - 1.0) < least_cosine;
    });
    if (is_new) kept.push_back(one);
  }
  return kept;
}

// Rotations with a step forward or back, as if all else were far away.
std::vector<Judged> best_rotations(const CoarseMatch& match, const StartRange& range) {
  std::vector<Judged> all;
  const auto steps_of = [](double reach, double step) {
    return static_cast<int>(reach / step + 1e-9);
  };
  const double roll_step = kRollSteps * range.step;
  const int yaws = steps_of(range.yaw, range.step);
  const int pitches = steps_of(range.pitch, range.step);
  const int rolls = steps_of(range.roll, roll_step);
  for (int i = -yaws; i <= yaws; ++i) {
    for (int j = -pitches; j <= pitches; ++j) {
      for (int k = -rolls; k <= rolls; ++k) {
        Judged one;
        one.a_from_b.linear() = turn_of(i * range.step, j * range.step, k * roll_step);
        for (const float forward : kForward) {
          one.a_from_b.translation().z() = static_cast<double>(forward * match.typical_depth());
          judge(match, kRotationTolerance, one);
          all.push_back(one);
        }
      }
    }
  }
  const double apart = kForwardApart * static_cast<double>(match.typical_depth());
  return distinct(std::move(all), range.rotations, apart, kRotationApart * range.step);
}

// The pose after a step along one of its degrees of freedom: a shift, or a turn about the middle of
// what is seen, so that the view stays on the scene.
Pose stepped(const Pose& a_from_b, int axis, double metres, double radians, double middle_depth) {
  Pose out = a_from_b;
  if (axis < 3) {
    out.translation()[axis] += metres;
    return out;
  }
  const Eigen::Vector3d middle = a_from_b * Eigen::Vector3d(0, 0, middle_depth);
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(radians, Eigen::Vector3d::Unit(axis - 3)).toRotationMatrix();
  out.linear() = turn * a_from_b.linear();
  out.translation() = turn * (a_from_b.translation() - middle) + middle;
  return out;
}

// Improves a pose step by step: the score knows free space and colour from further away than an
// alignment's gradient does.
void climb(const CoarseMatch& match, Judged& best) {
  const auto depth = static_cast<double>(match.typical_depth());
  for (const double size : kClimb) {
    for (int axis = 0; axis < 6; ++axis) {
      for (const double signed_size : {size, -size}) {
        Judged other;
        other.a_from_b = stepped(best.a_from_b, axis, kClimbDepths * depth * signed_size,
                                 kClimbDegrees * kDegree * signed_size, depth);
        judge(match, kMotionTolerance, other);
        if (other.score <= best.score) continue;
        best = other;
        break;
      }
    }
  }
}

std::vector<Eigen::Matrix3d> all_turns() {
  std::vector<Eigen::Matrix3d> turns;
  for (const double yaw : kYawTurns) {
    for (const double pitch : kPitchTurns) turns.push_back(turn_of(yaw, pitch, 0.0));
  }
  return turns;
}

}  // namespace

std::vector<Pose> find_starts(const CoarseMatch& match, const StartRange& range) {
  std::vector<Judged> turned;
  const std::vector<Eigen::Matrix3d> turns = all_turns();
  for (const Judged& rotation : best_rotations(match, range)) {
    const Eigen::Vector3d middle = match.middle(rotation.a_from_b);
    for (const Eigen::Matrix3d& turn : turns) {
      for (const float nearer : kNearer) {
        Judged one;
        one.a_from_b.linear() = turn * rotation.a_from_b.linear();
        one.a_from_b.translation() =
            turn * (rotation.a_from_b.translation() - middle) + middle * (1.0 + nearer);
        judge(match, kMotionTolerance, one);
        turned.push_back(one);
      }
    }
  }
  const double apart = kPlaceApart * static_cast<double>(match.typical_depth());
  std::vector<Judged> best = distinct(std::move(turned), range.starts, apart, kTurnApart);
  for (Judged& one : best) climb(match, one);
  std::vector<Pose> starts;
  for (const Judged& one : distinct(std::move(best), range.starts, 0.5 * apart, 0.5 * kTurnApart)) {
    starts.push_back(one.a_from_b);
  }
  return starts;
}

std::vector<double> matches_along(const CoarseMatch& match, const Pose& from,
                                  const Twist& direction) {
  std::array<Judged, 2 * kProbes + 1> line;
  for (int k = -kProbes; k <= kProbes; ++k) {
    Judged& one = line[static_cast<std::size_t>(k + kProbes)];
    one.a_from_b = exp_se3(k * kProbeStep * direction) * from;
    judge(match, kMotionTolerance, one);
  }
  std::vector<std::pair<float, double>> peaks;
  for (int k = 1 - kProbes; k < kProbes; ++k) {
    const auto i = static_cast<std::size_t>(k + kProbes);
    const float score = line[i].score;
    if (std::abs(k) < kFewestSteps || score <= 0.0f) continue;
    if (score < line[i - 1].score || score <= line[i + 1].score) continue;
    peaks.emplace_back(score, k * kProbeStep);
  }
  std::sort(peaks.begin(), peaks.end(), std::greater<>());
  std::vector<double> distances;
  for (const auto& [score, metres] : peaks) {
    if (distances.size() < kMostPeaks) distances.push_back(metres);
  }
  return distances;
}

}  // namespace rprr
