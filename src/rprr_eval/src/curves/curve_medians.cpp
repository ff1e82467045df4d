// SPDX-License-Identifier: BSD-3-Clause
#include "curves/curve_medians.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "rprr_eval/measure/median.hpp"

namespace rprr {
namespace {

using nlohmann::json;
using Pairs = PairPointers;

using Figure = std::function<std::optional<double>(const RatePoint&)>;

const std::vector<std::pair<std::string, Figure>>& figures() {
  static const std::vector<std::pair<std::string, Figure>> kFigures = {
      {"setting", [](const RatePoint& p) { return p.setting; }},
      {"bytes", [](const RatePoint& p) { return static_cast<double>(p.bytes); }},
      {"bytes_depth", [](const RatePoint& p) { return static_cast<double>(p.bytes_depth); }},
      {"bytes_colour", [](const RatePoint& p) { return static_cast<double>(p.bytes_colour); }},
      {"psnr", [](const RatePoint& p) { return p.psnr; }},
      {"ssim", [](const RatePoint& p) { return p.ssim; }},
      {"psnr_new", [](const RatePoint& p) { return p.psnr_new; }},
      {"depth_coverage", [](const RatePoint& p) { return p.depth.coverage; }},
      {"predicted_depth_rmse",
       [](const RatePoint& p) {
         return p.predicted_depth.pixels > 0 ? std::optional(p.predicted_depth.relative_rmse)
                                             : std::nullopt;
       }},
      {"predicted_depth_off",
       [](const RatePoint& p) {
         return p.predicted_depth.pixels > 0 ? std::optional(p.predicted_depth.share_off)
                                             : std::nullopt;
       }},
  };
  return kFigures;
}

// Medians over pairs of every figure of one point; pick may give none.
json medians(const Pairs& pairs, const std::function<const RatePoint*(const PairCurves&)>& pick) {
  json result = json::object();
  for (const auto& [name, figure] : figures()) {
    std::vector<double> values;
    for (const PairCurves* pair : pairs) {
      const RatePoint* point = pick(*pair);
      const auto value = point == nullptr ? std::nullopt : figure(*point);
      if (value) values.push_back(*value);
    }
    result[name] = median_or_null(values);
  }
  return result;
}

}  // namespace

json median_or_null(const std::vector<double>& values) {
  const double middle = median(values);
  return values.empty() || !std::isfinite(middle) ? json(nullptr) : json(middle);
}

double share_of(std::size_t count, std::size_t all) {
  return all == 0 ? 0.0 : static_cast<double>(count) / static_cast<double>(all);
}

json medians_at_profile(const Pairs& pairs) {
  json result = json::object();
  if (pairs.empty()) return result;
  for (const MethodCurve& method : pairs.front()->methods) {
    if (!method.at_profile) continue;
    result[method.method] = medians(pairs, [&](const PairCurves& pair) {
      const MethodCurve* found = pair.find(method.method);
      return found != nullptr && found->at_profile ? &*found->at_profile : nullptr;
    });
  }
  return result;
}

// Points at the same place in every pair's list have the same quality, or budgets spread alike.
json median_curves(const Pairs& pairs, double pixels) {
  json result = json::object();
  if (pairs.empty()) return result;
  for (const MethodCurve& method : pairs.front()->methods) {
    result[method.method] = json::array();
    for (std::size_t i = 0; i < method.points.size(); ++i) {
      json point = medians(pairs, [&](const PairCurves& pair) {
        const MethodCurve* found = pair.find(method.method);
        return found != nullptr && i < found->points.size() ? &found->points[i] : nullptr;
      });
      for (const char* kind : {"bytes", "bytes_colour"}) {
        point[kind == std::string("bytes") ? "bpp" : "bpp_colour"] =
            8.0 * point[kind].get<double>() / pixels;
      }
      result[method.method].push_back(point);
    }
  }
  return result;
}

// At the profiles' settings: depth does not depend on what the colour takes.
json depth_over_pairs(const Pairs& pairs) {
  json result = json::object();
  for (const char* method : {"view", "paper"}) {
    std::vector<double> rmse, off;
    for (const PairCurves* pair : pairs) {
      const MethodCurve* found = pair->find(method);
      if (found == nullptr || !found->at_profile) continue;
      const PredictedDepthQuality& depth = found->at_profile->predicted_depth;
      if (depth.pixels == 0) continue;
      rmse.push_back(depth.relative_rmse);
      off.push_back(depth.share_off);
    }
    const auto under = [](const std::vector<double>& values, double limit) {
      const auto below = [&](double value) { return value < limit; };
      return share_of(static_cast<std::size_t>(std::count_if(values.begin(), values.end(), below)),
                      values.size());
    };
    result[method] = {{"pairs", rmse.size()},
                      {"median_rmse", median_or_null(rmse)},
                      {"rmse_of_90_percent", percentile(rmse, 0.9)},
                      {"share_rmse_under_1.5_percent", under(rmse, 0.015)},
                      {"median_off", median_or_null(off)},
                      {"off_of_90_percent", percentile(off, 0.9)},
                      {"share_off_under_1_percent", under(off, 0.01)}};
  }
  return result;
}

}  // namespace rprr
