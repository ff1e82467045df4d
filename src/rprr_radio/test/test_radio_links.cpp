// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_radio_ros/radio_links.hpp"

#include <gtest/gtest.h>
#include <ros/network.h>
#include <ros/ros.h>
#include <sensor_msgs/CameraInfo.h>

#include <functional>
#include <map>
#include <memory>
#include <string>

namespace rprr {
namespace {

bool spin_until(const std::function<bool()>& condition) {
  const ros::WallTime end = ros::WallTime::now() + ros::WallDuration(20.0);
  while (!condition() && ros::WallTime::now() < end) {
    ros::spinOnce();
    ros::WallDuration(0.01).sleep();
  }
  return condition();
}

// Two nodes of this host talk, and this process talks to itself.
class RadioLinksTest : public testing::Test {
 protected:
  void SetUp() override {
    publisher_ = nh_.advertise<sensor_msgs::CameraInfo>("/talk", 10);
    subscriber_ = nh_.subscribe<sensor_msgs::CameraInfo>(
        "/talk", 10,
        [this](const sensor_msgs::CameraInfoConstPtr& message) { ++heard_[message->width]; });
    ASSERT_TRUE(hears_all()) << "the talkers did not come up";
  }

  bool hears_all() {
    heard_.clear();
    return spin_until([this] {
      sensor_msgs::CameraInfo own;
      own.width = 3;
      publisher_.publish(own);
      return heard_[1] > 0 && heard_[2] > 0 && heard_[3] > 0;
    });
  }

  ros::NodeHandle nh_;
  ros::Publisher publisher_;
  ros::Subscriber subscriber_;
  std::map<unsigned, int> heard_;
};

std::string host_of_this_node() {
  return ros::network::getHost();
}

TEST_F(RadioLinksTest, RenewedSubscriptionsAreHeardAgain) {
  std::string host = host_of_this_node();
  if (host == "localhost") host = "127.0.0.1";
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(renew_subscriptions(host, {"/talk"}), 1U);
    EXPECT_TRUE(hears_all()) << "of talkers 1, 2 and this process heard " << heard_[1] << ", "
                             << heard_[2] << ", " << heard_[3];
    EXPECT_EQ(subscriber_.getNumPublishers(), 3U);
  }
}

TEST_F(RadioLinksTest, OtherHostsAreLeftAlone) {
  EXPECT_EQ(renew_subscriptions("192.0.2.1", {"/talk"}), 0U);
  EXPECT_EQ(renew_subscriptions("", {"/talk"}), 0U);
  EXPECT_TRUE(hears_all());
}

TEST_F(RadioLinksTest, TopicsOfOthersAreLeftAlone) {
  std::string host = host_of_this_node();
  if (host == "localhost") host = "127.0.0.1";
  EXPECT_EQ(renew_subscriptions(host, {}), 0U);
  EXPECT_EQ(renew_subscriptions(host, {"/another", "/talk/more"}), 0U);
  EXPECT_TRUE(hears_all());
}

TEST_F(RadioLinksTest, AProcessHasOne) {
  const std::shared_ptr<RadioLinks> links = RadioLinks::look_after({"/talk"});
  EXPECT_EQ(links, RadioLinks::look_after({"/another"}));
  EXPECT_EQ(links->state().renewed, 0U);
  EXPECT_TRUE(links->state().unanswered_for.empty()) << "this host is not across a radio";
}

}  // namespace
}  // namespace rprr

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "test_radio_links");
  const ros::NodeHandle nh;
  return RUN_ALL_TESTS();
}
