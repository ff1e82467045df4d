// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_eval/curves/curve_comparison.hpp"
#include "rprr_eval/report/text_table.hpp"

namespace rprr {
namespace {

using nlohmann::json;

std::string cell(const json& value, int digits, double scale = 1.0) {
  return value.is_number() ? fixed(scale * value.get<double>(), digits) : "-";
}
std::string percent(const json& value, int digits = 0) {
  return value.is_number() ? cell(value, digits, 100.0) + "%" : "-";
}
std::string count(const json& value) {
  return cell(value, 0);
}

std::string points_text(const json& points) {
  TextTable table({"at its quality", "PSNR gain", "pairs on it", "SSIM gain", "pairs on it"});
  for (const json& point : points) {
    table.add({count(point["setting"]), cell(point["median_psnr_gain"], 2) + " dB",
               percent(point["share_psnr"]), cell(point["median_ssim_gain"], 4),
               percent(point["share_ssim"])});
  }
  return table.text();
}

std::string on_curve_text(const json& found) {
  return "`view` at least on the curve of independent " + found["codec"].get<std::string>() +
         " from its least to its most bytes: PSNR " + percent(found["share_psnr"]) + ", SSIM " +
         percent(found["share_ssim"]) + ", both " + percent(found["share_both"]) + " of " +
         count(found["pairs"]) + " pairs\n  worst shortfall " + cell(found["worst_psnr"], 2) +
         " dB, SSIM " + cell(found["worst_ssim"], 4) + "; " + count(found["begin_late"]) +
         " pairs whose smallest view has more bytes than the smallest independent frame\n" +
         points_text(found["points"]);
}

std::string ratio_text(const std::string& title, const json& methods, const json& pairs) {
  TextTable table({title, "in common", "least", "28", "30", "32", "34", "36 dB"});
  for (const auto& [method, rivals] : methods.items()) {
    for (const auto& [rival, found] : rivals.items()) {
      std::vector<std::string> row = {method + " / " + rival, cell(found["in_common"], 3)};
      for (const char* level : {"least", "28", "30", "32", "34", "36"}) {
        row.push_back(cell(found["at"][level]["ratio"], 3));
      }
      table.add(row);
    }
  }
  return "\nbytes over independent's at equal PSNR (view: whole frame; map: newly seen content), " +
         count(pairs) + " pairs\n" + table.text();
}

std::string paper_text(const json& points) {
  TextTable table({"at the bytes of paper at PGF quality", "median gain", "least gain",
                   "SSIM higher", "least SSIM gain", "out of reach"});
  for (const json& point : points) {
    table.add({count(point["quality"]) + (point["of_profile"].get<bool>() ? " (profile)" : ""),
               cell(point["median_gain"], 2) + " dB", cell(point["least_gain"], 2) + " dB",
               percent(point["share_ssim_higher"], 1), cell(point["least_ssim_gain"], 4),
               count(point["out_of_reach"])});
  }
  return "\n" + table.text();
}

std::string depth_text(const json& methods) {
  TextTable table({"predicted depth", "pairs", "RMSE", "90% of pairs", "under 1.5%", "off by > 5%",
                   "90% of pairs", "under 1%"});
  for (const auto& [method, found] : methods.items()) {
    table.add({method, count(found["pairs"]), percent(found["median_rmse"], 2),
               percent(found["rmse_of_90_percent"], 2),
               percent(found["share_rmse_under_1.5_percent"], 0), percent(found["median_off"], 2),
               percent(found["off_of_90_percent"], 2),
               percent(found["share_off_under_1_percent"], 0)});
  }
  return "\n" + table.text();
}

std::string profile_text(const json& methods) {
  TextTable table(
      {"as the profile says", "bytes", "depth", "colour", "PSNR", "SSIM", "PSNR new", "coverage"});
  for (const auto& [method, found] : methods.items()) {
    table.add({method, count(found["bytes"]), count(found["bytes_depth"]),
               count(found["bytes_colour"]), cell(found["psnr"], 2), cell(found["ssim"], 3),
               cell(found["psnr_new"], 2), cell(found["depth_coverage"], 3)});
  }
  return "\n" + table.text();
}

}  // namespace

std::string comparison_text(const json& comparison) {
  return count(comparison["pairs"]) + " pairs, " + count(comparison["accepted"]) +
         " poses accepted; medians over pairs\n" + on_curve_text(comparison["on_curve"]) +
         ratio_text("overlap 0.5 and more", comparison["equal_quality_overlap_half"],
                    comparison["pairs_overlap_half"]) +
         ratio_text("all pairs", comparison["equal_quality"], comparison["pairs"]) +
         paper_text(comparison["against_paper"]) + depth_text(comparison["depth"]) +
         profile_text(comparison["at_profile"]);
}

}  // namespace rprr
