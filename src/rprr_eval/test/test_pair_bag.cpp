// SPDX-License-Identifier: BSD-3-Clause
// launch/pair.launch on a bag of two robots, one of which has other topics in it.
#include <gtest/gtest.h>
#include <ros/ros.h>

#include <cstdlib>

#include "launch_process.hpp"
#include "pair_topics.hpp"
#include "rprr_synthetic/temporary_folder.hpp"

namespace rprr {
namespace {

TEST(PairBag, BagOfTwoRobotsIsPlayedUnderTheirNames) {
  const TemporaryFolder files;
  const std::string bag = files.path("two.bag");
  const std::string make = "rosrun rprr_sensor synthetic_to_bag " + bag +
                           " --frames 3 --width 320 --height 240 --a left --rate 0.5";
  ASSERT_EQ(std::system((make + " 2>/dev/null").c_str()), 0) << make;
  ros::NodeHandle nh;
  PairTopics topics(nh, "eyebug_a", "eyebug_b", true);
  Inbox<sensor_msgs::Image> a(nh, "/eyebug_a/camera/depth_registered/image_rect");
  Inbox<sensor_msgs::Image> b(nh, "/eyebug_b/camera/depth_registered/image_rect");
  const Launch launch(ros::param::param<std::string>("~launch_file", "") + " bag:=" + bag +
                      " a_rgb:=/left/camera/rgb/image_rect_color"
                      " a_info:=/left/camera/rgb/camera_info"
                      " a_depth:=/left/camera/depth_registered/image_rect");
  const auto answers = [&] {
    std::size_t count = 0;
    for (const auto& s : topics.statistics.messages) count += s->robot == "eyebug_b" ? 1 : 0;
    return count;
  };
  EXPECT_TRUE(wait_for([&] { return a.messages.size() == 3 && b.messages.size() == 3; }, 120))
      << a.messages.size() << " and " << b.messages.size() << " of 3 frames were played";
  EXPECT_TRUE(wait_for([&] { return answers() >= 2; }, 60))
      << answers() << " frames of b came to the station";
  bool simulated = false;
  EXPECT_TRUE(ros::param::get("/use_sim_time", simulated) && simulated);
}

}  // namespace
}  // namespace rprr

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "test_pair_bag");
  return RUN_ALL_TESTS();
}
