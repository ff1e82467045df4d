// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "rprr_sensor/recordings/tum_folder.hpp"

namespace rprr {

/// open_tum_folder(), with its remark for people on standard error.
Result<TumFolder> open_folder(const std::string& path);

}  // namespace rprr
