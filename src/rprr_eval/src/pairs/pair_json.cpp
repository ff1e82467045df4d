// SPDX-License-Identifier: BSD-3-Clause
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "report/verdict_json.hpp"
#include "rprr_eval/pairs/pair_runner.hpp"

namespace rprr {
namespace {

nlohmann::json or_null(const std::optional<double>& value) {
  return value ? nlohmann::json(*value) : nlohmann::json(nullptr);
}

// Why the pair has no pose, in words; empty if it has one.
std::string reason_of(const std::optional<RelativePoseMessage>& pose) {
  if (!pose) return "no answer";
  return pose->verdict.accepted() ? "" : describe(pose->verdict);
}

nlohmann::json pose_json(const PairResult& result) {
  const auto& pose = result.exchange.pose;
  std::optional<double> metres;
  std::optional<double> degrees;
  if (result.pose_error) {
    metres = result.pose_error->metres;
    degrees = result.pose_error->degrees;
  }
  return {{"accepted", pose && pose->verdict.accepted()},
          {"reason", reason_of(pose)},
          {"verdict", to_json(pose ? pose->verdict : PoseVerdict())},
          {"iterations", pose ? pose->iterations : 0},
          {"err_m", or_null(metres)},
          {"err_deg", or_null(degrees)},
          {"bytes", result.exchange.bytes},
          {"messages", result.exchange.messages}};
}

nlohmann::json quality_json(const PairResult& result) {
  return {{"psnr", result.psnr},
          {"psnr_predicted", or_null(result.psnr_predicted)},
          {"share_predicted", result.rebuilt.share_predicted},
          {"ssim", result.ssim},
          {"depth_rmse_mm", result.depth.rmse_mm},
          {"depth_coverage", result.depth.coverage},
          {"depth_exact", result.depth_exact},
          {"independent_psnr", result.independent_psnr},
          {"independent_ssim", result.independent_ssim}};
}

}  // namespace

nlohmann::json to_json(const PairResult& result) {
  const RebuiltFrame& rebuilt = result.rebuilt;
  return {{"a", result.a},
          {"b", result.b},
          {"pose", pose_json(result)},
          {"overlap", or_null(result.overlap)},
          {"blocks",
           {{"total", rebuilt.blocks_total},
            {"p", result.blocks_predicted},
            {"v", result.blocks_validated},
            {"sent", rebuilt.blocks_sent},
            {"sent_without_depth", rebuilt.blocks_sent_without_depth},
            {"colour_only", rebuilt.blocks_colour_only}}},
          {"bytes",
           {{"pose", rebuilt.report.bytes_pose},
            {"masks", rebuilt.bytes_masks},
            {"depth", rebuilt.sizes.depth},
            {"colour", rebuilt.sizes.colour + rebuilt.sizes.base},
            {"base", rebuilt.sizes.base},
            {"extras", rebuilt.bytes_extras},
            {"total", rebuilt.bytes_total}}},
          {"independent_bytes",
           {{"depth", result.independent.depth},
            {"colour", result.independent.colour},
            {"total", result.independent.total}}},
          {"quality", quality_json(result)},
          {"ms",
           {{"pose", result.exchange.seconds_compute * 1e3},
            {"predict", result.ms_predict},
            {"validate", result.ms_validate},
            {"encode", rebuilt.report.ms_encode},
            {"decode", rebuilt.ms_decode},
            {"reconstruct", rebuilt.ms_reconstruct}}}};
}

}  // namespace rprr
