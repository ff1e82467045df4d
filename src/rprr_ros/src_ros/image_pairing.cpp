// SPDX-License-Identifier: BSD-3-Clause
#include "image_pairing.hpp"

#include <message_filters/sync_policies/approximate_time.h>
#include <message_filters/synchronizer.h>

#include <mutex>
#include <utility>

namespace rprr {
namespace {

using sensor_msgs::Image;
using sensor_msgs::ImageConstPtr;
using Policy = message_filters::sync_policies::ApproximateTime<Image, Image>;
using Synchronizer = message_filters::Synchronizer<Policy>;

constexpr std::uint32_t kWaiting = 10;  // images of one kind that wait for the other

}  // namespace

class ImagePairing::Implementation {
 public:
  Implementation(Duration most_apart, Callback callback)
      : most_apart_(most_apart), callback_(std::move(callback)) {
    begin();
  }

  template <int stream>
  void add(const ImageConstPtr& image) {
    const std::lock_guard<std::mutex> lock(mutex_);
    ros::Time& last = last_[stream];
    if (image->header.stamp < last) begin();
    last = image->header.stamp;
    synchronizer_->add<stream>(ros::MessageEvent<Image const>(image, ros::Time()));
  }

 private:
  void begin() {
    Policy policy(kWaiting);
    policy.setMaxIntervalDuration(ros::Duration(to_seconds(most_apart_)));
    synchronizer_ = std::make_unique<Synchronizer>(policy);
    synchronizer_->registerCallback(&Implementation::on_pair, this);
    last_[0] = last_[1] = ros::Time();
  }
  void on_pair(const ImageConstPtr& first, const ImageConstPtr& second) {
    callback_(first, second);
  }

  const Duration most_apart_;
  const Callback callback_;
  std::mutex mutex_;
  std::unique_ptr<Synchronizer> synchronizer_;
  ros::Time last_[2];
};

ImagePairing::ImagePairing(Duration most_apart, Callback callback)
    : implementation_(std::make_unique<Implementation>(most_apart, std::move(callback))) {
}
ImagePairing::~ImagePairing() = default;

void ImagePairing::add_first(const ImageConstPtr& image) {
  implementation_->add<0>(image);
}
void ImagePairing::add_second(const ImageConstPtr& image) {
  implementation_->add<1>(image);
}

}  // namespace rprr
