// SPDX-License-Identifier: BSD-3-Clause
#include <nlohmann/json.hpp>

#include "rprr_eval/curves/pair_curves.hpp"

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

std::optional<double> number_of(const nlohmann::json& value) {
  return value.is_null() ? std::nullopt : std::optional(value.get<double>());
}

RatePoint point_of(const nlohmann::json& json) {
  RatePoint point;
  json.at("setting").get_to(point.setting);
  json.at("bytes").get_to(point.bytes);
  json.at("bytes_depth").get_to(point.bytes_depth);
  json.at("bytes_colour").get_to(point.bytes_colour);
  json.at("psnr").get_to(point.psnr);
  json.at("ssim").get_to(point.ssim);
  point.psnr_new = number_of(json.at("psnr_new"));
  json.at("depth_rmse_mm").get_to(point.depth.rmse_mm);
  json.at("depth_coverage").get_to(point.depth.coverage);
  PredictedDepthQuality& predicted = point.predicted_depth;
  json.at("predicted_depth_pixels").get_to(predicted.pixels);
  predicted.relative_rmse = number_of(json.at("predicted_depth_rmse")).value_or(0.0);
  predicted.share_off = number_of(json.at("predicted_depth_off")).value_or(0.0);
  return point;
}

MethodCurve method_of(const std::string& name, const nlohmann::json& json) {
  MethodCurve curve{name, {}, {}};
  for (const nlohmann::json& point : json.at("points")) curve.points.push_back(point_of(point));
  if (json.contains("at_profile")) curve.at_profile = point_of(json["at_profile"]);
  return curve;
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

Result<PairCurves> pair_curves_of(const nlohmann::json& json) {
  PairCurves pair;
  try {
    json.at("folder").get_to(pair.folder);
    json.at("step").get_to(pair.step);
    json.at("a").get_to(pair.a);
    json.at("b").get_to(pair.b);
    json.at("accepted").get_to(pair.accepted);
    pair.overlap = number_of(json.at("overlap"));
    json.at("share_new").get_to(pair.share_new);
    pair.image = {json.at("width").get<int>(), json.at("height").get<int>()};
    for (const auto& [name, method] : json.at("methods").items()) {
      pair.methods.push_back(method_of(name, method));
    }
  } catch (const nlohmann::json::exception& error) {
    return Error{std::string("not a pair's curves: ") + error.what()};
  }
  return pair;
}

}  // namespace rprr
