// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_eval/curves/pair_curves.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <opencv2/core.hpp>

namespace rprr {
namespace {

constexpr std::array<int, 7> kPaperQualities = {12, 10, 8, 7, 6, 5, 4};  // of PGF, coarsest first
constexpr double kLeastRange = 60e3;  // [bytes] budgets go so far at least

using Figure = std::function<std::optional<double>(const RatePoint&)>;

Curve curve_of(const MethodCurve& method, const Figure& figure) {
  std::vector<CurvePoint> points;
  for (const RatePoint& point : method.points) {
    const std::optional<double> value = figure(point);
    if (value) points.push_back({static_cast<double>(point.bytes), *value});
  }
  return Curve(std::move(points));
}

// b's frame with an encoder, at the station, and what it is like there.
Result<RatePoint> rebuilt_point(PairRunner& runner, const PreparedPair& pair,
                                const EncodedFrame& encoded, double setting,
                                const cv::Mat& new_content) {
  const Result<RebuiltFrame> rebuilt = runner.rebuild(pair, encoded);
  if (!rebuilt) return Error{rebuilt.reason()};
  RatePoint point;
  point.setting = setting;
  point.bytes = rebuilt->bytes_total;
  point.bytes_depth = rebuilt->sizes.depth;
  point.bytes_colour = rebuilt->sizes.colour + rebuilt->sizes.base;
  point.bgr = rebuilt->bgr;
  point.psnr = *psnr(rebuilt->bgr, pair.b->bgr);
  point.ssim = ssim(rebuilt->bgr, pair.b->bgr);
  point.psnr_new = psnr(rebuilt->bgr, pair.b->bgr, new_content);
  point.depth = depth_quality(rebuilt->depth, pair.b->depth);
  point.predicted_depth =
      predicted_depth_quality(rebuilt->depth, pair.b->depth, rebuilt->received_depth);
  return point;
}

// The encoder chose the same layers.
bool same_payloads(const EncodedFrame& one, const EncodedFrame& other) {
  return one.depth == other.depth && one.colour == other.colour && one.base == other.base;
}

// The blocks that the profile's decision asks b to send.
cv::Mat new_content_of(const PreparedPair& pair) {
  return pair.outgoing.sparse ? pair.outgoing.mask.to_image()
                              : cv::Mat(pair.b->bgr.size(), CV_8UC1, cv::Scalar(255));
}

}  // namespace

void set_usual_times(FrameReport& report) {
  for (float* time :
       {&report.ms_pose, &report.ms_predict, &report.ms_validate, &report.ms_encode}) {
    if (*time > 0.0f) *time = 5.0f;
  }
}

const MethodCurve* PairCurves::find(const std::string& method) const {
  const auto found = std::find_if(methods.begin(), methods.end(),
                                  [&](const MethodCurve& curve) { return curve.method == method; });
  return found == methods.end() ? nullptr : &*found;
}

Curve psnr_curve(const MethodCurve& method) {
  return curve_of(method, [](const RatePoint& point) { return point.psnr; });
}
Curve ssim_curve(const MethodCurve& method) {
  return curve_of(method, [](const RatePoint& point) { return point.ssim; });
}
Curve psnr_new_curve(const MethodCurve& method) {
  return curve_of(method, [](const RatePoint& point) { return point.psnr_new; });
}

CurveMeasurer::CurveMeasurer(Profile ours, Profile paper, int budgets, PairRunner runner,
                             PairRunner paper_runner)
    : ours_(std::move(ours)),
      paper_(std::move(paper)),
      budgets_(budgets),
      runner_(std::move(runner)),
      paper_runner_(std::move(paper_runner)) {
}

Result<CurveMeasurer> CurveMeasurer::create(const Profile& ours, const Profile& paper,
                                            int budgets) {
  Result<PairRunner> runner = PairRunner::create(ours);
  if (!runner) return Error{runner.reason()};
  Result<PairRunner> paper_runner = PairRunner::create(paper);
  if (!paper_runner) return Error{paper_runner.reason()};
  return CurveMeasurer(ours, paper, std::max(budgets, 2), std::move(*runner),
                       std::move(*paper_runner));
}

Result<PairCurves> CurveMeasurer::measure(const TumFolder& folder, const std::string& name,
                                          std::size_t a, std::size_t b, WholeFrames& whole) {
  const Result<PreparedPair> pair = runner_.prepare(folder, a, b);
  if (!pair) return Error{pair.reason()};
  PairCurves curves;
  curves.folder = name;
  curves.step = b - a;
  curves.a = a;
  curves.b = b;
  curves.accepted = pair->outgoing.sparse;
  curves.overlap = pair->result.overlap;
  curves.image = pair->b->bgr.size();
  curves.new_content = new_content_of(*pair);
  curves.share_new = static_cast<double>(cv::countNonZero(curves.new_content)) /
                     static_cast<double>(curves.new_content.total());

  const auto independent = whole.of(name + "/" + std::to_string(b), *pair->b);
  if (!independent) return Error{independent.reason()};
  double most = kLeastRange;
  for (const MethodCurve& codec : **independent) {
    if (codec.method != ours_.codec.colour_codec) continue;
    most = std::max(most, static_cast<double>(codec.points.back().bytes));
  }
  for (const Objective objective : {Objective::kView, Objective::kMap}) {
    Result<MethodCurve> curve = budgets_curve(*pair, objective, most, curves.new_content);
    if (!curve) return Error{curve.reason()};
    curves.methods.push_back(std::move(*curve));
  }
  Result<MethodCurve> paper = paper_curve(folder, a, b, curves.new_content);
  if (!paper) return Error{paper.reason()};
  curves.methods.push_back(std::move(*paper));
  for (MethodCurve codec : **independent) {
    const auto judge_new = [&](RatePoint& point) {
      point.psnr_new = psnr(point.bgr, pair->b->bgr, curves.new_content);
    };
    for (RatePoint& point : codec.points) judge_new(point);
    if (codec.at_profile) judge_new(*codec.at_profile);
    curves.methods.push_back(std::move(codec));
  }
  return curves;
}

Result<MethodCurve> CurveMeasurer::budgets_curve(const PreparedPair& pair, Objective objective,
                                                 double most, const cv::Mat& new_content) {
  MethodCurve curve{objective == Objective::kView ? "view" : "map", {}, {}};
  FrameCodecOptions options = ours_.codec;
  options.objective = objective;
  EncodedFrame before;
  const auto point_for = [&](const SparseColours& colours) -> Result<RatePoint> {
    const double budget = colours.by == SparseColours::By::kBytes ? colours.amount : 0.0;
    options.sparse_colours = colours;
    Result<FrameEncoder> encoder = FrameEncoder::create(options);
    if (!encoder) return Error{encoder.reason()};
    Result<EncodedFrame> encoded = PairRunner::encode(pair, *encoder);
    if (!encoded) return Error{encoded.reason()};
    set_usual_times(encoded->report);
    if (!curve.points.empty() && same_payloads(*encoded, before)) {
      RatePoint point = curve.points.back();
      point.setting = budget;
      return point;
    }
    before = std::move(*encoded);
    return rebuilt_point(runner_, pair, before, budget, new_content);
  };
  const auto point_at = [&](double budget) {
    return point_for({SparseColours::By::kBytes, budget});
  };

  Result<RatePoint> point = point_for(ours_.codec.sparse_colours);
  if (!point) return Error{point.reason()};
  curve.at_profile = *point;
  point = point_at(1.0);
  if (!point) return Error{point.reason()};
  // Budgets count the container; what goes around it is the same for all.
  const auto least = static_cast<double>(point->bytes);
  const double around = least - static_cast<double>(serialise(before).size());
  // Most of the least is depth: spread what goes beyond half of it, or the first steps in colour
  // would be lost.
  const double base = 0.5 * least;
  const double range = std::max((most - base) / (least - base), 1.0);
  curve.points.push_back(std::move(*point));
  for (int i = 1; i < budgets_; ++i) {
    const double total = base + (least - base) * std::pow(range, i / (budgets_ - 1.0));
    point = point_at(std::max(1.0, std::round(total - around)));
    if (!point) return Error{point.reason()};
    curve.points.push_back(std::move(*point));
  }
  return curve;
}

Result<MethodCurve> CurveMeasurer::paper_curve(const TumFolder& folder, std::size_t a,
                                               std::size_t b, const cv::Mat& new_content) {
  const Result<PreparedPair> pair = paper_runner_.prepare(folder, a, b);
  if (!pair) return Error{pair.reason()};
  MethodCurve curve{"paper", {}, {}};
  FrameCodecOptions options = paper_.codec;
  std::vector<int> qualities(kPaperQualities.begin(), kPaperQualities.end());
  const int usual = paper_.codec.colour_quality;
  if (std::find(qualities.begin(), qualities.end(), usual) == qualities.end()) {
    qualities.push_back(usual);
  }
  for (const int quality : qualities) {
    options.colour_quality = quality;
    Result<FrameEncoder> encoder = FrameEncoder::create(options);
    if (!encoder) return Error{encoder.reason()};
    Result<EncodedFrame> encoded = PairRunner::encode(*pair, *encoder);
    if (!encoded) return Error{encoded.reason()};
    set_usual_times(encoded->report);
    Result<RatePoint> point = rebuilt_point(paper_runner_, *pair, *encoded, quality, new_content);
    if (!point) return Error{point.reason()};
    if (quality == usual) curve.at_profile = *point;
    curve.points.push_back(std::move(*point));
  }
  return curve;
}

}  // namespace rprr
