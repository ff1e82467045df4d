// SPDX-License-Identifier: BSD-3-Clause
#include "codec_options.hpp"

#include <algorithm>
#include <optional>
#include <string>

namespace rprr {
namespace {

std::string wrong_bandwidth(double bandwidth) {
  if (bandwidth == 0.0 || bandwidth >= kLeastBandwidth) return {};
  return "~bandwidth must be 0 (no limit) or at least " +
         std::to_string(static_cast<int>(kLeastBandwidth)) + " bytes a second";
}

}  // namespace

Result<FrameCodecOptions> read_codec_options(const Parameters& given) {
  FrameCodecOptions options;
  options.colour_codec = given.param("colour_codec", options.colour_codec);
  options.colour_quality = given.param("colour_quality", options.colour_quality);
  options.view_quality = given.param("view_quality", options.view_quality);
  options.base_codec = given.param("base_codec", options.base_codec);
  options.base_reduction = given.param("base_reduction", options.base_reduction);
  options.base_quality = given.param("base_quality", options.base_quality);
  options.measure_independent = given.param("measure_independent", options.measure_independent);
  options.target_psnr = given.param("target_psnr", options.target_psnr);

  options.depth_step = given.param("depth_step", options.depth_step);

  const Result<DhcmMode> mode = dhcm_mode_from_name(
      given.param<std::string>("depth_mode", dhcm_mode_name(options.depth_mode)));
  if (!mode) return Error{"~depth_mode: " + mode.reason()};
  options.depth_mode = *mode;
  const auto named = given.param<std::string>("objective", "fixed");
  const std::optional<Objective> objective = objective_of(named);
  if (!objective) return Error{"~objective is '" + named + "', must be fixed, map or view"};
  options.objective = *objective;
  const int budget = given.param("byte_budget", 0);
  if (budget < 0) return Error{"~byte_budget must be 0 (none) or bytes"};
  options.byte_budget = static_cast<std::size_t>(budget);
  const auto fill = given.param<std::string>("unsent_fill", "smooth");
  if (fill != "black" && fill != "smooth") {
    return Error{"~unsent_fill is '" + fill + "', must be black or smooth"};
  }
  options.fill = fill == "black" ? UnsentFill::kBlack : UnsentFill::kSmooth;
  return options;
}

Result<SendQueueOptions> read_send_options(const Parameters& given, const std::string& robot) {
  SendQueueOptions options;
  options.robot = robot;
  options.bandwidth = given.param("bandwidth", options.bandwidth);
  options.frame_rate = given.param("frame_rate", options.frame_rate);
  options.waiting = static_cast<std::size_t>(std::max(given.param("queue_size", 5), 1));
  options.in_flight = static_cast<std::size_t>(std::max(given.param("in_flight", 3), 0));
  options.receipt_timeout =
      from_seconds(given.param("receipt_timeout", to_seconds(options.receipt_timeout)));
  const std::string wrong = wrong_bandwidth(options.bandwidth);
  if (!wrong.empty()) return Error{wrong};
  return options;
}

Result<FrameCodecOptions> with_config(FrameCodecOptions options,
                                      const rprr_codec::EncoderConfig& config) {
  const std::optional<Objective> objective = objective_of(config.objective);
  if (!objective) return Error{"~objective must be fixed, map or view"};
  const std::string wrong = wrong_bandwidth(config.bandwidth);
  if (!wrong.empty()) return Error{wrong};
  options.objective = *objective;
  options.colour_quality = config.colour_quality;
  options.view_quality = config.view_quality;
  options.byte_budget = static_cast<std::size_t>(std::max(config.byte_budget, 0));
  options.target_psnr = config.target_psnr;
  return options;
}

}  // namespace rprr
