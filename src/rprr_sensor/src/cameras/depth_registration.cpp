// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_sensor/cameras/depth_registration.hpp"

namespace rprr {

DepthFrame DepthRegistration::apply(const DepthFrame& depth) {
  warp_depth(depth, depth_camera_, colour_camera_, colour_from_depth_, warped_,
             Footprint::kSurface);
  DepthFrame registered;
  warped_.metres.convertTo(registered.counts, CV_16U, 1000.0);
  registered.unit = 0.001;
  return registered;
}

}  // namespace rprr
