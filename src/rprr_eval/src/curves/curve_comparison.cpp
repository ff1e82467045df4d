// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_eval/curves/curve_comparison.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "curves/curve_medians.hpp"
#include "rprr_eval/measure/median.hpp"

namespace rprr {
namespace {

using nlohmann::json;
using Pairs = PairPointers;
using CurveOf = Curve (*)(const MethodCurve&);

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::array<double, 5> kLevels = {28.0, 30.0, 32.0, 34.0, 36.0};  // dB
const std::vector<std::string> kIndependent = {"webp", "jpeg", "pgf", "jxl"};

json number_or_null(double value) {
  return std::isfinite(value) ? json(value) : json(nullptr);
}

json name_of(const PairCurves& pair) {
  return {{"folder", pair.folder}, {"step", pair.step}, {"a", pair.a}, {"b", pair.b}};
}

// What another method has over the codec's whole frames at equal bytes of colour, depth and all
// else aside: what the layers bring, and what the codecs are like.
json at_colour_bytes(const Pairs& pairs, const std::string& method, const std::string& codec) {
  json result = json::array();
  const MethodCurve* first = pairs.empty() ? nullptr : pairs.front()->find(codec);
  for (std::size_t i = 0; first != nullptr && i < first->points.size(); ++i) {
    std::vector<double> psnr_gains, ssim_gains;
    for (const PairCurves* pair : pairs) {
      const MethodCurve* own = pair->find(method);
      if (own == nullptr) continue;
      std::vector<CurvePoint> psnr, ssim;
      for (const RatePoint& point : own->points) {
        psnr.push_back({static_cast<double>(point.bytes_colour), point.psnr});
        ssim.push_back({static_cast<double>(point.bytes_colour), point.ssim});
      }
      const RatePoint& rival = pair->find(codec)->points[i];
      const auto bytes = static_cast<double>(rival.bytes_colour);
      const auto own_psnr = Curve(psnr).at(bytes);
      const auto own_ssim = Curve(ssim).at(bytes);
      psnr_gains.push_back(own_psnr ? *own_psnr - rival.psnr : -kInfinity);
      ssim_gains.push_back(own_ssim ? *own_ssim - rival.ssim : -kInfinity);
    }
    result.push_back({{"setting", first->points[i].setting},
                      {"psnr_gain", median_or_null(psnr_gains)},
                      {"ssim_gain", median_or_null(ssim_gains)}});
  }
  return result;
}

struct Shortfalls {
  std::vector<double> psnr, ssim;
  json short_pairs = json::array();
  std::size_t on_psnr = 0, on_ssim = 0, on_both = 0;
};

void add_shortfall(const PairCurves& pair, const MethodCurve& ours, const MethodCurve& rival,
                   Shortfalls& all) {
  const Shortfall psnr_shortfall = worst_shortfall(psnr_curve(ours), psnr_curve(rival));
  const Shortfall ssim_shortfall = worst_shortfall(ssim_curve(ours), ssim_curve(rival));
  const double psnr = psnr_shortfall.value;
  const double ssim = ssim_shortfall.value;
  const bool on_psnr = psnr <= kOnCurveDecibels;
  const bool on_ssim = ssim <= kOnCurveSsim;
  all.psnr.push_back(psnr);
  all.ssim.push_back(ssim);
  all.on_psnr += on_psnr ? 1 : 0;
  all.on_ssim += on_ssim ? 1 : 0;
  all.on_both += on_psnr && on_ssim ? 1 : 0;
  if (on_psnr && on_ssim) return;
  json entry = name_of(pair);
  entry["accepted"] = pair.accepted;
  entry["psnr"] = number_or_null(psnr);
  entry["psnr_at_bytes"] = psnr_shortfall.bytes;
  entry["ssim"] = number_or_null(ssim);
  entry["ssim_at_bytes"] = ssim_shortfall.bytes;
  all.short_pairs.push_back(entry);
}

// Compares at the bytes of each point of the rival's curve. Every pair has as many points.
json on_points(const Pairs& pairs, const std::string& codec) {
  json result = json::array();
  const MethodCurve* first = pairs.empty() ? nullptr : pairs.front()->find(codec);
  for (std::size_t i = 0; first != nullptr && i < first->points.size(); ++i) {
    std::vector<double> psnr_gains, ssim_gains;
    for (const PairCurves* pair : pairs) {
      const RatePoint& rival = pair->find(codec)->points[i];
      const MethodCurve& ours = *pair->find("view");
      const auto bytes = static_cast<double>(rival.bytes);
      const auto gain = [&](const Curve& curve, double value) {
        const auto own = curve.at(bytes);
        return own ? *own - value : -kInfinity;
      };
      psnr_gains.push_back(gain(psnr_curve(ours), rival.psnr));
      ssim_gains.push_back(gain(ssim_curve(ours), rival.ssim));
    }
    const auto share = [](const std::vector<double>& gains, double tolerance) {
      const auto on = [&](double value) { return value >= -tolerance; };
      return share_of(static_cast<std::size_t>(std::count_if(gains.begin(), gains.end(), on)),
                      gains.size());
    };
    result.push_back({{"setting", first->points[i].setting},
                      {"share_psnr", share(psnr_gains, kOnCurveDecibels)},
                      {"share_ssim", share(ssim_gains, kOnCurveSsim)},
                      {"median_psnr_gain", median_or_null(psnr_gains)},
                      {"median_ssim_gain", median_or_null(ssim_gains)}});
  }
  return result;
}

// `view` against whole frames through the same codec, at every byte count of the whole frames.
json on_curve(const Pairs& pairs, const std::string& codec) {
  Shortfalls all;
  for (const PairCurves* pair : pairs) {
    const MethodCurve* ours = pair->find("view");
    const MethodCurve* rival = pair->find(codec);
    if (ours != nullptr && rival != nullptr) add_shortfall(*pair, *ours, *rival, all);
  }
  const std::size_t count = all.psnr.size();
  const auto worst_finite = [](const std::vector<double>& values) {
    double worst = -kInfinity;
    for (const double value : values) {
      if (std::isfinite(value)) worst = std::max(worst, value);
    }
    return number_or_null(worst);
  };
  const auto begin_late = std::count(all.psnr.begin(), all.psnr.end(), kInfinity);
  return {{"codec", codec},
          {"pairs", count},
          {"share_psnr", share_of(all.on_psnr, count)},
          {"share_ssim", share_of(all.on_ssim, count)},
          {"share_both", share_of(all.on_both, count)},
          {"begin_late", begin_late},
          {"worst_psnr", worst_finite(all.psnr)},
          {"worst_ssim", worst_finite(all.ssim)},
          {"median_psnr", median_or_null(all.psnr)},
          {"median_ssim", median_or_null(all.ssim)},
          {"points", on_points(pairs, codec)},
          {"short", all.short_pairs}};
}

// Bytes of one method over a rival's at equal quality, over pairs.
json byte_ratios(const Pairs& pairs, const std::string& method, const std::string& rival,
                 CurveOf curve_of) {
  std::vector<double> in_common;
  std::vector<double> at_least;
  std::array<std::vector<double>, kLevels.size()> at_level;
  for (const PairCurves* pair : pairs) {
    const MethodCurve* own = pair->find(method);
    const MethodCurve* other = pair->find(rival);
    if (own == nullptr || other == nullptr) continue;
    const Curve own_curve = curve_of(*own);
    const Curve other_curve = curve_of(*other);
    if (own_curve.empty() || other_curve.empty()) continue;
    const auto ratio = [&](double value) {
      const auto bytes = own_curve.bytes_for(value);
      return bytes ? *bytes / *other_curve.bytes_for(value) : kInfinity;
    };
    const auto common = median_byte_ratio(own_curve, other_curve);
    if (common) in_common.push_back(*common);
    at_least.push_back(ratio(other_curve.least_value()));
    for (std::size_t i = 0; i < kLevels.size(); ++i) {
      const bool reached =
          other_curve.least_value() <= kLevels[i] && kLevels[i] <= other_curve.greatest_value();
      if (reached) at_level[i].push_back(ratio(kLevels[i]));
    }
  }
  json levels = {{"least", {{"pairs", at_least.size()}, {"ratio", median_or_null(at_least)}}}};
  for (std::size_t i = 0; i < kLevels.size(); ++i) {
    levels[std::to_string(std::lround(kLevels[i]))] = {{"pairs", at_level[i].size()},
                                                       {"ratio", median_or_null(at_level[i])}};
  }
  return {{"pairs", in_common.size()}, {"in_common", median_or_null(in_common)}, {"at", levels}};
}

json equal_quality(const Pairs& pairs) {
  json result = json::object();
  for (const std::string& rival : kIndependent) {
    if (pairs.empty() || pairs.front()->find(rival) == nullptr) continue;
    result["view"][rival] = byte_ratios(pairs, "view", rival, psnr_curve);
    result["map"][rival] = byte_ratios(pairs, "map", rival, psnr_new_curve);
  }
  return result;
}

// `view` at the bytes of one point of the paper's curve.
json against_paper(const Pairs& pairs, std::size_t index) {
  std::vector<double> gains, ssim_gains;
  std::size_t higher_ssim = 0, out_of_reach = 0;
  double setting = 0.0;
  json lower = json::array();
  for (const PairCurves* pair : pairs) {
    const RatePoint& paper = pair->find("paper")->points[index];
    setting = paper.setting;
    const MethodCurve& ours = *pair->find("view");
    const auto psnr = psnr_curve(ours).at(static_cast<double>(paper.bytes));
    const auto ssim = ssim_curve(ours).at(static_cast<double>(paper.bytes));
    if (!psnr || !ssim) ++out_of_reach;
    gains.push_back(psnr ? *psnr - paper.psnr : -kInfinity);
    ssim_gains.push_back(ssim ? *ssim - paper.ssim : -kInfinity);
    if (ssim_gains.back() > 0.0) {
      ++higher_ssim;
    } else {
      lower.push_back(name_of(*pair));
      lower.back()["psnr_gain"] = number_or_null(gains.back());
      lower.back()["ssim_gain"] = number_or_null(ssim_gains.back());
    }
  }
  const auto least = [](const std::vector<double>& values) {
    double found = kInfinity;
    for (const double value : values) {
      if (std::isfinite(value)) found = std::min(found, value);
    }
    return number_or_null(found);
  };
  return {{"quality", setting},
          {"pairs", gains.size()},
          {"median_gain", median_or_null(gains)},
          {"least_gain", least(gains)},
          {"share_ssim_higher", share_of(higher_ssim, gains.size())},
          {"median_ssim_gain", median_or_null(ssim_gains)},
          {"least_ssim_gain", least(ssim_gains)},
          {"out_of_reach", out_of_reach},
          {"ssim_not_higher", lower}};
}

json against_paper(const Pairs& pairs) {
  json result = json::array();
  if (pairs.empty() || pairs.front()->find("paper") == nullptr) return result;
  const MethodCurve& first = *pairs.front()->find("paper");
  for (std::size_t i = 0; i < first.points.size(); ++i) {
    json entry = against_paper(pairs, i);
    entry["of_profile"] = first.at_profile && first.at_profile->setting == first.points[i].setting;
    result.push_back(entry);
  }
  return result;
}

}  // namespace

json compare_curves(const std::vector<PairCurves>& all, const std::string& codec) {
  Pairs pairs, much_overlap;
  std::size_t accepted = 0;
  for (const PairCurves& pair : all) {
    pairs.push_back(&pair);
    accepted += pair.accepted ? 1 : 0;
    if (pair.overlap && *pair.overlap >= kMuchOverlap) much_overlap.push_back(&pair);
  }
  json colour = json::object();
  for (const char* method : {"view", "pgf", "jpeg", "jxl", "webp"}) {
    if (codec != method) colour[method] = at_colour_bytes(pairs, method, codec);
  }
  const double pixels = all.empty() ? 1.0 : all.front().image.area();
  return {{"pairs", pairs.size()},
          {"accepted", accepted},
          {"pairs_overlap_half", much_overlap.size()},
          {"on_curve", on_curve(pairs, codec)},
          {"equal_quality", equal_quality(pairs)},
          {"equal_quality_overlap_half", equal_quality(much_overlap)},
          {"at_colour_bytes", colour},
          {"against_paper", against_paper(pairs)},
          {"depth", depth_over_pairs(pairs)},
          {"at_profile", medians_at_profile(pairs)},
          {"curves", median_curves(pairs, pixels)}};
}

}  // namespace rprr
