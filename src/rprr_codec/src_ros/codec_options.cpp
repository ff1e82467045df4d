// SPDX-License-Identifier: BSD-3-Clause
#include "codec_options.hpp"

#include <optional>
#include <string>

namespace rprr {

Result<FrameCodecOptions> read_codec_options(const ros::NodeHandle& nh) {
  FrameCodecOptions options;
  options.colour_codec = nh.param("colour_codec", options.colour_codec);
  options.colour_quality = nh.param("colour_quality", options.colour_quality);
  options.view_quality = nh.param("view_quality", options.view_quality);
  options.base_codec = nh.param("base_codec", options.base_codec);
  options.base_reduction = nh.param("base_reduction", options.base_reduction);
  options.base_quality = nh.param("base_quality", options.base_quality);
  options.measure_independent = nh.param("measure_independent", options.measure_independent);
  options.target_psnr = nh.param("target_psnr", options.target_psnr);

  const Result<DhcmMode> mode =
      dhcm_mode_from_name(nh.param<std::string>("depth_mode", dhcm_mode_name(options.depth_mode)));
  if (!mode) return Error{"~depth_mode: " + mode.reason()};
  options.depth_mode = *mode;
  const auto named = nh.param<std::string>("objective", "fixed");
  const std::optional<Objective> objective = objective_of(named);
  if (!objective) return Error{"~objective is '" + named + "', must be fixed, map or view"};
  options.objective = *objective;
  const int budget = nh.param("byte_budget", 0);
  if (budget < 0) return Error{"~byte_budget must be 0 (none) or bytes"};
  options.byte_budget = static_cast<std::size_t>(budget);
  const auto fill = nh.param<std::string>("unsent_fill", "smooth");
  if (fill != "black" && fill != "smooth") {
    return Error{"~unsent_fill is '" + fill + "', must be black or smooth"};
  }
  options.fill = fill == "black" ? UnsentFill::kBlack : UnsentFill::kSmooth;
  return options;
}

}  // namespace rprr
