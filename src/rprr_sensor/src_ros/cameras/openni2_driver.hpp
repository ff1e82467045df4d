// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "rprr_sensor/cameras/rgbd_device.hpp"

namespace rprr {

/// Cameras that OpenNI2 knows (PrimeSense, Asus Xtion and their kin), and its recordings. They are
/// named by serial number, by URI, or by the path of an .oni file. A recording has the modes that
/// it has, and begins again at its end.
std::unique_ptr<RgbdDriver> make_openni2_driver();

}  // namespace rprr
