// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "rprr_eval/curves/pair_curves.hpp"

namespace rprr {

/// A curve counts as on another if it is no more below it than this: what interpolation makes.
constexpr double kOnCurveDecibels = 0.01;
constexpr double kOnCurveSsim = 0.0005;

/// From so much overlap on, byte ratios are also given apart.
constexpr double kMuchOverlap = 0.5;

/// Pairs held together: shares of pairs on the curve of independent coding, bytes at equal quality,
/// gains over the paper's profile, depth, figures at the profiles' settings, and for plots the
/// medians over pairs of each method's points. codec: the one of our profile. docs/quality.md goes
/// through the fields.
nlohmann::json compare_curves(const std::vector<PairCurves>& pairs, const std::string& codec);

/// What compare_curves found, for people.
std::string comparison_text(const nlohmann::json& comparison);

/// Several of them side by side, for a document.
std::string comparison_markdown(const std::vector<nlohmann::json>& comparisons);

/// One pair at equal bytes: b's own image, independent coding with that codec, the paper's profile,
/// ours with objectives view and map, each by its finest point that is within the bytes, and the
/// newly seen content. The bytes are those of paper's at its profile's quality, or the least that
/// independent coding takes, whichever is more. The pair still has its pictures.
cv::Mat curve_sheet(const PairCurves& pair, const cv::Mat& truth, const std::string& codec);

}  // namespace rprr
