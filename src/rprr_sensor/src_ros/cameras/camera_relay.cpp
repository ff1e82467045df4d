// SPDX-License-Identifier: BSD-3-Clause
#include "cameras/camera_relay.hpp"

#include <pluginlib/class_list_macros.hpp>

#include "cameras/relay_options.hpp"
#include "rprr_ros/parameters.hpp"
#include "rprr_sensor_ros/frame_messages.hpp"

namespace rprr {
namespace {

constexpr int kQueue = 4;
constexpr double kLookPeriod = 3.0;  // s

}  // namespace

void CameraRelay::onInit() {
  ros::NodeHandle& private_nh = getPrivateNodeHandle();
  RelayOptions options;
  const std::string wrong = read_parameters(private_nh, options_of(options));
  health_ = std::make_unique<Health>(getNodeHandle(), private_nh, getName(), options.robot);
  if (!wrong.empty()) return health_->refuse_parameters(wrong);
  const InputTopics topics = input_topics(options.robot);
  connect<sensor_msgs::CameraInfo>(lines_[0], options.camera_info_topic, topics.camera_info);
  connect<sensor_msgs::Image>(lines_[1], options.rgb_topic, topics.colour);
  connect<sensor_msgs::Image>(lines_[2], options.depth_topic, topics.depth);
  timer_ =
      getNodeHandle().createWallTimer(ros::WallDuration(kLookPeriod), &CameraRelay::watch, this);
}

template <typename Message>
void CameraRelay::connect(Line& line, const std::string& from, const std::string& to) {
  ros::NodeHandle& nh = getNodeHandle();
  line.to = nh.advertise<Message>(to, kQueue);
  if (nh.resolveName(from) == nh.resolveName(to)) {
    NODELET_ERROR("%s would be passed on to itself: name the camera driver's topic", to.c_str());
    return;
  }
  const boost::function<void(const boost::shared_ptr<const Message>&)> pass =
      [&line](const boost::shared_ptr<const Message>& message) {
        line.to.publish(message);
        ++line.passed;
      };
  line.from = nh.subscribe<Message>(from, kQueue, pass);
}

void CameraRelay::watch(const ros::WallTimerEvent& /*event*/) {
  for (Line& line : lines_) {
    const std::uint64_t passed = line.passed;
    const std::string from = line.from.getTopic();
    health_->show(from + " (messages)", std::to_string(passed));
    if (passed == line.seen && !from.empty()) {
      const bool published = line.from.getNumPublishers() > 0;
      health_->warn(from, "nothing on " + from + ", which should become " + line.to.getTopic() +
                              (published ? ": its publisher is silent; is depth registration on, "
                                           "and the camera plugged in?"
                                         : ": nobody publishes it; is the camera driver up, and "
                                           "is that the topic's name?"));
    }
    line.seen = passed;
  }
}

}  // namespace rprr

PLUGINLIB_EXPORT_CLASS(rprr::CameraRelay, nodelet::Nodelet)
