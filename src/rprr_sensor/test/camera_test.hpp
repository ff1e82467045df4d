// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <diagnostic_msgs/DiagnosticArray.h>
#include <gtest/gtest.h>
#include <ros/ros.h>
#include <std_srvs/SetBool.h>
#include <std_srvs/Trigger.h>
#include <algorithm>

#include <algorithm>
#include <opencv2/core.hpp>
#include <string>

#include "camera_topics.hpp"
#include "child_process.hpp"
#include "rprr_ros/camera_info.hpp"
#include "rprr_ros/conversions.hpp"
#include "rprr_synthetic/temporary_folder.hpp"
#include "synthetic_kinect.hpp"

namespace rprr {

/// What the tests of the camera nodelets have in common: robot eyebug_a's topics, diagnostics of
/// the node "camera" and its services.
class CameraTest : public testing::Test {
 protected:
  static void SetUpTestSuite() { kinect_ = new SyntheticKinect(); }
  static void TearDownTestSuite() {
    delete kinect_;
    kinect_ = nullptr;
  }
  void SetUp() override {
    topics_.listen(nh_, "eyebug_a");
    diagnostics_ = nh_.subscribe("/diagnostics", 100, &CameraTest::on_diagnostics, this);
  }
  void on_diagnostics(const diagnostic_msgs::DiagnosticArray& array) {
    for (const auto& status : array.status) {
      if (status.name.find("camera") == std::string::npos) continue;
      level_ = status.level;
      message_ = status.message;
      for (const auto& value : status.values) values_[value.key] = value.value;
    }
  }

  /// For a node's environment: a home of the test's own, where calibrations are kept.
  std::string home() const { return "ROS_HOME=" + temporary_.path("home"); }
  /// Likewise, with a folder's libraries in place of the system's.
  std::string home_and_libraries(const std::string& folder) const {
    return "LD_LIBRARY_PATH=" + folder + ":$LD_LIBRARY_PATH " + home();
  }

  bool wait_for_frames(std::size_t count, double seconds = 20.0) {
    return spin_until([&] { return topics_.frames() >= count; }, seconds);
  }
  bool wait_for_message(const std::string& text, double seconds = 20.0) {
    return spin_until([&] { return message_.find(text) != std::string::npos; }, seconds);
  }

  /// Images, depth above all, are what the synthetic Kinect saw.
  void check_against_truth(double least_coverage) {
    // The first frame may have come before all three topics were connected.
    const auto frame =
        std::find_if(topics_.depth.begin(), topics_.depth.end(), [this](const auto& depth) {
          return topics_.colour.count(depth.first) && topics_.info.count(depth.first);
        });
    ASSERT_NE(frame, topics_.depth.end()) << "colour, depth and camera_info have one stamp";
    const auto& [stamp, depth] = *frame;
    EXPECT_EQ(depth.encoding, "16UC1");
    EXPECT_EQ(depth.header.frame_id, "eyebug_a_rgb_optical_frame");
    const auto counts = depth_from_image(depth, {});
    ASSERT_TRUE(counts) << counts.reason();
    const DepthAgreement found = compare_depth(counts->counts, kinect_->truth);
    EXPECT_GT(found.coverage, least_coverage);
    EXPECT_GT(found.near, 0.95) << "share of depth within the sensor's steps of the truth";
    const auto bgr = bgr_from_image(topics_.colour.at(stamp));
    ASSERT_TRUE(bgr) << bgr.reason();
    EXPECT_EQ(cv::norm(*bgr, kinect_->bgr, cv::NORM_INF), 0.0) << "colour, blue first";
    const auto camera = camera_from_info(topics_.info.at(stamp));
    ASSERT_TRUE(camera) << camera.reason();
    EXPECT_EQ(camera->width, 640);
  }

  /// The node has no camera: it says so, naming the library, gives no images, and runs on.
  void check_no_camera(ChildProcess& camera, const std::string& library) {
    EXPECT_TRUE(wait_for_message(library + ": ")) << message_;
    EXPECT_EQ(level_, diagnostic_msgs::DiagnosticStatus::ERROR);
    EXPECT_NE(trigger(), "") << "no camera runs";
    EXPECT_TRUE(camera.runs());
  }

  bool pause(bool paused) {
    std_srvs::SetBool call;
    call.request.data = static_cast<unsigned char>(paused);
    return ros::service::waitForService("/camera/pause", 20000) &&
           ros::service::call("/camera/pause", call) && call.response.success != 0;
  }
  /// The answer's text where it was refused, empty where it was not.
  std::string trigger() {
    std_srvs::Trigger call;
    if (!ros::service::waitForService("/camera/trigger", 20000) ||
        !ros::service::call("/camera/trigger", call)) {
      return "no answer";
    }
    return call.response.success != 0 ? "" : call.response.message;
  }

  static SyntheticKinect* kinect_;  // takes a second to render
  ros::NodeHandle nh_;
  TemporaryFolder temporary_;
  CameraTopics topics_;
  ros::Subscriber diagnostics_;
  int level_ = -1;
  std::string message_;
  std::map<std::string, std::string> values_;
};

inline SyntheticKinect* CameraTest::kinect_ = nullptr;

}  // namespace rprr
