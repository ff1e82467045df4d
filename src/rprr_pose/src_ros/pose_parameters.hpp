// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include "rprr_pose/preview_protocol.hpp"
#include "rprr_pose/samples_protocol.hpp"
#include "rprr_ros/parameters.hpp"
#include "tf_prior.hpp"

namespace rprr {

/// Default of ~stale_overlap.
constexpr double kStaleOverlap = 0.7;

/// The private parameters of config/pose.yaml.
SamplesOptions read_samples_options(const Parameters& parameters, const std::string& robot,
                                    const std::string& peer);

/// Likewise, for the preview protocol.
PreviewOptions read_preview_options(const Parameters& parameters, const std::string& robot,
                                    const std::string& peer);

/// What tf may propose to a as first poses towards peer; none if ~tf_prior is false.
std::optional<TfPriorOptions> read_tf_prior_options(const Parameters& parameters,
                                                    const std::string& robot,
                                                    const std::string& peer);

/// ~protocol: "preview" (default) or "samples". Another word is said and becomes the default.
bool uses_previews(const Parameters& parameters);

}  // namespace rprr
