// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sensor_msgs/Image.h>

#include <functional>
#include <memory>

#include "rprr_geometry/stamp.hpp"

namespace rprr {

/// Pairs the images of two streams by stamp, equal or nearest, whatever their rates and losses:
/// message_filters' ApproximateTime. Pairs whose stamps are equal come out at once, others when the
/// next image shows that none fits better. Any thread may call it.
class ImagePairing {
 public:
  using Callback =
      std::function<void(const sensor_msgs::ImageConstPtr&, const sensor_msgs::ImageConstPtr&)>;

  /// most_apart: stamps of a pair. The callback runs within add_first() and add_second(); it must
  /// not call them.
  ImagePairing(Duration most_apart, Callback callback);
  ~ImagePairing();

  /// Stamps of a stream ascend. Where they go back, as in a recording that starts again, both
  /// streams begin anew.
  void add_first(const sensor_msgs::ImageConstPtr& image);
  void add_second(const sensor_msgs::ImageConstPtr& image);

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace rprr
