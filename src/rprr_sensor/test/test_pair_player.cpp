// SPDX-License-Identifier: BSD-3-Clause
//
// Starts the player itself (~command), since its recording has to be written first.
#include <gtest/gtest.h>
#include <ros/ros.h>
#include <rprr_msgs/PairStatistics.h>
#include <std_msgs/Bool.h>
#include <std_srvs/Trigger.h>

#include <opencv2/core.hpp>

#include "camera_topics.hpp"
#include "child_process.hpp"
#include "rprr_ros/conversions.hpp"
#include "rprr_sensor/recordings/tum_writer.hpp"
#include "rprr_sensor_ros/bag_writer.hpp"
#include "rprr_synthetic/random.hpp"
#include "rprr_synthetic/temporary_folder.hpp"

namespace rprr {
namespace {

const Camera kCamera{64, 48, 60.0, 60.0, 31.5, 23.5};
constexpr int kEntries = 6;

RecordedFrame entry(int number, double unit) {
  Random random(static_cast<std::uint64_t>(number));
  RecordedFrame frame;
  frame.stamp = from_seconds(10.0 + number);
  frame.image = {cv::Mat(48, 64, CV_8UC3, cv::Scalar(number, 2 * number, 3 * number)),
                 {cv::Mat(48, 64, CV_16UC1), unit}};
  for (auto& count : cv::Mat_<std::uint16_t>(frame.image.depth.counts)) {
    count = static_cast<std::uint16_t>(random.bits());
  }
  frame.depth_stamp = frame.stamp + 15000000;
  frame.world_from_camera = Pose(Eigen::Translation3d(number, 0.5, -1.0));
  return frame;
}

/// The player as a process of its own with private parameters "_name:=value".
class Player : public ChildProcess {
 public:
  explicit Player(const std::string& parameters) : ChildProcess("pair_player", parameters) {}
};

class PairPlayerTest : public testing::Test {
 protected:
  void SetUp() override {
    a_.listen(nh_, "eyebug_a");
    b_.listen(nh_, "second");
    done_subscriber_ = nh_.subscribe("/pair_player/done", 1, &PairPlayerTest::on_done, this);
    statistics_ = nh_.advertise<rprr_msgs::PairStatistics>("/station/statistics", 10);
  }
  void on_done(const std_msgs::Bool& done) { done_ = done.data != 0 ? "yes" : "no"; }

  std::string folder(double unit) {
    auto writer = TumWriter::create(temporary_.path("walk"), kCamera, unit, true, "test");
    for (int k = 0; writer && k < kEntries; ++k) {
      const RecordedFrame frame = entry(k, unit);
      EXPECT_TRUE(writer->add(frame.stamp, frame.image, frame.world_from_camera));
    }
    return temporary_.path("walk");
  }
  std::string tum_bag() {
    auto bag = BagWriter::create(temporary_.path("walk.bag"), "none");
    for (int k = 0; bag && k < kEntries; ++k) {
      EXPECT_TRUE(bag->add(entry(k, 0.0002), kCamera, "", BagShape::tum, DepthEncoding::automatic));
    }
    EXPECT_TRUE(bag && bag->finish());
    return temporary_.path("walk.bag");
  }

  /// Each played pair is what the recording holds: a from entry `first`, b from `first` + step.
  void check(int first, int step, int pairs, double unit) const {
    ASSERT_EQ(a_.depth.size(), static_cast<std::size_t>(pairs));
    int number = first;
    for (const auto& [stamp, unused] : a_.depth) {
      check_frame(a_, stamp, number, unit, "eyebug_a_rgb_optical_frame");
      check_frame(b_, stamp, number + step, unit, "second_rgb_optical_frame");
      ++number;
    }
  }
  static void check_frame(const CameraTopics& camera, const ros::Time& stamp, int number,
                          double unit, const std::string& frame_id) {
    SCOPED_TRACE("entry " + std::to_string(number) + " as " + frame_id);
    ASSERT_TRUE(camera.depth.count(stamp) && camera.colour.count(stamp) && camera.info.count(stamp))
        << "both robots have the same stamp";
    const RecordedFrame expected = entry(number, unit);
    const auto& depth = camera.depth.at(stamp);
    EXPECT_EQ(depth.encoding, unit == 0.001 ? "16UC1" : "32FC1");
    EXPECT_EQ(depth.header.frame_id, frame_id);
    EXPECT_EQ(camera.colour.at(stamp).header.frame_id, frame_id);
    EXPECT_EQ(camera.info.at(stamp).header.frame_id, frame_id);
    const auto counts = depth_from_image(depth, {0.001, unit});
    ASSERT_TRUE(counts) << counts.reason();
    EXPECT_EQ(cv::norm(counts->counts, expected.image.depth.counts, cv::NORM_INF), 0.0)
        << "depth keeps its counts";
    EXPECT_EQ(camera.colour.at(stamp).encoding, "bgr8");
    EXPECT_EQ(camera.colour.at(stamp).data[1], 2 * number);
    EXPECT_EQ(camera.info.at(stamp).K[0], 60.0);
    ASSERT_TRUE(camera.pose.count(stamp));
    EXPECT_EQ(camera.pose.at(stamp).header.frame_id, "world");
    EXPECT_NEAR(camera.pose.at(stamp).pose.position.x, number, 1e-9);
  }

  ros::NodeHandle nh_;
  TemporaryFolder temporary_;
  CameraTopics a_;
  CameraTopics b_;
  ros::Subscriber done_subscriber_;
  ros::Publisher statistics_;
  std::string done_;
};

TEST_F(PairPlayerTest, FolderWithStartStepAndCount) {
  const Player player("_source:=" + folder(0.001) +
                      " _b:=second _start:=1 _step:=2 _count:=3 _rate:=20");
  ASSERT_TRUE(spin_until([&] { return done_ == "yes" && b_.frames() == 3 && b_.pose.size() == 3; }))
      << b_.frames() << " frames, " << b_.pose.size() << " poses, done: " << done_;
  check(1, 2, 3, 0.001);
}

TEST_F(PairPlayerTest, BagOfTheBenchmarkIsCleanedAndExact) {
  const Player player("_source:=" + tum_bag() + " _b:=second _rate:=20");
  ASSERT_TRUE(spin_until([&] { return done_ == "yes" && b_.frames() == 5 && b_.pose.size() == 5; }))
      << b_.frames() << " frames, " << b_.pose.size() << " poses, done: " << done_;
  check(0, 1, 5, 0.0002);
}

TEST_F(PairPlayerTest, HandshakeWaitsForTheAnswerToEveryFrame) {
  const Player player("_source:=" + folder(0.001) +
                      " _b:=second _rate:=0 _handshake:=true _handshake_timeout:=60");
  for (std::size_t pair = 1; pair <= 5; ++pair) {
    ASSERT_TRUE(spin_until([&] { return b_.frames() == pair && statistics_.getNumSubscribers(); }))
        << "pair " << pair;
    rprr_msgs::PairStatistics answer;
    answer.robot = "eyebug_a";  // not what it waits for
    answer.header.stamp = b_.depth.rbegin()->first;
    statistics_.publish(answer);
    answer.robot = "second";
    answer.header.stamp += ros::Duration(1.0);
    statistics_.publish(answer);
    EXPECT_FALSE(spin_until([&] { return b_.frames() > pair; }, 0.3)) << "played on unasked";
    answer.header.stamp = b_.depth.rbegin()->first;
    statistics_.publish(answer);
  }
  EXPECT_TRUE(spin_until([&] { return done_ == "yes"; }));
  check(0, 1, 5, 0.001);
}

TEST_F(PairPlayerTest, LostAnswersOnlyDelay) {
  const Player player("_source:=" + folder(0.001) +
                      " _b:=second _rate:=0 _handshake:=true _handshake_timeout:=0.1");
  EXPECT_TRUE(spin_until([&] { return done_ == "yes" && b_.frames() == 5; }));
}

TEST_F(PairPlayerTest, ByHand) {
  const Player player("_source:=" + folder(0.001) + " _b:=second _rate:=0");
  auto next = nh_.serviceClient<std_srvs::Trigger>("/pair_player/next");
  ASSERT_TRUE(next.waitForExistence(ros::Duration(20.0)));
  for (std::size_t pair = 1; pair <= 2; ++pair) {
    std_srvs::Trigger call;
    ASSERT_TRUE(next.call(call) && call.response.success) << call.response.message;
    EXPECT_TRUE(spin_until([&] { return b_.frames() == pair; })) << pair;
    EXPECT_FALSE(spin_until([&] { return b_.frames() > pair; }, 0.2));
  }
}

TEST_F(PairPlayerTest, FaultyEntriesAreLeftOutAndTheRestGoesOn) {
  const std::string path = folder(0.001);
  std::ofstream(path + "/depth/12.000000000.png") << "broken";
  const Player player("_source:=" + path + " _b:=second _rate:=50");
  EXPECT_TRUE(spin_until([&] { return done_ == "no" && b_.frames() == 3; }))
      << b_.frames() << " frames, " << b_.pose.size() << " poses, done: " << done_;
}

TEST_F(PairPlayerTest, NoSuchSourceIsReported) {
  const Player player("_source:=" + temporary_.path("nowhere") + " _b:=second");
  EXPECT_TRUE(spin_until([&] { return done_ == "no"; }));
}

}  // namespace
}  // namespace rprr

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "test_pair_player");
  return RUN_ALL_TESTS();
}
