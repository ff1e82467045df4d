// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_eval/profile.hpp"

#include <yaml-cpp/yaml.h>

#include <filesystem>

#include "profile_folder.hpp"

namespace rprr {
namespace {

// Throws YAML::Exception that names the key, where its value cannot be read.
template <typename T>
void read(const YAML::Node& file, const char* key, T& value) {
  const YAML::Node node = file[key];
  if (!node) return;
  try {
    value = node.as<T>();
  } catch (const YAML::Exception&) {
    throw YAML::Exception(node.Mark(), std::string(key) + " has a value of another kind");
  }
}

void read_samples(const YAML::Node& file, SamplesOptions& pose) {
  read(file, "sample_count", pose.sample_count);
  read(file, "max_iterations", pose.max_iterations);
  read(file, "converged_translation", pose.converged_translation);
  read(file, "converged_rotation", pose.converged_rotation);
  read(file, "resample", pose.resample);
  read(file, "weigh_by_noise", pose.by_noise);
  read(file, "local_start", pose.local_start);
  read(file, "min_overlap", pose.limits.min_overlap);
  read(file, "min_consistent", pose.limits.min_consistent);
  read(file, "max_violating", pose.limits.max_violating);
  read(file, "max_residual_sigmas", pose.limits.max_residual_sigmas);
  read(file, "min_matched", pose.limits.min_matched);
  read(file, "max_sigma_translation", pose.limits.max_sigma_translation);
  read(file, "max_sigma_rotation", pose.limits.max_sigma_rotation);
}

void read_seconds(const YAML::Node& file, const char* key, Duration& value) {
  double seconds = to_seconds(value);
  read(file, key, seconds);
  value = from_seconds(seconds);
}

void read_preview(const YAML::Node& file, PreviewOptions& pose) {
  read(file, "preview_step", pose.step);
  read(file, "preview_lossless", pose.lossless_depth);
  read(file, "preview_quality", pose.colour_quality);
  read(file, "search_yaw", pose.search.range.yaw);
  read(file, "search_pitch", pose.search.range.pitch);
  read(file, "search_roll", pose.search.range.roll);
  PreviewLimits& limits = pose.search.limits;
  read(file, "preview_min_overlap", limits.min_overlap);
  read(file, "preview_max_violating", limits.max_violating);
  read(file, "preview_min_evidence", limits.min_evidence);
  read(file, "preview_min_margin", limits.min_margin);
  read(file, "preview_warm_evidence", limits.warm_evidence);
  read_seconds(file, "reference_age", pose.reference_age);
}

// Empty, or why a word is none of the two that a key knows.
template <typename T>
std::string choose(const YAML::Node& file, const char* key, const char* first, T first_value,
                   const char* second, T second_value, T& value) {
  if (!file[key]) return {};
  std::string word;
  read(file, key, word);
  if (word == first) {
    value = first_value;
  } else if (word == second) {
    value = second_value;
  } else {
    return std::string(key) + ": '" + word + "' is neither " + first + " nor " + second;
  }
  return {};
}

std::string read_depth_mode(const YAML::Node& file, DhcmMode& mode) {
  std::string word = dhcm_mode_name(mode);
  read(file, "depth_mode", word);
  const Result<DhcmMode> found = dhcm_mode_from_name(word);
  if (!found) return "depth_mode: " + found.reason();
  mode = *found;
  return {};
}

std::string read_objective(const YAML::Node& file, Objective& objective) {
  if (!file["objective"]) return {};
  std::string word;
  read(file, "objective", word);
  const std::optional<Objective> found = objective_of(word);
  if (!found) return "objective: '" + word + "' is none of fixed, map, view";
  objective = *found;
  return {};
}

std::string read_rest(const YAML::Node& file, Profile& profile) {
  read(file, "validation_min_pixels", profile.validation.min_pixels);
  read(file, "colour_codec", profile.codec.colour_codec);
  read(file, "colour_quality", profile.codec.colour_quality);
  read(file, "view_quality", profile.codec.view_quality);
  read(file, "base_codec", profile.codec.base_codec);
  read(file, "base_reduction", profile.codec.base_reduction);
  read(file, "base_quality", profile.codec.base_quality);
  read(file, "byte_budget", profile.codec.byte_budget);
  read(file, "target_psnr", profile.codec.target_psnr);
  read(file, "in_flight", profile.sending.in_flight);
  read_seconds(file, "receipt_timeout", profile.sending.receipt_timeout);
  read(file, "edge_margin", profile.station.stitch.edge_margin);
  read(file, "align", profile.station.synthesis.align);
  std::string wrong =
      choose(file, "protocol", "preview", true, "samples", false, profile.use_previews);
  if (!wrong.empty()) return wrong;
  wrong = read_depth_mode(file, profile.codec.depth_mode);
  if (!wrong.empty()) return wrong;
  wrong = read_objective(file, profile.codec.objective);
  if (!wrong.empty()) return wrong;
  wrong = choose(file, "unsent_fill", "black", UnsentFill::kBlack, "smooth", UnsentFill::kSmooth,
                 profile.codec.fill);
  if (wrong.empty()) {
    wrong = choose(file, "synthesis", "forward", Synthesis::kForward, "backward",
                   Synthesis::kBackward, profile.station.synthesis.mode);
  }
  if (wrong.empty()) {
    wrong = choose(file, "unknown_fill", "black", UnknownFill::kBlack, "smooth",
                   UnknownFill::kSmooth, profile.station.stitch.fill);
  }
  return wrong;
}

}  // namespace

Result<Profile> load_profile(const std::string& name_or_path) {
  std::string path = name_or_path;
  if (path.find('/') == std::string::npos && path.find('.') == std::string::npos) {
    path = profile_folder() + "/" + path + ".yaml";
  }
  if (!std::filesystem::exists(path)) {
    return Error{"no profile " + path + "; use default, paper or the path of a YAML file"};
  }
  Profile profile;
  profile.name = name_or_path;
  try {
    const YAML::Node file = YAML::LoadFile(path);
    if (!file.IsMap()) return Error{path + ": no list of `key: value` lines"};
    read_samples(file, profile.samples);
    read_preview(file, profile.preview);
    const std::string wrong = read_rest(file, profile);
    if (!wrong.empty()) return Error{path + ": " + wrong};
  } catch (const YAML::Exception& error) {
    return Error{path + ": " + error.what()};
  }
  return profile;
}

}  // namespace rprr
