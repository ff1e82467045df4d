// SPDX-License-Identifier: BSD-3-Clause
#include "pose_broadcaster.hpp"

#include <gtest/gtest.h>

#include <string>

namespace rprr {
namespace {

class RootOf : public testing::Test {
 protected:
  void link(const std::string& parent, const std::string& child) {
    geometry_msgs::TransformStamped link;
    link.header.frame_id = parent;
    link.header.stamp = ros::Time(1.0);
    link.child_frame_id = child;
    link.transform.rotation.w = 1.0;
    EXPECT_TRUE(buffer_.setTransform(link, "test"));
  }
  std::string root() const { return root_of(buffer_, "b_optical", "a_optical"); }

  tf2::BufferCore buffer_;
};

TEST_F(RootOf, IsTheFrameItselfWithoutTf) {
  EXPECT_EQ(root(), "b_optical");
}

TEST_F(RootOf, IsAboveEverything) {
  link("b_odom", "b_base");
  link("b_base", "b_optical");
  EXPECT_EQ(root(), "b_odom");
}

// Otherwise a's own root would be hung under a: a loop.
TEST_F(RootOf, StaysTheSameOnceItHangsUnderTheOtherRobot) {
  link("b_odom", "b_optical");
  link("a_odom", "a_optical");
  link("a_optical", "b_odom");
  EXPECT_EQ(root(), "b_odom");
}

TEST_F(RootOf, EndsInALoop) {
  link("b_base", "b_optical");
  link("b_odom", "b_base");
  link("b_base", "b_odom");
  EXPECT_NE(root(), "a_optical");
}

}  // namespace
}  // namespace rprr
