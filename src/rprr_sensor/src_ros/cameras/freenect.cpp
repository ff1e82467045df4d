// SPDX-License-Identifier: BSD-3-Clause
#include <pluginlib/class_list_macros.hpp>

#include "cameras/freenect_driver.hpp"
#include "cameras/rgbd_camera.hpp"

namespace rprr {

/// A Kinect for the Xbox 360 through libfreenect.
class Freenect : public RgbdCamera {
  std::unique_ptr<RgbdDriver> make_driver() const override { return make_freenect_driver(); }
};

}  // namespace rprr

PLUGINLIB_EXPORT_CLASS(rprr::Freenect, nodelet::Nodelet)
