// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/ros.h>

#include <cstdint>
#include <limits>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "pair_topics.hpp"
#include "rprr_codec/encoded_frame.hpp"
#include "rprr_pose_ros/pose_seal.hpp"
#include "rprr_wire/bytes.hpp"

namespace rprr {

/// An attacker in range of the radio: answers whatever robots and station send with broken copies
/// of it, some of which carry checksums that fit.
class RadioAttacker {
 public:
  RadioAttacker(ros::NodeHandle& nh, PairTopics& topics) : topics_(topics) {
    topics.each_on_the_radio([&](auto& inbox) { answer(nh, inbox); });
  }
  ~RadioAttacker() {
    topics_.each_on_the_radio([](auto& inbox) { inbox.listener = nullptr; });
  }
  RadioAttacker(const RadioAttacker&) = delete;
  RadioAttacker& operator=(const RadioAttacker&) = delete;

  bool connected() const {
    for (const ros::Publisher& publisher : publishers_) {
      const bool needs_a_listener = publisher.getTopic() != "/station/receipts";
      if (needs_a_listener && publisher.getNumSubscribers() < 2) return false;  // one is the test
    }
    return true;
  }
  /// Answers on that topic only; on all topics if it is empty.
  void attack(const std::string& topic) { target_ = topic; }
  int sent_on(const std::string& topic) const {
    const auto found = sent_.find(topic);
    return found == sent_.end() ? 0 : found->second;
  }

 private:
  static constexpr int kKinds = 5;

  template <typename Message>
  void answer(ros::NodeHandle& nh, Inbox<Message>& inbox) {
    publishers_.push_back(nh.advertise<Message>(inbox.topic, 100));
    const std::size_t radio = publishers_.size() - 1;
    inbox.listener = [this, radio, topic = inbox.topic](const Message& real) {
      if (!target_.empty() && topic != target_) return;
      for (int kind = 0; kind < kKinds; ++kind) {
        Message copy = real;
        spoil(copy, kind);
        publishers_[radio].publish(copy);
        ++sent_[topic];
      }
    };
  }

  template <typename Message>
  void spoil(Message& message, int kind) {
    spoil(message.data, kind);
  }
  void spoil(rprr_msgs::EncodedFrame& message, int kind) {
    if (kind == 4) return spoil_colour(message.data);
    spoil(message.data, kind);
  }
  void spoil(rprr_msgs::RelativePose& message, int kind) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    spoil(message.reference_camera, kind);
    switch (kind) {
      case 0:
        message.translation[0] = nan;
        break;
      case 1:
        message.rotation.assign(0.0);
        break;
      case 2:
        message.status = byte();
        message.quantity = byte();
        message.measured = std::numeric_limits<float>::quiet_NaN();
        message.needed = std::numeric_limits<float>::infinity();
        break;
      case 3:
        message.exchange += 1;
        break;
      default:
        message.covariance.assign(std::numeric_limits<float>::infinity());
        break;
    }
    if (kind != 3) message.checksum = checksum_of(message);
  }
  void spoil(rprr_msgs::Receipt& message, int kind) {
    message.robot = kind == 0 ? std::string(1000, '/') : message.robot;
    message.held.assign(static_cast<std::size_t>(kind) * 500, ros::Time(1, 999999999));
    message.repeat.assign(static_cast<std::size_t>(kind) * 500, ros::Time(4000000000u, 5));
  }
  void spoil(Bytes& data, int kind) {
    if (data.size() < 8) return;
    switch (kind) {
      case 0:  // noise
        for (std::uint8_t& one : data) one = byte();
        break;
      case 1:  // cut off
        data.resize(random_() % data.size());
        break;
      case 2:  // a few wrong bytes
        for (int i = 0; i < 3; ++i) data[random_() % data.size()] = byte();
        break;
      case 3:  // a few wrong bytes, sealed again
        data.resize(data.size() - 4);
        for (int i = 0; i < 3; ++i) data[random_() % data.size()] = byte();
        seal(data);
        break;
      default:  // cut off or grown, sealed again
        data.resize(random_() % (2 * data.size()));
        seal(data);
        break;
    }
  }
  // A container that is in order around a colour payload that is not.
  static_assert(kKinds == 5, "the last kind is for containers");
  void spoil_colour(Bytes& data) {
    auto frame = parse_encoded_frame(data);
    if (!frame || frame->colour.size() < 100) return;
    Bytes& colour = frame->colour;
    colour.resize(colour.size() - 4);
    for (int i = 0; i < 20; ++i) colour[40 + random_() % (colour.size() - 40)] = byte();
    seal(colour);
    data = serialise(*frame);
  }
  std::uint8_t byte() { return static_cast<std::uint8_t>(random_()); }

  PairTopics& topics_;
  std::vector<ros::Publisher> publishers_;
  std::string target_;
  std::map<std::string, int> sent_;  // by topic
  std::mt19937 random_{23};
};

}  // namespace rprr
