// SPDX-License-Identifier: BSD-3-Clause
#include "cameras/rgbd_camera.hpp"

#include <sensor_msgs/Image.h>
#include <sensor_msgs/image_encodings.h>

#include <algorithm>
#include <boost/make_shared.hpp>
#include <chrono>
#include <cstdio>

#include "rprr_ros/conversions.hpp"
#include "rprr_ros/parameters.hpp"
#include "rprr_ros/steady_now.hpp"
#include "rprr_sensor_ros/frame_messages.hpp"

namespace rprr {
namespace {

constexpr int kQueue = 4;
constexpr Duration kLongestSleep = from_seconds(0.1);
constexpr double kLookPeriod = 1.0;  // s, at what changes slowly

std::string with_unit(double value, const char* format) {
  char text[64];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

sensor_msgs::ImagePtr image_message(const std_msgs::Header& header, const std::string& encoding,
                                    const cv::Mat& pixels) {
  // Shared pointers: subscribers in the same nodelet manager get them without a copy.
  return boost::make_shared<sensor_msgs::Image>(to_image(header, encoding, pixels));
}

}  // namespace

RgbdCamera::~RgbdCamera() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stop_ = true;
  }
  wake_.notify_all();
  worker_.reset();
}

void RgbdCamera::onInit() {
  ros::NodeHandle& private_nh = getPrivateNodeHandle();
  const std::string wrong = read_parameters(private_nh, options_of(options_));
  health_ = std::make_unique<Health>(getNodeHandle(), private_nh, getName(), options_.robot);
  if (!wrong.empty()) return health_->refuse_parameters(wrong);
  if (options_.frame_id.empty()) options_.frame_id = optical_frame(options_.robot);
  gate_.pause(options_.paused);
  apply_live_options();
  calibration_ = std::make_unique<CameraCalibration>(
      ros::NodeHandle(getNodeHandle(), "/" + options_.robot + "/camera"), options_, *health_);
  advertise();
  const SessionOptions session = options_.session;  // the worker's own
  live_ = std::make_unique<LiveOptions>(private_nh, options_of(options_), *health_, [this] {
    apply_live_options();
    return std::string();
  });
  worker_ = std::make_unique<Worker>(1);
  worker_->post([this, session] { run(session); });
}

void RgbdCamera::advertise() {
  ros::NodeHandle& nh = getNodeHandle();
  ros::NodeHandle& private_nh = getPrivateNodeHandle();
  const InputTopics topics = input_topics(options_.robot);
  colour_ = nh.advertise<sensor_msgs::Image>(topics.colour, kQueue);
  raw_colour_ =
      nh.advertise<sensor_msgs::Image>("/" + options_.robot + "/camera/rgb/image_raw", kQueue);
  camera_info_ = nh.advertise<sensor_msgs::CameraInfo>(topics.camera_info, kQueue);
  depth_ = nh.advertise<sensor_msgs::Image>(topics.depth, kQueue);
  pause_ = private_nh.advertiseService("pause", &RgbdCamera::on_pause, this);
  trigger_ = private_nh.advertiseService("trigger", &RgbdCamera::on_trigger, this);
}

void RgbdCamera::apply_live_options() {
  const std::lock_guard<std::mutex> lock(mutex_);
  gate_.limit(options_.every_nth, options_.max_rate);
  new_controls_ = options_.session.controls;
}

bool RgbdCamera::on_pause(std_srvs::SetBool::Request& request,
                          std_srvs::SetBool::Response& response) {
  const std::lock_guard<std::mutex> lock(mutex_);
  gate_.pause(request.data != 0);
  response.success = 1;
  response.message = request.data != 0 ? "paused: ~trigger publishes one pair" : "running";
  return true;
}

bool RgbdCamera::on_trigger(std_srvs::Trigger::Request& /*request*/,
                            std_srvs::Trigger::Response& response) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!streaming_) {
    response.success = 0;
    response.message = "no camera runs; /diagnostics tells why";
  } else if (!gate_.trigger()) {
    response.success = 0;
    response.message = "not paused; call ~pause first";
  } else {
    response.success = 1;
    response.message = "the next pair will be published";
  }
  return true;
}

void RgbdCamera::run(const SessionOptions& options) {
  SessionClocks clocks;
  clocks.steady = steady_now;
  clocks.stamps = [] { return to_stamp(ros::Time::now()); };
  DeviceSession session(make_driver(), options, clocks);
  while (running()) {
    std::optional<DeviceControls> controls;
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      controls.swap(new_controls_);
    }
    if (controls) {
      const std::string refused = session.control(*controls);
      if (!refused.empty()) health_->warn("controls", refused);
    }
    handle(session.step(), session);
  }
}

void RgbdCamera::handle(SessionStep step, DeviceSession& session) {
  if (step.opened) opened(session);
  if (step.notice) {
    if (step.notice->is_error) {
      health_->error(step.notice->key, step.notice->text);
    } else {
      health_->warn(step.notice->key, step.notice->text);
    }
  }
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    streaming_ = session.device() != nullptr;
  }
  if (step.pair && has_listeners()) {
    bool wanted = false;
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      wanted = gate_.pass(step.pair->colour_stamp);
    }
    if (wanted && processor_) publish(*step.pair);
  }
  if ((ros::WallTime::now() - last_look_).toSec() > kLookPeriod) show(session);
  if (step.idle > 0) sleep(step.idle);
}

void RgbdCamera::opened(const DeviceSession& session) {
  const std::string& serial = session.device()->serial();
  NODELET_INFO("camera %s of %s runs", serial.empty() ? "without serial number" : serial.c_str(),
               options_.robot.c_str());
  health_->show("serial", serial.empty() ? "none" : serial);
  health_->count("times opened");
  calibration_->load(serial);
  prepare(*session.device());
}

void RgbdCamera::prepare(const RgbdDevice& device) {
  const bool own = device.depth_format() != DepthFormat::registered_mm;
  health_->show("registration", own ? "own" : "by the device");
  const DeviceModes& modes = options_.session.modes;
  auto processor = PairProcessor::create(calibration_->get(modes.width, modes.height, own),
                                         device.depth_format());
  processor_.reset();
  if (!processor) {
    health_->error("calibration", processor.reason());
    return;
  }
  processor_.emplace(std::move(*processor));
}

void RgbdCamera::publish(const DevicePair& pair) {
  const auto image = processor_->process(pair);
  if (!image) {
    health_->error("images", image.reason());
    return;
  }
  std_msgs::Header header;
  header.stamp = to_time(pair.colour_stamp);
  header.frame_id = options_.frame_id;
  const auto info = boost::make_shared<sensor_msgs::CameraInfo>(calibration_->colour_info());
  info->header = header;
  camera_info_.publish(info);
  colour_.publish(image_message(header, sensor_msgs::image_encodings::BGR8, image->bgr));
  depth_.publish(
      image_message(header, sensor_msgs::image_encodings::TYPE_16UC1, image->depth.counts));
  if (raw_colour_.getNumSubscribers() > 0) {
    raw_colour_.publish(
        image_message(header, sensor_msgs::image_encodings::BGR8, pair.colour.pixels));
  }
  health_->count("pairs published");
}

void RgbdCamera::show(const DeviceSession& session) {
  last_look_ = ros::WallTime::now();
  if (session.device() == nullptr) {
    health_->show("state", "no camera");
    return;
  }
  if (calibration_->changed()) prepare(*session.device());
  bool paused = false;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    paused = gate_.paused();
  }
  const SessionRates rates = session.rates();
  health_->show("state", paused ? "paused" : "running");
  health_->show("colour", with_unit(rates.colour, "%.1f images/s"));
  health_->show("depth", with_unit(rates.depth, "%.1f images/s"));
  health_->show("largest skew between colour and depth",
                with_unit(1000.0 * rates.worst_skew, "%.1f ms"));
  health_->show("images without partner", std::to_string(session.unpaired()));
}

bool RgbdCamera::has_listeners() const {
  return colour_.getNumSubscribers() + depth_.getNumSubscribers() +
             camera_info_.getNumSubscribers() + raw_colour_.getNumSubscribers() >
         0;
}

bool RgbdCamera::running() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return !stop_ && ros::ok();
}

void RgbdCamera::sleep(Duration at_most) {
  std::unique_lock<std::mutex> lock(mutex_);
  wake_.wait_for(lock, std::chrono::nanoseconds(std::min(at_most, kLongestSleep)),
                 [this] { return stop_; });
}

}  // namespace rprr
