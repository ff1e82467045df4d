// SPDX-License-Identifier: BSD-3-Clause
#include <nlohmann/json.hpp>

#include "rprr_eval/pair_curves.hpp"

namespace rprr {
namespace {

nlohmann::json or_null(const std::optional<double>& value) {
  return value ? nlohmann::json(*value) : nlohmann::json(nullptr);
}

nlohmann::json point_json(const RatePoint& point, double pixels) {
  const bool predicted = point.predicted_depth.pixels > 0;
  const auto if_predicted = [&](double value) {
    return predicted ? nlohmann::json(value) : nlohmann::json(nullptr);
  };
  return {{"setting", point.setting},
          {"bytes", point.bytes},
          {"bytes_depth", point.bytes_depth},
          {"bytes_colour", point.bytes_colour},
          {"bpp", 8.0 * static_cast<double>(point.bytes) / pixels},
          {"bpp_colour", 8.0 * static_cast<double>(point.bytes_colour) / pixels},
          {"psnr", point.psnr},
          {"ssim", point.ssim},
          {"psnr_new", or_null(point.psnr_new)},
          {"depth_rmse_mm", point.depth.rmse_mm},
          {"depth_coverage", point.depth.coverage},
          {"predicted_depth_pixels", point.predicted_depth.pixels},
          {"predicted_depth_rmse", if_predicted(point.predicted_depth.relative_rmse)},
          {"predicted_depth_off", if_predicted(point.predicted_depth.share_off)}};
}

}  // namespace

nlohmann::json to_json(const PairCurves& pair) {
  const double pixels = pair.image.area();
  nlohmann::json methods = nlohmann::json::object();
  for (const MethodCurve& curve : pair.methods) {
    nlohmann::json points = nlohmann::json::array();
    for (const RatePoint& point : curve.points) points.push_back(point_json(point, pixels));
    methods[curve.method] = {{"points", points}};
    if (curve.at_profile) {
      methods[curve.method]["at_profile"] = point_json(*curve.at_profile, pixels);
    }
  }
  return {{"folder", pair.folder},
          {"step", pair.step},
          {"a", pair.a},
          {"b", pair.b},
          {"accepted", pair.accepted},
          {"overlap", or_null(pair.overlap)},
          {"share_new", pair.share_new},
          {"width", pair.image.width},
          {"height", pair.image.height},
          {"methods", methods}};
}

}  // namespace rprr
