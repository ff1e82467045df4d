// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_ros/rgbd_subscriber.hpp"

#include <cmath>
#include <opencv2/core.hpp>
#include <sstream>

#include "rprr_ros/conversions.hpp"

namespace rprr {
namespace {

constexpr std::size_t kWaiting = 10;  // images of one kind that wait for the other
constexpr double kLeap = 10.0;        // seconds that stamps may be ahead of what has passed

using Images = std::deque<sensor_msgs::ImageConstPtr>;

// Takes the image nearest in time out of the queue, and those before it.
sensor_msgs::ImageConstPtr take_nearest(Images& images, const ros::Time& stamp, double tolerance) {
  auto best = images.end();
  double best_difference = tolerance;
  for (auto image = images.begin(); image != images.end(); ++image) {
    const double difference = std::abs(((*image)->header.stamp - stamp).toSec());
    if (difference > best_difference) continue;
    best_difference = difference;
    best = image;
  }
  if (best == images.end()) return nullptr;
  const sensor_msgs::ImageConstPtr found = *best;
  images.erase(images.begin(), best + 1);
  return found;
}

void keep(Images& images, const sensor_msgs::ImageConstPtr& image) {
  // Time went back: what waits will not find its partner any more.
  if (!images.empty() && image->header.stamp < images.back()->header.stamp) images.clear();
  images.push_back(image);
  if (images.size() > kWaiting) images.pop_front();
}

std::string size_text(std::uint32_t width, std::uint32_t height) {
  std::ostringstream text;
  text << width << "x" << height;
  return text.str();
}

}  // namespace

RgbdSubscriber::RgbdSubscriber(ros::NodeHandle nh, ros::NodeHandle private_nh,
                               const std::string& robot, const InputOptions& options,
                               Health& health, Callback callback)
    : health_(health), callback_(std::move(callback)), options_(options), transport_(nh) {
  const std::string camera = "/" + robot + "/camera/";
  const image_transport::TransportHints hints(options_.image_transport,
                                              ros::TransportHints().tcpNoDelay(), private_nh);
  info_subscriber_ = nh.subscribe(camera + "rgb/camera_info", 5, &RgbdSubscriber::on_info, this);
  rgb_subscriber_ = transport_.subscribe(camera + "rgb/image_rect_color", 5,
                                         &RgbdSubscriber::on_rgb, this, hints);
  depth_subscriber_ = transport_.subscribe(camera + "depth_registered/image_rect", 5,
                                           &RgbdSubscriber::on_depth, this, hints);
  timer_ = nh.createWallTimer(ros::WallDuration(2.0), &RgbdSubscriber::watch, this);
}

void RgbdSubscriber::on_info(const sensor_msgs::CameraInfoConstPtr& info) {
  const std::lock_guard<std::mutex> lock(mutex_);
  info_ = info;
}

void RgbdSubscriber::on_rgb(const sensor_msgs::ImageConstPtr& image) {
  sensor_msgs::ImageConstPtr depth;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ++rgb_seen_;
    depth = take_nearest(waiting_depth_, image->header.stamp, options_.max_stamp_difference);
    if (!depth) return keep(waiting_rgb_, image);
  }
  emit(image, depth);
}

void RgbdSubscriber::on_depth(const sensor_msgs::ImageConstPtr& image) {
  sensor_msgs::ImageConstPtr rgb;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ++depth_seen_;
    rgb = take_nearest(waiting_rgb_, image->header.stamp, options_.max_stamp_difference);
    if (!rgb) return keep(waiting_depth_, image);
  }
  emit(rgb, image);
}

void RgbdSubscriber::emit(const sensor_msgs::ImageConstPtr& rgb,
                          const sensor_msgs::ImageConstPtr& depth) {
  sensor_msgs::CameraInfoConstPtr info;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ++pairs_seen_;
    info = info_;
    watch_stamp(rgb->header.stamp);
  }
  const std::string rgb_topic = rgb_subscriber_.getTopic();
  const std::string depth_topic = depth_subscriber_.getTopic();
  const std::string info_topic = info_subscriber_.getTopic();
  if (!info) {
    return health_.error("camera_info missing", "no message on " + info_topic +
                                                    ", so images are dropped; start the camera's "
                                                    "camera_info or remap it here");
  }
  const Result<Camera> camera = camera_from_info(*info);
  if (!camera) {
    return health_.error("camera_info unusable",
                         info_topic + ": " + camera.reason() + "; calibrate the camera");
  }
  if (rgb->width != depth->width || rgb->height != depth->height) {
    return health_.error("sizes differ", rgb_topic + " is " + size_text(rgb->width, rgb->height) +
                                             " but " + depth_topic + " is " +
                                             size_text(depth->width, depth->height) +
                                             "; publish depth registered to colour, of equal size");
  }
  if (rgb->width != info->width || rgb->height != info->height) {
    return health_.error("camera_info of another size",
                         rgb_topic + " is " + size_text(rgb->width, rgb->height) + " but " +
                             info_topic + " says " + size_text(info->width, info->height) +
                             "; use the camera_info of this resolution");
  }
  const Result<cv::Mat> bgr = bgr_from_image(*rgb);
  if (!bgr) return health_.error("colour unusable", rgb_topic + ": " + bgr.reason());
  const Result<DepthFrame> counts = depth_from_image(*depth, options_.depth_unit);
  if (!counts) return health_.error("depth unusable", depth_topic + ": " + counts.reason());
  if (cv::countNonZero(counts->counts) == 0) {  // goes on: the colour is worth sending
    health_.warn("depth empty", depth_topic +
                                    " has no reading at all, so no pose can be found; check that "
                                    "the sensor runs and is within its range");
  }

  const auto frame = std::make_shared<RgbdFrame>();
  frame->stamp = to_stamp(rgb->header.stamp);
  frame->frame_id = clean_frame(rgb->header.frame_id);
  frame->camera = *camera;
  frame->bgr = *bgr;
  frame->depth = *counts;
  frame->owner = std::make_shared<const Images>(Images{rgb, depth});
  health_.count("frames");
  callback_(frame);
}

// With the mutex held. Two cameras whose clocks went apart pair frames of different instants.
void RgbdSubscriber::watch_stamp(const ros::Time& stamp) {
  const ros::SteadyTime now = ros::SteadyTime::now();
  const double step = (stamp - last_stamp_).toSec();
  const bool leaps = step < 0.0 || step > (now - last_arrival_).toSec() + kLeap;
  if (!last_stamp_.isZero() && leaps) {
    health_.warn("stamps leap", "stamps on " + rgb_subscriber_.getTopic() + " went " +
                                    (step < 0.0 ? "back" : "ahead") + " by " +
                                    std::to_string(std::lround(std::abs(step))) +
                                    " s: a recording that starts again, or a clock that was set");
  }
  last_stamp_ = stamp;
  last_arrival_ = now;
}

void RgbdSubscriber::watch(const ros::WallTimerEvent&) {
  std::string missing;
  std::string present;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (rgb_seen_ > 0 && depth_seen_ == 0) {
      present = rgb_subscriber_.getTopic();
      missing = depth_subscriber_.getTopic();
    } else if (depth_seen_ > 0 && rgb_seen_ == 0) {
      present = depth_subscriber_.getTopic();
      missing = rgb_subscriber_.getTopic();
    } else if (rgb_seen_ > 1 && depth_seen_ > 1 && pairs_seen_ == 0) {
      missing = "stamps";
    }
    rgb_seen_ = depth_seen_ = pairs_seen_ = 0;
  }
  if (missing == "stamps") {
    health_.warn("stamps differ", "no image of " + rgb_subscriber_.getTopic() + " and " +
                                      depth_subscriber_.getTopic() +
                                      " within ~max_stamp_difference; synchronise the camera's "
                                      "streams or raise the parameter");
  } else if (!missing.empty()) {
    health_.warn("stream missing", "images on " + present + " but none on " + missing +
                                       "; start or remap that stream");
  }
}

}  // namespace rprr
