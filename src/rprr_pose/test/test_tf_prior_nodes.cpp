// SPDX-License-Identifier: BSD-3-Clause
// tf between two robots as a first guess. The nodes are started by tf_prior.test; tests are in the
// order in which tf comes to know more, since the nodes do not forget tf.
#include <gtest/gtest.h>
#include <ros/ros.h>
#include <tf2_ros/static_transform_broadcaster.h>

#include "preview_bench.hpp"

namespace rprr {
namespace {

class TfPriorNodes : public PreviewNodes {
 protected:
  /// The pose of a robot's camera in the map, as its own localisation would say.
  void localise(const std::string& robot, const Pose& camera_in_map) {
    geometry_msgs::TransformStamped message;
    message.header.stamp = stamp;
    message.header.frame_id = "map";
    message.child_frame_id = optical_frame(robot);
    const Eigen::Quaterniond q(camera_in_map.linear());
    message.transform.translation.x = camera_in_map.translation().x();
    message.transform.translation.y = camera_in_map.translation().y();
    message.transform.translation.z = camera_in_map.translation().z();
    message.transform.rotation.x = q.x();
    message.transform.rotation.y = q.y();
    message.transform.rotation.z = q.z();
    message.transform.rotation.w = q.w();
    broadcaster().sendTransform(message);
    wait([] { return false; }, 0.5);  // for tf to arrive at the nodes, which say nothing of it
  }
  // One for all tests: /tf_static is latched by publisher.
  static tf2_ros::StaticTransformBroadcaster& broadcaster() {
    static tf2_ros::StaticTransformBroadcaster instance;
    return instance;
  }
  /// A pose that is neither near the identity nor near the last one.
  void put_b(const Pose& b_from_a) {
    truth = b_from_a;
    moved = std::make_unique<CameraOfRobot>(nh, "eyebug_b", b_from_a);
    ASSERT_TRUE(wait([this] { return moved->connected(); }));
  }
  bool exchange_moved() {
    next_stamp();
    moved->show(stamp);
    a.show(stamp);
    return wait([this] { return event_of(b_events, stamp) && pose_of(stamp); });
  }

  std::unique_ptr<CameraOfRobot> moved;
};

const Pose kMap = test_motion(3.0, 50.0);  // a's camera in the map
const Pose kFirst = test_motion(0.25, 15.0);
const Pose kSecond = test_motion(0.2, -12.0);

TEST_F(TfPriorNodes, WithoutTfASearchIsNeededAndTheMissingFrameIsNamed) {
  put_b(kFirst);
  ASSERT_TRUE(exchange_moved()) << last_outcome();
  EXPECT_TRUE(accepted()) << last_outcome();
  EXPECT_FALSE(was_warm());
  EXPECT_TRUE(complains("exchange", "eyebug_a", {"tf_prior_fixed_frame", "map"})) << heard_;
}

TEST_F(TfPriorNodes, ATreeAboveBothSavesTheSearch) {
  ASSERT_TRUE(exchange_elsewhere());
  put_b(kSecond);
  const Pose tf_is_rough = test_motion(0.02, 1.0);
  localise("eyebug_a", kMap);
  localise("eyebug_b", kMap * (tf_is_rough * kSecond).inverse());
  ASSERT_TRUE(exchange_moved()) << last_outcome();
  EXPECT_TRUE(accepted()) << last_outcome();
  EXPECT_TRUE(was_warm());
}

TEST_F(TfPriorNodes, ALostRobotsTfDoesNoHarm) {
  ASSERT_TRUE(exchange_elsewhere());
  put_b(kFirst);
  localise("eyebug_b", kMap * test_motion(4.0, 170.0));
  ASSERT_TRUE(exchange_moved()) << last_outcome();
  EXPECT_TRUE(accepted()) << last_outcome();
  EXPECT_FALSE(was_warm());
}

}  // namespace
}  // namespace rprr

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "test_tf_prior_nodes");
  return RUN_ALL_TESTS();
}
