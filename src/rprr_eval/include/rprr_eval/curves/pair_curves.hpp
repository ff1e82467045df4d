// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "rprr_eval/codec/whole_colour.hpp"
#include "rprr_eval/curves/curve.hpp"
#include "rprr_eval/measure/metrics.hpp"
#include "rprr_eval/pairs/pair_runner.hpp"
#include "rprr_eval/profile/profile.hpp"

namespace rprr {

/// b's frame at the station, at one setting of one method.
struct RatePoint {
  double setting = 0.0;   // a codec's quality or distance, or a budget in bytes; 0: the profile's
  std::size_t bytes = 0;  // all that b causes to be sent, as `rprr_eval pairs` counts it
  std::size_t bytes_depth = 0;
  std::size_t bytes_colour = 0;  // detail and base
  double psnr = 0.0, ssim = 0.0;
  std::optional<double> psnr_new;  // newly seen content; none if there is none
  DepthQuality depth;
  PredictedDepthQuality predicted_depth;
  cv::Mat bgr;
};
using RatePoints = std::vector<RatePoint>;  // in the order of their settings, few bytes first

/// What one method is good for on one pair.
struct MethodCurve {
  std::string method;  // see CurveMeasurer
  RatePoints points;
  std::optional<RatePoint> at_profile;  // as the method's profile says, if one does
};

/// One pair through every method.
struct PairCurves {
  std::string folder;
  std::size_t step = 0, a = 0, b = 0;
  bool accepted = false;          // else b's frame went out whole
  std::optional<double> overlap;  // where poses are known
  double share_new = 1.0;         // blocks of newly seen content, of all
  cv::Mat new_content;            // CV_8UC1, not 0 in these blocks
  cv::Size image;
  std::vector<MethodCurve> methods;

  const MethodCurve* find(const std::string& method) const;
};

nlohmann::json to_json(const PairCurves& pair);
/// The way back, without pictures. Errors: not what to_json writes.
Result<PairCurves> pair_curves_of(const nlohmann::json& pair);

/// A figure of every point over its bytes; points without it are left out.
Curve psnr_curve(const MethodCurve& method);
Curve ssim_curve(const MethodCurve& method);
Curve psnr_new_curve(const MethodCurve& method);

/// Times in a report as a robot's are, always the same: their digits take bytes, and a run must
/// give the bytes of the run before.
void set_usual_times(FrameReport& report);

/// Whole frames coded by themselves: depth as our profile codes it, colour by every codec over
/// its whole scale. Keeps the last frame's, since it is b in several pairs.
class WholeFrames {
 public:
  /// also: of a codec, a setting that must be among those measured.
  WholeFrames(const std::map<std::string, double>& also, DhcmMode depth_mode);

  /// Figures but psnr_new; a curve for each codec, at_profile for those of `also`. Valid until the
  /// next call. key names the frame. Errors: what a codec refuses.
  Result<const std::vector<MethodCurve>*> of(const std::string& key, const RgbdFrame& b);

 private:
  Result<MethodCurve> measure(WholeColour& codec, const RgbdFrame& b);

  std::map<std::string, double> also_;
  std::vector<std::unique_ptr<WholeColour>> codecs_;
  FrameEncoder encoder_;  // for the depth
  std::string key_;
  std::vector<MethodCurve> curves_;
};

/// Pairs of one folder and step through every method, in the order of a walk: robots keep between
/// pairs what they learn of each other. Methods:
///   view, map   our profile with that objective, over byte budgets from the least that it can do
///               to what independent coding with its codec takes at most
///   paper       its profile, over PGF's quality
///   pgf, ...    independent coding (WholeFrames)
/// The reference's frame, whose bytes are not b's, stays at its profile's quality throughout.
class CurveMeasurer {
 public:
  static Result<CurveMeasurer> create(const Profile& ours, const Profile& paper, int budgets = 16);

  Result<PairCurves> measure(const TumFolder& folder, const std::string& name, std::size_t a,
                             std::size_t b, WholeFrames& whole);

 private:
  CurveMeasurer(Profile ours, Profile paper, int budgets, PairRunner runner,
                PairRunner paper_runner);
  Result<MethodCurve> budgets_curve(const PreparedPair& pair, Objective objective, double most,
                                    const cv::Mat& new_content);
  Result<MethodCurve> paper_curve(const TumFolder& folder, std::size_t a, std::size_t b,
                                  const cv::Mat& new_content);

  Profile ours_, paper_;
  int budgets_;
  PairRunner runner_, paper_runner_;
};

}  // namespace rprr
