// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_eval/belief/belief.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "rprr_eval/consistency/consistency.hpp"
#include "rprr_eval/measure/median.hpp"
#include "rprr_pose/preview_pose.hpp"
#include "rprr_wire/preview.hpp"

namespace rprr {
namespace {

constexpr int kTerms = static_cast<int>(kEvidenceTerms);
constexpr double kShrinkage = 1.0;
constexpr int kNewtonSteps = 60;
constexpr TrueScene kScenes[] = {TrueScene::kRoom, TrueScene::kTurntable, TrueScene::kCorridor};

// truth: nothing for frames of two places.
void add_sample(const RgbdFrame& a, const RgbdFrame& b, const std::optional<Pose>& truth,
                const Profile& profile, std::vector<BeliefSample>& samples) {
  const Result<BlockPreview> preview = decode_preview(encode_preview(
      make_preview(b.depth, b.bgr, profile.preview.step), profile.preview.colour_quality));
  if (!preview) return;
  PreviewPoseEstimator estimator(profile.preview.search);
  const PreviewPose found = estimator.estimate(a, *preview, b.camera, {});
  const double overlap = std::min(found.b_in_a.overlap(), found.a_in_b.overlap());
  if (overlap < profile.preview.search.limits.min_overlap) return;
  BeliefSample sample;
  sample.evidence = found.evidence;
  if (truth) {
    const PoseError error = pose_error(found.b_from_a, *truth);
    if (!is_right(error) && !is_wrong(error)) return;
    sample.right = is_right(error);
  }
  samples.push_back(sample);
}

// Terms with mean 0 and deviation 1, and a 1 for the constant.
struct Standardised {
  Eigen::MatrixXd rows;
  Eigen::VectorXd mean, deviation;
};

Standardised standardise(const std::vector<BeliefSample>& samples) {
  Standardised out;
  out.rows.resize(static_cast<Eigen::Index>(samples.size()), kTerms + 1);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const auto terms = terms_of(samples[i].evidence);
    const auto row = static_cast<Eigen::Index>(i);
    for (int k = 0; k < kTerms; ++k) out.rows(row, k) = terms[static_cast<std::size_t>(k)];
    out.rows(row, kTerms) = 1.0;
  }
  out.mean = out.rows.leftCols(kTerms).colwise().mean();
  out.deviation.resize(kTerms);
  for (int k = 0; k < kTerms; ++k) {
    out.rows.col(k).array() -= out.mean[k];
    out.deviation[k] =
        std::sqrt(out.rows.col(k).squaredNorm() / static_cast<double>(samples.size())) + 1e-9;
    out.rows.col(k) /= out.deviation[k];
  }
  return out;
}

}  // namespace

std::vector<BeliefSample> belief_samples(const BeliefOptions& options, const Profile& profile) {
  std::vector<BeliefSample> samples;
  std::vector<TruePair> before;
  for (int s = 0; s < options.scenes; ++s) {
    ConsistencyOptions scene;
    scene.scene = kScenes[s % 3];
    scene.pairs_per_scene = options.pairs_per_scene;
    scene.max_degrees = options.max_degrees;
    scene.max_metres = options.max_metres;
    scene.width = options.width;
    const std::vector<TruePair> pairs =
        consistency_pairs(options.first_seed + static_cast<std::uint32_t>(s), scene);
    for (std::size_t k = 0; k < pairs.size(); ++k) {
      add_sample(*pairs[k].a, *pairs[k].b, pairs[k].truth, profile, samples);
      if (k < before.size()) add_sample(*pairs[k].a, *before[k].b, std::nullopt, profile, samples);
    }
    before = pairs;
  }
  return samples;
}

double BeliefModel::log_odds(const PoseEvidence& evidence) const {
  const auto terms = terms_of(evidence);
  double sum = constant;
  for (std::size_t i = 0; i < kEvidenceTerms; ++i) sum += slopes[i] * terms[i];
  return sum;
}

BeliefModel fit_belief(const std::vector<BeliefSample>& samples) {
  BeliefModel model;
  if (samples.empty()) return model;
  const Standardised x = standardise(samples);
  Eigen::VectorXd right(x.rows.rows());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    right[static_cast<Eigen::Index>(i)] = samples[i].right ? 1.0 : 0.0;
  }
  Eigen::VectorXd w = Eigen::VectorXd::Zero(kTerms + 1);
  for (int step = 0; step < kNewtonSteps; ++step) {
    const Eigen::ArrayXd p = 1.0 / (1.0 + (-(x.rows * w).array()).exp());
    Eigen::MatrixXd hessian =
        x.rows.transpose() * (p * (1.0 - p) + 1e-6).matrix().asDiagonal() * x.rows;
    hessian.diagonal().array() += kShrinkage;
    w += hessian.ldlt().solve(x.rows.transpose() * (right.array() - p).matrix() - kShrinkage * w);
  }
  model.constant = w[kTerms];
  for (int k = 0; k < kTerms; ++k) {
    const double slope = w[k] / x.deviation[k];
    model.slopes[static_cast<std::size_t>(k)] = slope;
    model.constant -= slope * x.mean[k];
  }
  return model;
}

std::array<double, kEvidenceTerms> typical_terms(const std::vector<BeliefSample>& samples) {
  std::array<double, kEvidenceTerms> typical{};
  for (std::size_t i = 0; i < kEvidenceTerms; ++i) {
    std::vector<double> values;
    for (const BeliefSample& sample : samples) {
      if (sample.right) values.push_back(terms_of(sample.evidence)[i]);
    }
    typical[i] = median(std::move(values));
  }
  return typical;
}

}  // namespace rprr
