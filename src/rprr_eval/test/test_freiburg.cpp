// SPDX-License-Identifier: BSD-3-Clause
// launch/freiburg.launch on a bag of the TUM benchmark's shape: their topics, depth in metres,
// frames with slashes. The bag is made here by folder_to_bag, from a synthetic folder.
#include <gtest/gtest.h>
#include <ros/ros.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>

#include <cstdlib>
#include <opencv2/core.hpp>

#include "launch_process.hpp"
#include "pair_topics.hpp"
#include "rprr_eval/measure/metrics.hpp"
#include "rprr_geometry/relative_pose.hpp"
#include "rprr_ros/conversions.hpp"
#include "rprr_synthetic/temporary_folder.hpp"
#include "rprr_view/provenance.hpp"
#include "synthetic_walk.hpp"

namespace rprr {
namespace {

constexpr double kUnit = 0.0002;  // metres per count, as the benchmark has it
const std::vector<int> kWalk = {0, 1, 2, 3};

/// The frame of the walk in the benchmark's depth unit.
WalkFrame tum_frame(int number) {
  WalkFrame frame = walk_frame(number);
  DepthFrame& depth = frame.image.depth;
  const double ratio = depth.unit / kUnit;
  depth.counts = depth.counts * ratio;  // 5 m are 25000 counts
  depth.unit = kUnit;
  return frame;
}

std::string make_bag(const TemporaryFolder& files) {
  const Camera camera = example_sensor_a(320, 240).camera;
  auto writer = TumWriter::create(files.path("walk"), camera, kUnit, true, "a test's walk");
  EXPECT_TRUE(writer) << writer.reason();
  for (std::size_t k = 0; writer && k < kWalk.size(); ++k) {
    const WalkFrame frame = tum_frame(kWalk[k]);
    const auto added = writer->add(from_seconds(1.0 + static_cast<double>(k)), frame.image,
                                   frame.world_from_camera);
    EXPECT_TRUE(added) << added.reason();
  }
  const std::string bag = files.path("walk.bag");
  const std::string command =
      "rosrun rprr_sensor folder_to_bag " + files.path("walk") + " " + bag + " --shape tum";
  EXPECT_EQ(std::system((command + " 2>/dev/null").c_str()), 0) << command;
  return bag;
}

/// The bag is what the benchmark's bags are, or the test shows nothing.
void check_shape(const std::string& path) {
  rosbag::Bag bag(path);
  std::set<std::string> topics;
  for (const rosbag::MessageInstance& message : rosbag::View(bag)) {
    topics.insert(message.getTopic());
    const auto image = message.instantiate<sensor_msgs::Image>();
    if (!image) continue;
    EXPECT_EQ(image->header.frame_id, "/openni_rgb_optical_frame");
    const bool depth = message.getTopic() == "/camera/depth/image";
    EXPECT_EQ(image->encoding, depth ? "32FC1" : "bgr8");
  }
  for (const char* topic :
       {"/camera/rgb/image_color", "/camera/rgb/camera_info", "/camera/depth/image", "/tf"}) {
    EXPECT_TRUE(topics.count(topic)) << topic;
  }
}

TEST(Freiburg, BagOfTheBenchmarksShapeIsPlayedAsTwoRobots) {
  const TemporaryFolder files;
  const std::string bag = make_bag(files);
  check_shape(bag);
  ros::NodeHandle nh;
  PairTopics topics(nh, "eyebug_a", "eyebug_b", true);
  Inbox<sensor_msgs::Image> played(nh, "/eyebug_b/camera/depth_registered/image_rect");
  const Launch launch(ros::param::param<std::string>("~launch_file", "") + " bag:=" + bag +
                      " step:=1 rate:=0");
  const auto answers = [&] {
    std::size_t count = 0;
    for (const auto& s : topics.statistics.messages) count += s->robot == "eyebug_b" ? 1 : 0;
    return count;
  };
  ASSERT_TRUE(wait_for([&] { return answers() == kWalk.size() - 1; }, 120))
      << answers() << " frames of b came";
  ASSERT_EQ(played.messages.size(), kWalk.size() - 1);
  wait_for([&] { return topics.rebuilt(played.messages.back()->header.stamp); }, 10);

  int accepted = 0;
  std::string reasons;
  for (std::size_t k = 0; k + 1 < kWalk.size(); ++k) {
    SCOPED_TRACE("pair " + std::to_string(k));
    const sensor_msgs::Image& own = *played.messages[k];
    const ros::Time stamp = own.header.stamp;
    EXPECT_EQ(own.header.frame_id, "eyebug_b_rgb_optical_frame");
    EXPECT_EQ(own.encoding, "32FC1");
    ASSERT_TRUE(topics.rebuilt(stamp));
    const auto truth = depth_from_image(own, {0.001, kUnit});
    ASSERT_TRUE(truth) << truth.reason();
    EXPECT_EQ(cv::norm(truth->counts, tum_frame(kWalk[k + 1]).image.depth.counts, cv::NORM_INF), 0)
        << "counts lost on the way through the bag";
    EXPECT_EQ(topics.depth.at(stamp)->encoding, "32FC1") << "16UC1 would round";
    const auto rebuilt = depth_from_image(*topics.depth.at(stamp), {0.001, kUnit});
    ASSERT_TRUE(rebuilt) << rebuilt.reason();
    const sensor_msgs::Image& provenance = *topics.provenance.at(stamp);
    int received = 0;
    int wrong = 0;
    for (int v = 0; v < truth->height(); ++v) {
      for (int u = 0; u < truth->width(); ++u) {
        const std::size_t at =
            static_cast<std::size_t>(v) * provenance.step + static_cast<std::size_t>(u);
        if (provenance.data[at] != kReceived) continue;
        ++received;
        if (rebuilt->counts.at<std::uint16_t>(v, u) != truth->counts.at<std::uint16_t>(v, u)) {
          ++wrong;
        }
      }
    }
    EXPECT_GT(received, 0);
    EXPECT_EQ(wrong, 0) << "received depth is not bit-exact";
    if (!topics.accepted(stamp)) {
      reasons += " '" + topics.b_event.at(stamp)->reason + "'";
      continue;
    }
    ++accepted;
    EXPECT_EQ(topics.depth.at(stamp)->header.frame_id, "eyebug_b_rprr_optical_frame");
    const auto& pose = *topics.pose.at(stamp);
    EXPECT_EQ(pose.header.frame_id, "eyebug_a_rgb_optical_frame") << "frames are cleaned";
    const Pose b_from_a = relative_pose_of(walk_frame(kWalk[k]).world_from_camera,
                                           walk_frame(kWalk[k + 1]).world_from_camera);
    const PoseError error = pose_error(pose_from_fields(pose.translation, pose.rotation), b_from_a);
    EXPECT_LT(error.metres, 0.04);
    EXPECT_LT(error.degrees, 1.5);
  }
  EXPECT_GE(accepted, 1) << "of " << kWalk.size() - 1 << " pairs, the others whole because"
                         << reasons;
}

}  // namespace
}  // namespace rprr

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "test_freiburg");
  return RUN_ALL_TESTS();
}
