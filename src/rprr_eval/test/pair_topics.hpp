// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <diagnostic_msgs/DiagnosticArray.h>
#include <ros/ros.h>
#include <rprr_msgs/BlockMask.h>
#include <rprr_msgs/BlockPreview.h>
#include <rprr_msgs/EncodedFrame.h>
#include <rprr_msgs/ExchangeEvent.h>
#include <rprr_msgs/PairStatistics.h>
#include <rprr_msgs/PoseUpdate.h>
#include <rprr_msgs/Receipt.h>
#include <rprr_msgs/RelativePose.h>
#include <rprr_msgs/SamplePoints.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/PointCloud2.h>

#include <functional>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace rprr {

inline bool wait_for(const std::function<bool()>& condition, double seconds) {
  const ros::WallTime end = ros::WallTime::now() + ros::WallDuration(seconds);
  while (ros::ok() && ros::WallTime::now() < end) {
    ros::spinOnce();
    if (condition()) return true;
    ros::WallDuration(0.005).sleep();
  }
  return false;
}

template <typename T>
ros::Time stamp_of(const T& message) {
  return message.header.stamp;
}
inline ros::Time stamp_of(const rprr_msgs::ExchangeEvent& event) {
  return event.frame.header.stamp;
}

/// What others publish on a topic; what this test publishes there itself is left out.
template <typename T>
class Inbox {
 public:
  Inbox(ros::NodeHandle& nh, const std::string& topic)
      : topic(topic), subscriber_(nh.subscribe(topic, 100, &Inbox::receive, this)) {}

  const std::string topic;
  std::vector<typename T::ConstPtr> messages;
  std::function<void(const T&)> listener;

  bool connected() const { return subscriber_.getNumPublishers() > 0; }
  typename T::ConstPtr at(const ros::Time& stamp) const {
    for (const auto& message : messages) {
      if (stamp_of(*message) == stamp) return message;
    }
    return nullptr;
  }

 private:
  void receive(const ros::MessageEvent<T const>& event) {
    if (event.getPublisherName() == ros::this_node::getName()) return;
    messages.push_back(event.getConstMessage());
    if (listener) listener(*event.getConstMessage());
  }
  ros::Subscriber subscriber_;
};

/// Every topic that the nodelets of a pair and its station speak on.
struct PairTopics {
  /// previews: whether the robots speak the protocol of previews or that of samples.
  PairTopics(ros::NodeHandle& nh, const std::string& a, const std::string& b, bool previews)
      : preview(nh, "/" + b + "/rprr/preview"),
        a_samples(nh, "/" + a + "/rprr/samples"),
        b_samples(nh, "/" + b + "/rprr/samples"),
        a_update(nh, "/" + a + "/rprr/update"),
        b_update(nh, "/" + b + "/rprr/update"),
        pose(nh, "/" + a + "/rprr/relative_pose"),
        prediction(nh, "/" + a + "/rprr/prediction"),
        a_encoded(nh, "/" + a + "/rprr/encoded"),
        b_encoded(nh, "/" + b + "/rprr/encoded"),
        receipts(nh, "/station/receipts"),
        a_event(nh, "/" + a + "/rprr/exchange"),
        b_event(nh, "/" + b + "/rprr/exchange"),
        sparse_rgb(nh, "/" + b + "/rprr/sparse/rgb"),
        sparse_depth(nh, "/" + b + "/rprr/sparse/depth"),
        mask(nh, "/" + b + "/rprr/mask"),
        validation(nh, "/" + b + "/rprr/validation"),
        rgb(nh, "/station/" + b + "/rgb/image_rect_color"),
        info(nh, "/station/" + b + "/rgb/camera_info"),
        depth(nh, "/station/" + b + "/depth_registered/image_rect"),
        points(nh, "/station/" + b + "/points"),
        provenance(nh, "/station/" + b + "/provenance"),
        rgb_of_a(nh, "/station/" + a + "/rgb/image_rect_color"),
        depth_of_a(nh, "/station/" + a + "/depth_registered/image_rect"),
        statistics(nh, "/station/statistics"),
        diagnostics(nh, "/diagnostics"),
        previews_(previews),
        a_(a),
        b_(b) {}

  /// Calls action with each inbox.
  template <typename Action>
  void each(const Action& action) const {
    each_on_the_radio(action);
    action(a_event), action(b_event), action(sparse_rgb), action(sparse_depth), action(mask);
    action(validation), action(rgb), action(info), action(depth), action(points);
    action(provenance), action(rgb_of_a), action(depth_of_a), action(statistics);
    action(diagnostics);
  }
  template <typename Action>
  void each_on_the_radio(const Action& action) const {
    const_cast<PairTopics*>(this)->each_on_the_radio([&](const auto& inbox) { action(inbox); });
  }
  template <typename Action>
  void each_on_the_radio(const Action& action) {
    if (previews_) {
      action(preview);
    } else {
      action(a_samples), action(b_samples), action(a_update), action(b_update);
    }
    action(pose), action(prediction), action(a_encoded), action(b_encoded), action(receipts);
  }
  /// Topics that nobody publishes, or on which nothing came.
  std::vector<std::string> not_advertised() const {
    std::vector<std::string> topics;
    each([&](const auto& inbox) {
      if (!inbox.connected()) topics.push_back(inbox.topic);
    });
    return topics;
  }
  std::vector<std::string> silent() const {
    std::vector<std::string> topics;
    each([&](const auto& inbox) {
      if (inbox.messages.empty()) topics.push_back(inbox.topic);
    });
    return topics;
  }

  rprr_msgs::PairStatistics::ConstPtr statistics_of(const std::string& robot,
                                                    const ros::Time& stamp) const {
    for (const auto& message : statistics.messages) {
      if (message->robot == robot && message->header.stamp == stamp) return message;
    }
    return nullptr;
  }
  /// b's view of that stamp is complete on all topics that show it.
  bool rebuilt(const ros::Time& stamp) const {
    return statistics_of(b_, stamp) && rgb.at(stamp) && info.at(stamp) && depth.at(stamp) &&
           points.at(stamp) && provenance.at(stamp) && a_event.at(stamp) && b_event.at(stamp) &&
           pose.at(stamp) && b_encoded.at(stamp) && mask.at(stamp) && sparse_rgb.at(stamp) &&
           sparse_depth.at(stamp);
  }
  bool accepted(const ros::Time& stamp) const {
    const auto event = b_event.at(stamp);
    const auto ended = pose.at(stamp);
    return event && event->action == rprr_msgs::ExchangeEvent::SEND_SPARSE && ended &&
           ended->status == rprr_msgs::RelativePose::ACCEPTED;
  }

  using Nodelets = std::set<std::pair<std::string, std::string>>;  // robot, nodelet
  /// Whose diagnostics came among the messages from that one on.
  Nodelets alive(std::size_t first_message = 0) const {
    const Nodelets all = {{a_, "exchange"},      {a_, "redundancy"}, {a_, "encoder"},
                          {b_, "exchange"},      {b_, "redundancy"}, {b_, "encoder"},
                          {"station", "station"}};
    Nodelets heard;
    for (std::size_t i = first_message; i < diagnostics.messages.size(); ++i) {
      for (const auto& status : diagnostics.messages[i]->status) {
        for (const auto& nodelet : all) {
          const bool named = status.name.find(nodelet.second) != std::string::npos;
          if (named && status.hardware_id == nodelet.first) heard.insert(nodelet);
        }
      }
    }
    return heard;
  }
  static constexpr std::size_t kNodelets = 7;

  Inbox<rprr_msgs::BlockPreview> preview;
  Inbox<rprr_msgs::SamplePoints> a_samples, b_samples;
  Inbox<rprr_msgs::PoseUpdate> a_update, b_update;
  Inbox<rprr_msgs::RelativePose> pose;
  Inbox<rprr_msgs::BlockMask> prediction;
  Inbox<rprr_msgs::EncodedFrame> a_encoded, b_encoded;
  Inbox<rprr_msgs::Receipt> receipts;
  Inbox<rprr_msgs::ExchangeEvent> a_event, b_event;
  Inbox<sensor_msgs::Image> sparse_rgb, sparse_depth, mask;
  Inbox<rprr_msgs::BlockMask> validation;
  Inbox<sensor_msgs::Image> rgb;
  Inbox<sensor_msgs::CameraInfo> info;
  Inbox<sensor_msgs::Image> depth;
  Inbox<sensor_msgs::PointCloud2> points;
  Inbox<sensor_msgs::Image> provenance, rgb_of_a, depth_of_a;
  Inbox<rprr_msgs::PairStatistics> statistics;
  Inbox<diagnostic_msgs::DiagnosticArray> diagnostics;

 private:
  bool previews_;
  std::string a_, b_;
};

}  // namespace rprr
