// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "rprr_sensor/cameras/rgbd_device.hpp"

namespace rprr {

/// Kinects for the Xbox 360 (and for Windows, first version) through libfreenect. 640x480 at 30
/// images a second only. Registration by the device where libfreenect offers it.
std::unique_ptr<RgbdDriver> make_freenect_driver();

}  // namespace rprr
