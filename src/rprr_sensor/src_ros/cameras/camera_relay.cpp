// SPDX-License-Identifier: BSD-3-Clause
#include "cameras/camera_relay.hpp"

#include <pluginlib/class_list_macros.hpp>
#include <type_traits>

#include "cameras/relay_options.hpp"
#include "rprr_ros/parameters.hpp"
#include "rprr_sensor_ros/frame_messages.hpp"

namespace rprr {
namespace {

constexpr int kQueue = 4;
constexpr double kShowPeriod = 3.0;  // [s]

}  // namespace

void CameraRelay::onInit() {
  ros::NodeHandle& private_nh = getPrivateNodeHandle();
  RelayOptions options;
  const std::string wrong = read_parameters(private_nh, options_of(options));
  health_ = std::make_unique<Health>(getNodeHandle(), private_nh, getName(), options.robot);
  if (!wrong.empty()) return health_->refuse_parameters(wrong);
  inputs_ = std::make_unique<InputReport>(getNodeHandle(), *health_);
  const InputTopics topics = input_topics(options.robot);
  connect<sensor_msgs::CameraInfo>(lines_[0], options.camera_info_topic, topics.camera_info);
  connect<sensor_msgs::Image>(lines_[1], options.rgb_topic, topics.colour);
  connect<sensor_msgs::Image>(lines_[2], options.depth_topic, topics.depth);
  timer_ =
      getNodeHandle().createWallTimer(ros::WallDuration(kShowPeriod), &CameraRelay::show, this);
}

template <typename Message>
void CameraRelay::connect(Line& line, const std::string& from, const std::string& to) {
  ros::NodeHandle& nh = getNodeHandle();
  // Latched, since the driver may say its camera_info once only.
  const bool latched = std::is_same_v<Message, sensor_msgs::CameraInfo>;
  line.to = nh.advertise<Message>(to, kQueue, latched);
  if (nh.resolveName(from) == nh.resolveName(to)) {
    return health_->refuse_parameters(to +
                                      " would be passed on to itself: name the camera "
                                      "driver's topic");
  }
  const boost::function<void(const boost::shared_ptr<const Message>&)> pass =
      [this, &line](const boost::shared_ptr<const Message>& message) {
        line.to.publish(message);
        ++line.passed;
        inputs_->heard(line.topic);
      };
  line.topic = nh.resolveName(from);
  line.from = nh.subscribe<Message>(from, kQueue, pass);
  inputs_->expect(line.topic, latched ? InputKind::kOnce : InputKind::kStream, "message for " + to,
                  "start the camera's driver with depth registration, or give its topic's name");
}

void CameraRelay::show(const ros::WallTimerEvent& /*event*/) {
  for (const Line& line : lines_) {
    health_->show(line.topic + " (messages)", std::to_string(line.passed));
  }
}

}  // namespace rprr

PLUGINLIB_EXPORT_CLASS(rprr::CameraRelay, nodelet::Nodelet)
