// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <diagnostic_msgs/DiagnosticArray.h>
#include <gtest/gtest.h>
#include <ros/ros.h>
#include <rprr_msgs/ExchangeEvent.h>
#include <rprr_msgs/PoseUpdate.h>
#include <rprr_msgs/RelativePose.h>
#include <rprr_msgs/SamplePoints.h>
#include <rprr_msgs/SetReference.h>

#include <algorithm>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "rprr_pose_ros/pose_seal.hpp"
#include "rprr_ros/camera_info.hpp"
#include "rprr_ros/conversions.hpp"
#include "rprr_wire/bytes.hpp"
#include "textured_views.hpp"

namespace rprr {

using rprr_msgs::ExchangeEvent;
using rprr_msgs::PoseUpdate;
using rprr_msgs::RelativePose;
using rprr_msgs::SamplePoints;

const Pose kTruth = test_motion(0.12, 6.0);

/// What others publish on a topic; what this test publishes there itself is left out.
template <typename T>
class Inbox {
 public:
  Inbox(ros::NodeHandle& nh, const std::string& topic)
      : subscriber_(nh.subscribe(topic, 100, &Inbox::receive, this)) {}
  std::vector<typename T::ConstPtr> messages;
  std::function<void(const T&)> listener;
  bool connected() const { return subscriber_.getNumPublishers() > 0; }

 private:
  void receive(const ros::MessageEvent<T const>& event) {
    if (event.getPublisherName() == ros::this_node::getName()) return;
    messages.push_back(event.getConstMessage());
    if (listener) listener(*event.getConstMessage());
  }
  ros::Subscriber subscriber_;
};

/// One robot's camera in the synthetic corner.
class CameraOfRobot {
 public:
  CameraOfRobot(ros::NodeHandle& nh, const std::string& name, const Pose& b_from_a)
      : depth(corner_view(b_from_a, true)),
        bgr(textured_frame(b_from_a, 0, name)->bgr),
        name_(name),
        rgb_(nh.advertise<sensor_msgs::Image>("/" + name + "/camera/rgb/image_rect_color", 5)),
        info_(nh.advertise<sensor_msgs::CameraInfo>("/" + name + "/camera/rgb/camera_info", 5)),
        depth_(nh.advertise<sensor_msgs::Image>("/" + name + "/camera/depth_registered/image_rect",
                                                5)) {}

  bool connected() const {
    return rgb_.getNumSubscribers() > 0 && info_.getNumSubscribers() > 0 &&
           depth_.getNumSubscribers() > 0;
  }
  /// A good frame, changed as a test likes.
  struct Frame {
    sensor_msgs::CameraInfo info;
    sensor_msgs::Image rgb;
    sensor_msgs::Image depth;
  };
  Frame frame(ros::Time stamp) const {
    std_msgs::Header header;
    header.stamp = stamp;
    header.frame_id = "/" + optical_frame(name_);  // as old bags have it
    return {info_from_camera(kTestCamera, header), to_image(header, "bgr8", bgr),
            to_depth_image(header, depth)};
  }
  void show(const Frame& frame, bool with_info = true) {
    if (with_info) info_.publish(frame.info);
    ros::WallDuration(0.05).sleep();  // info comes over another connection
    rgb_.publish(frame.rgb);
    depth_.publish(frame.depth);
  }
  void show(ros::Time stamp) { show(frame(stamp)); }

  const DepthFrame depth;
  const cv::Mat bgr;

 private:
  std::string name_;
  ros::Publisher rgb_, info_, depth_;
};

/// Exchange of eyebug_a and of eyebug_b, which refers to eyebug_a, from outside: their cameras, all
/// their topics, and a publisher on each radio topic for what they would rather not hear.
class ExchangeNodes : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(wait([this] {
      return a.connected() && b.connected() && poses.connected() && a_events.connected() &&
             b_events.connected() && protocol_connected();
    })) << "the nodes do not use the fixed topics";
    stamp = ros::Time(1000 + 100 * ++tests, 123456789);
  }
  void TearDown() override {
    // Nothing of this test is under way when the next begins.
    wait([] { return false; }, 0.1);
  }

  static bool wait(const std::function<bool()>& condition, double seconds = 15) {
    const ros::WallTime end = ros::WallTime::now() + ros::WallDuration(seconds);
    while (ros::ok() && ros::WallTime::now() < end) {
      ros::spinOnce();
      if (condition()) return true;
      ros::WallDuration(0.005).sleep();
    }
    return false;
  }
  /// Topics of the protocol that the nodes speak.
  virtual bool protocol_connected() const {
    return a_samples.connected() && b_samples.connected() && a_updates.connected() &&
           b_updates.connected() &&
           are_heard({&radio_a_samples, &radio_a_update, &radio_b_samples, &radio_b_update});
  }
  bool are_heard(const std::vector<const ros::Publisher*>& radios) const {
    const auto heard = [](const ros::Publisher* radio) {
      return radio->getNumSubscribers() >= 2;  // one is this test's own inbox
    };
    return heard(&radio_pose) && std::all_of(radios.begin(), radios.end(), heard);
  }

  ros::Time next_stamp() { return stamp += ros::Duration(1.0); }
  const ExchangeEvent* event_of(const Inbox<ExchangeEvent>& events, ros::Time at) const {
    for (const auto& event : events.messages) {
      if (event->frame.header.stamp == at) return event.get();
    }
    return nullptr;
  }
  const RelativePose* pose_of(ros::Time at) const {
    for (const auto& pose : poses.messages) {
      if (pose->header.stamp == at) return pose.get();
    }
    return nullptr;
  }
  /// Both robots see the corner at a new stamp; waits until b's frame is decided and a's exchange
  /// has ended. b is shown first: its frame is there when a asks.
  bool exchange() {
    next_stamp();
    b.show(stamp);
    a.show(stamp);
    return wait(
        [this] { return event_of(b_events, stamp) != nullptr && pose_of(stamp) != nullptr; });
  }
  bool accepted() const {
    const ExchangeEvent* event = event_of(b_events, stamp);
    const RelativePose* pose = pose_of(stamp);
    return event != nullptr && event->action == ExchangeEvent::SEND_SPARSE && pose != nullptr &&
           pose->status == RelativePose::ACCEPTED && is_right(*pose);
  }
  bool is_right(const RelativePose& pose) const {
    const Pose b_from_a = pose_from_fields(pose.translation, pose.rotation);
    return translation_error(b_from_a, truth) < metres_allowed &&
           rotation_error(b_from_a, truth) < degrees_allowed;
  }
  /// Makes a peer a reference of robot a or b, or not any more, while the nodes run.
  bool set_reference(const std::string& robot, const std::string& peer, bool refer) {
    rprr_msgs::SetReference call;
    call.request.peer = peer;
    call.request.refer = refer ? 1 : 0;
    return ros::service::call("/" + robot + "_exchange/set_reference", call) &&
           call.response.success != 0;
  }
  /// After a disturbance the first exchange may end early: robots tell each other their cameras
  /// again.
  bool service_is_back() {
    for (int attempt = 0; attempt < 3; ++attempt) {
      if (exchange() && accepted()) return true;
    }
    return false;
  }
  std::string last_outcome() const {
    const ExchangeEvent* event = event_of(b_events, stamp);
    const RelativePose* pose = pose_of(stamp);
    return std::string("b: ") + (event ? "'" + event->reason + "'" : "no event") +
           ", pose: " + (pose ? "status " + std::to_string(pose->status) : "none");
  }

  /// Waits until the nodelet of that name and robot complains in words that hold all of these.
  bool complains(const std::string& node, const std::string& robot,
                 const std::vector<std::string>& words) {
    heard_.clear();
    bool found = false;
    diagnostics.listener = [&](const diagnostic_msgs::DiagnosticArray& array) {
      for (const auto& status : array.status) {
        if (status.hardware_id != robot || status.name.find(node) == std::string::npos) continue;
        if (status.level == diagnostic_msgs::DiagnosticStatus::OK) continue;
        heard_ = status.message;
        bool all = true;
        for (const std::string& word : words) {
          all = all && status.message.find(word) != std::string::npos;
        }
        found = found || all;
      }
    };
    wait([&] { return found; }, 10);
    diagnostics.listener = nullptr;
    return found;
  }
  /// Waits until the exchange of that robot shows this value on /diagnostics.
  bool shows(const std::string& robot, const std::string& key, const std::string& value) {
    bool found = false;
    diagnostics.listener = [&](const diagnostic_msgs::DiagnosticArray& array) {
      for (const auto& status : array.status) {
        if (status.hardware_id != robot) continue;
        if (status.name.find("exchange") == std::string::npos) continue;
        for (const auto& pair : status.values)
          found = found || (pair.key == key && pair.value == value);
      }
    };
    wait([&] { return found; }, 10);
    diagnostics.listener = nullptr;
    return found;
  }

  static inline int tests = 0;
  Pose truth = kTruth;
  double metres_allowed = 0.01;
  double degrees_allowed = 0.3;
  ros::NodeHandle nh;
  CameraOfRobot a{nh, "eyebug_a", Pose::Identity()};
  CameraOfRobot b{nh, "eyebug_b", kTruth};
  Inbox<RelativePose> poses{nh, "/eyebug_a/rprr/relative_pose"};
  Inbox<ExchangeEvent> a_events{nh, "/eyebug_a/rprr/exchange"};
  Inbox<ExchangeEvent> b_events{nh, "/eyebug_b/rprr/exchange"};
  Inbox<SamplePoints> a_samples{nh, "/eyebug_a/rprr/samples"};
  Inbox<SamplePoints> b_samples{nh, "/eyebug_b/rprr/samples"};
  Inbox<PoseUpdate> a_updates{nh, "/eyebug_a/rprr/update"};
  Inbox<PoseUpdate> b_updates{nh, "/eyebug_b/rprr/update"};
  Inbox<diagnostic_msgs::DiagnosticArray> diagnostics{nh, "/diagnostics"};
  ros::Publisher radio_a_samples = nh.advertise<SamplePoints>("/eyebug_a/rprr/samples", 100);
  ros::Publisher radio_b_samples = nh.advertise<SamplePoints>("/eyebug_b/rprr/samples", 100);
  ros::Publisher radio_a_update = nh.advertise<PoseUpdate>("/eyebug_a/rprr/update", 100);
  ros::Publisher radio_b_update = nh.advertise<PoseUpdate>("/eyebug_b/rprr/update", 100);
  ros::Publisher radio_pose = nh.advertise<RelativePose>("/eyebug_a/rprr/relative_pose", 100);
  ros::Time stamp;
  std::string heard_;  // the last complaint
};

/// An attacker in radio range: answers each message that a robot sends with broken copies of it,
/// some with checksums that fit.
class Attacker {
 public:
  template <typename Message>
  void answer(Inbox<Message>& inbox, ros::Publisher& radio) {
    inbox.listener = [this, &radio](const Message& real) {
      Message copy = real;
      for (int kind = 0; kind < 4; ++kind) {
        copy.data = real.data;
        spoil(copy.data, kind);
        radio.publish(copy);
      }
    };
  }
  void spoil(Bytes& data, int kind) {
    if (data.size() < 8) return;
    switch (kind) {
      case 0:  // noise
        for (std::uint8_t& byte : data) byte = static_cast<std::uint8_t>(random_());
        break;
      case 1:
        data.resize(random_() % data.size());
        break;
      case 2:  // a few wrong bytes, sealed again
        data.resize(data.size() - 4);
        for (int i = 0; i < 3; ++i) data[random_() % data.size()] = byte();
        seal(data);
        break;
      default:  // cut off, or grown, and sealed again
        data.resize(random_() % (2 * data.size()));
        seal(data);
        break;
    }
  }
  std::uint8_t byte() { return static_cast<std::uint8_t>(random_()); }

 private:
  std::mt19937 random_{11};
};

}  // namespace rprr
