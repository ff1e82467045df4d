// SPDX-License-Identifier: BSD-3-Clause
//
// Plays two robots' cameras and runs the tool beside them; what it wrote is read back.
#include <gtest/gtest.h>
#include <ros/ros.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sensor_msgs/image_encodings.h>
#include <tf2_msgs/TFMessage.h>

#include <atomic>
#include <opencv2/core.hpp>
#include <thread>

#include "rprr_ros/camera_info.hpp"
#include "rprr_ros/conversions.hpp"
#include "rprr_sensor_ros/frame_messages.hpp"
#include "rprr_sensor_ros/recording.hpp"
#include "rprr_synthetic/temporary_folder.hpp"

namespace rprr {
namespace {

const Camera kCamera{64, 48, 60.0, 60.0, 31.5, 23.5};

/// Publishes a robot's three topics at 20 Hz as long as it lives; depth counts up.
class FakeCamera {
 public:
  FakeCamera(ros::NodeHandle& nh, const std::string& robot) {
    const InputTopics topics = input_topics(robot);
    colour_ = nh.advertise<sensor_msgs::Image>(topics.colour, 10);
    info_ = nh.advertise<sensor_msgs::CameraInfo>(topics.camera_info, 10);
    depth_ = nh.advertise<sensor_msgs::Image>(topics.depth, 10);
    header_.frame_id = optical_frame(robot);
    thread_ = std::thread([this] { run(); });
  }
  ~FakeCamera() {
    stop_ = true;
    thread_.join();
  }

 private:
  void run() {
    for (int number = 1; !stop_; ++number) {
      header_.stamp = ros::Time(100.0 + 0.05 * number);
      info_.publish(info_from_camera(kCamera, header_));
      colour_.publish(to_image(header_, sensor_msgs::image_encodings::BGR8,
                               cv::Mat(48, 64, CV_8UC3, cv::Scalar::all(number % 256))));
      depth_.publish(to_image(header_, sensor_msgs::image_encodings::TYPE_16UC1,
                              cv::Mat(48, 64, CV_16UC1, cv::Scalar(number))));
      ros::WallDuration(0.05).sleep();
    }
  }
  ros::Publisher colour_, info_, depth_;
  std_msgs::Header header_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

class RecordInputsTest : public testing::Test {
 protected:
  /// The tool's exit status.
  int record(const std::string& arguments) {
    const std::string command = "rosrun rprr_sensor record_inputs " + arguments;
    return std::system((command + " > " + temporary_.path("log") + " 2>&1").c_str());
  }
  std::string log() const {
    std::ifstream file(temporary_.path("log"));
    return {std::istreambuf_iterator<char>(file), {}};
  }
  std::unique_ptr<Recording> robot(const std::string& bag, const std::string& name) {
    RecordingOptions options;
    options.colour_topic = input_topics(name).colour;
    options.depth_topic = input_topics(name).depth;
    auto recording = open_recording(bag, options);
    EXPECT_TRUE(recording) << recording.reason();
    return recording ? std::move(*recording) : nullptr;
  }

  ros::NodeHandle nh_;
  TemporaryFolder temporary_;
};

TEST_F(RecordInputsTest, BothRobotsAreReadBack) {
  const FakeCamera a(nh_, "eyebug_a");
  const FakeCamera b(nh_, "second");
  const auto other = nh_.advertise<sensor_msgs::Image>("/eyebug_a/camera/rgb/image_raw", 1, true);
  other.publish(sensor_msgs::Image());
  auto fixed = nh_.advertise<tf2_msgs::TFMessage>("/tf_static", 1, true);
  fixed.publish(tf2_msgs::TFMessage());
  const std::string path = temporary_.path("two.bag");
  ASSERT_EQ(record("--robots eyebug_a second --minutes 0.03 --tf -o " + path), 0) << log();
  for (const char* name : {"eyebug_a", "second"}) {
    const auto recording = robot(path, name);
    ASSERT_TRUE(recording);
    EXPECT_GT(recording->size(), 10u);
    EXPECT_EQ(recording->camera().fx, 60.0);
    const auto first = recording->load(0);
    const auto last = recording->load(recording->size() - 1);
    ASSERT_TRUE(first && last) << first.reason() << last.reason();
    const int numbers = static_cast<int>(last->image.depth.counts.at<std::uint16_t>(0)) -
                        first->image.depth.counts.at<std::uint16_t>(0);
    EXPECT_EQ(numbers, static_cast<int>(recording->size()) - 1) << "none is left out";
  }
  rosbag::Bag bag(path);
  rosbag::View view(bag);
  EXPECT_EQ(view.getConnections().size(), 7u) << "six inputs and /tf_static, nothing else";
  for (const auto* connection : view.getConnections()) {
    if (connection->topic == "/tf_static") {
      EXPECT_EQ((*connection->header)["latching"], "1");
    }
  }
}

TEST_F(RecordInputsTest, SizeIsLimited) {
  const FakeCamera a(nh_, "eyebug_a");
  const std::string path = temporary_.path("small.bag");
  ASSERT_EQ(record("--robots eyebug_a --megabytes 1 -o " + path), 0) << log();
  EXPECT_NEAR(1e-6 * static_cast<double>(std::filesystem::file_size(path)), 1.0, 0.8);
}

TEST_F(RecordInputsTest, SilentRobotIsNamedAndTheRestIsKept) {
  const FakeCamera a(nh_, "eyebug_a");
  const std::string path = temporary_.path("half.bag");
  EXPECT_NE(record("--robots eyebug_a absent --minutes 0.02 -o " + path), 0);
  EXPECT_NE(log().find("nothing came on /absent/camera"), std::string::npos) << log();
  EXPECT_GT(robot(path, "eyebug_a")->size(), 5u);
}

TEST_F(RecordInputsTest, NothingIsOverwrittenAndNonsenseRefused) {
  temporary_.write("there.bag", "precious");
  EXPECT_NE(record("--minutes 0.01 -o " + temporary_.path("there.bag")), 0);
  EXPECT_NE(log().find("exists already"), std::string::npos) << log();
  EXPECT_NE(record("-o /no/such/folder/x.bag"), 0);
  EXPECT_NE(record("--minutes soon"), 0);
  EXPECT_EQ(record("--help"), 0);
}

}  // namespace
}  // namespace rprr

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "test_record_inputs");
  ros::NodeHandle keep_running;
  return RUN_ALL_TESTS();
}
