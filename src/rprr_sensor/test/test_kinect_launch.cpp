// SPDX-License-Identifier: BSD-3-Clause
#include <diagnostic_msgs/DiagnosticArray.h>
#include <gtest/gtest.h>
#include <ros/ros.h>

#include <map>

#include "camera_topics.hpp"
#include "child_process.hpp"

namespace rprr {
namespace {

class KinectLaunchTest : public testing::Test {
 protected:
  void SetUp() override {
    diagnostics_ = nh_.subscribe("/diagnostics", 100, &KinectLaunchTest::on_diagnostics, this);
  }
  void on_diagnostics(const diagnostic_msgs::DiagnosticArray& array) {
    for (const auto& status : array.status) messages_[status.hardware_id] = status.message;
  }
  bool says(const std::string& robot, const std::string& text) {
    return spin_until([&] { return messages_[robot].find(text) != std::string::npos; });
  }

  ros::NodeHandle nh_;
  ros::Subscriber diagnostics_;
  std::map<std::string, std::string> messages_;  // by robot
};

TEST_F(KinectLaunchTest, MissingCamerasAreNamedForEachDriver) {
  EXPECT_TRUE(says("first", "libfreenect: ")) << messages_["first"];
  EXPECT_TRUE(says("second", "/no/such/file.oni")) << messages_["second"];
  EXPECT_TRUE(says("third", "nobody publishes /camera/other_depth")) << messages_["third"];
}

TEST_F(KinectLaunchTest, TopicsOfAnotherDriverArePassedOnAsTheyAre) {
  CameraTopics topics;
  topics.listen(nh_, "third");
  const auto colour = nh_.advertise<sensor_msgs::Image>("/camera/rgb/image_rect_color", 5);
  const auto info = nh_.advertise<sensor_msgs::CameraInfo>("/camera/rgb/camera_info", 5);
  const auto depth = nh_.advertise<sensor_msgs::Image>("/camera/other_depth", 5);
  sensor_msgs::Image image;
  image.header.frame_id = "camera_rgb_optical_frame";
  image.encoding = "16UC1";
  sensor_msgs::CameraInfo camera;
  int sent = 0;
  ASSERT_TRUE(spin_until([&] {
    image.header.stamp = ros::Time(10 + ++sent);
    camera.header = image.header;
    colour.publish(image);
    depth.publish(image);
    info.publish(camera);
    return topics.frames() >= 3;
  }));
  EXPECT_EQ(topics.depth.begin()->second.encoding, "16UC1");
  EXPECT_EQ(topics.colour.begin()->second.header.frame_id, "camera_rgb_optical_frame");
}

}  // namespace
}  // namespace rprr

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "test_kinect_launch");
  return RUN_ALL_TESTS();
}
