// SPDX-License-Identifier: BSD-3-Clause
#include <pluginlib/class_list_macros.hpp>

#include "cameras/openni2_driver.hpp"
#include "cameras/rgbd_camera.hpp"

namespace rprr {

/// A camera of PrimeSense's kind, or its recording, through OpenNI2.
class OpenNI2 : public RgbdCamera {
  std::unique_ptr<RgbdDriver> make_driver() const override { return make_openni2_driver(); }
};

}  // namespace rprr

PLUGINLIB_EXPORT_CLASS(rprr::OpenNI2, nodelet::Nodelet)
