// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rprr_sensor_ros/recording.hpp"

namespace rprr {

Result<std::unique_ptr<Recording>> open_bag_recording(const std::string& path,
                                                      const RecordingOptions& options);

}  // namespace rprr
