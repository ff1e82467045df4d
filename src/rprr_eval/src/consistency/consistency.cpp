// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_eval/consistency/consistency.hpp"

#include <Eigen/Cholesky>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
#include <limits>
#include <memory>

#include "rprr_eval/exchange/exchange_registration.hpp"
#include "rprr_eval/measure/median.hpp"
#include "rprr_eval/turntable/turntable.hpp"
#include "rprr_geometry/relative_pose.hpp"
#include "rprr_synthetic/random.hpp"
#include "rprr_synthetic/sensor_model.hpp"
#include "rprr_synthetic/trajectory.hpp"
#include "rprr_wire/camera_wire.hpp"

namespace rprr {
namespace {

// The value that a chi-square variable of so many degrees of freedom does not exceed with that
// probability.
double quantile(double probability, double freedom) {
  return boost::math::quantile(boost::math::chi_squared(freedom), probability);
}

constexpr double kDegree = M_PI / 180.0;

Eigen::Vector3d random_direction(Random& random) {
  const double z = random.between(-1.0, 1.0);
  const double turn = random.between(-M_PI, M_PI);
  const double r = std::sqrt(1.0 - z * z);
  return {r * std::cos(turn), r * std::sin(turn), z};
}

// Somewhere about the middle of the room, where there is space, gaze outwards and somewhat down.
Pose view_of_room(Random& random) {
  const double turn = random.between(-M_PI, M_PI);
  const double out = random.between(0.2, 1.0);
  const Eigen::Vector3d eye(out * std::cos(turn), 0.75 * out * std::sin(turn),
                            random.between(1.2, 1.5));
  return look_along(eye, turn + random.between(-40.0, 40.0) * kDegree,
                    random.between(-22.0, -4.0) * kDegree, random.between(-4.0, 4.0) * kDegree);
}

// From along the corridor to at a wall.
Pose view_of_corridor(Random& random) {
  const Eigen::Vector3d eye(random.between(-1.0, 1.0), random.between(-0.4, 0.4),
                            random.between(1.2, 1.5));
  return look_along(eye, random.between(-60.0, 60.0) * kDegree,
                    random.between(-22.0, -4.0) * kDegree, random.between(-4.0, 4.0) * kDegree);
}

Scene make_scene(TrueScene scene, std::uint32_t seed) {
  if (scene == TrueScene::kTurntable) return make_turntable(seed);
  return scene == TrueScene::kCorridor ? make_corridor(seed) : make_room(seed);
}

Pose random_view(TrueScene scene, Random& random) {
  if (scene == TrueScene::kTurntable) return turntable_camera(random.between(0.0, 360.0));
  return scene == TrueScene::kCorridor ? view_of_corridor(random) : view_of_room(random);
}

Pose random_motion(Random& random, const ConsistencyOptions& options) {
  const double angle = random.between(0.0, options.max_degrees) * kDegree;
  Pose motion = Pose::Identity();
  motion.linear() = Eigen::AngleAxisd(angle, random_direction(random)).toRotationMatrix();
  motion.translation() = random.between(0.0, options.max_metres) * random_direction(random);
  return motion;
}

RgbdFramePtr frame_of(const Scene& scene, const SensorModel& sensor, const Pose& world_from_camera,
                      std::uint32_t noise) {
  RgbdImage image = sense(scene, sensor, world_from_camera, noise);
  auto frame = std::make_shared<RgbdFrame>();
  frame->stamp = from_seconds(1.0);
  frame->camera = rounded_for_wire(sensor.camera);
  frame->depth = std::move(image.depth);
  frame->bgr = std::move(image.bgr);
  return frame;
}

template <int Size>
double squared_mahalanobis(const Eigen::Matrix<double, Size, 1>& error,
                           const Eigen::Matrix<double, Size, Size>& covariance) {
  const Eigen::LLT<Eigen::Matrix<double, Size, Size>> root(covariance);
  if (root.info() != Eigen::Success) return std::numeric_limits<double>::infinity();
  return root.matrixL().solve(error).squaredNorm();
}

}  // namespace

std::vector<TruePair> consistency_pairs(std::uint32_t seed, const ConsistencyOptions& options) {
  const Scene scene = make_scene(options.scene, seed);
  const SensorModel sensor_a = example_sensor_a(options.width, options.width * 3 / 4);
  const SensorModel sensor_b = example_sensor_b(options.width, options.width * 3 / 4);
  Random random(seed);
  std::vector<TruePair> pairs;
  for (int k = 0; k < options.pairs_per_scene; ++k) {
    const Pose at_a = random_view(options.scene, random);
    const Pose at_b = at_a * random_motion(random, options);
    const auto noise_a = static_cast<std::uint32_t>(random.bits());
    const auto noise_b = static_cast<std::uint32_t>(random.bits());
    pairs.push_back({frame_of(scene, sensor_a, at_a, noise_a),
                     frame_of(scene, sensor_b, at_b, noise_b), relative_pose_of(at_a, at_b)});
  }
  return pairs;
}

PoseTrial try_pair(const TruePair& pair, const Profile& profile) {
  constexpr Stamp kStamp = from_seconds(1000.0);
  PoseTrial trial;
  trial.overlap = overlap(pair.a->depth, pair.a->camera, pair.b->depth, pair.b->camera, pair.truth);
  trial.true_degrees = rotation_angle(pair.truth.linear()) / kDegree;
  trial.true_metres = pair.truth.inverse().translation().norm();
  ExchangeHarness harness = make_exchange(profile, 0);
  const ExchangeOutcome outcome = harness.run(as_frame_of(*pair.a, "eyebug_a", kStamp),
                                              as_frame_of(*pair.b, "eyebug_b", kStamp));
  if (!outcome.pose) return trial;
  trial.verdict = outcome.pose->verdict;
  trial.error = pose_error(outcome.pose->b_from_a, pair.truth);
  trial.perturbation = log_se3(outcome.pose->b_from_a * pair.truth.inverse());
  trial.covariance = outcome.pose->covariance;
  return trial;
}

double normalised_error(const PoseTrial& trial) {
  return squared_mahalanobis<6>(trial.perturbation, trial.covariance);
}

double normalised_error_of_half(const PoseTrial& trial, int first) {
  return squared_mahalanobis<3>(trial.perturbation.segment<3>(first),
                                trial.covariance.block<3, 3>(first, first));
}

NormalisedErrors normalised_errors(const std::vector<double>& errors, int freedom) {
  NormalisedErrors out;
  out.freedom = freedom;
  if (errors.empty()) return out;
  const auto count = static_cast<double>(errors.size());
  const double most = quantile(0.95, freedom);
  for (const double error : errors) {
    out.mean += error / count;
    out.share_within_95 += error <= most ? 1.0 / count : 0.0;
  }
  // The sum of N of them has N times the degrees of freedom.
  out.mean_from = quantile(0.025, freedom * count) / count;
  out.mean_to = quantile(0.975, freedom * count) / count;
  out.median = median(errors);
  out.scale_by_mean = out.mean / freedom;
  out.scale_by_median = out.median / quantile(0.5, freedom);
  return out;
}

ConsistencySummary summarise(const std::vector<PoseTrial>& trials) {
  ConsistencySummary out;
  std::vector<double> metres, degrees, all, translation, rotation;
  for (const PoseTrial& trial : trials) {
    ++out.pairs;
    if (!trial.accepted()) continue;
    ++out.accepted;
    out.accepted_right += is_right(trial.error) ? 1 : 0;
    out.accepted_wrong += is_wrong(trial.error) ? 1 : 0;
    metres.push_back(trial.error.metres);
    degrees.push_back(trial.error.degrees);
    all.push_back(normalised_error(trial));
    translation.push_back(normalised_error_of_half(trial, 0));
    rotation.push_back(normalised_error_of_half(trial, 3));
    const Twist sigma = trial.covariance.diagonal().cwiseSqrt();
    const Twist normalised = trial.perturbation.cwiseQuotient(sigma);
    out.mean += normalised;
    out.rms += normalised.cwiseAbs2();
  }
  if (out.accepted == 0) return out;
  out.mean /= out.accepted;
  out.rms = (out.rms / out.accepted).cwiseSqrt();
  out.median_metres = median(metres);
  out.median_degrees = median(degrees);
  out.p95_metres = percentile(metres, 0.95);
  out.p95_degrees = percentile(degrees, 0.95);
  out.all = normalised_errors(all, 6);
  out.translation = normalised_errors(translation, 3);
  out.rotation = normalised_errors(rotation, 3);
  return out;
}

}  // namespace rprr
