// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_sensor_ros/recording.hpp"

#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sensor_msgs/Image.h>

#include <opencv2/core.hpp>

#include "rprr_sensor/recordings/tum_writer.hpp"
#include "rprr_sensor_ros/bag_writer.hpp"
#include "rprr_synthetic/random.hpp"
#include "rprr_synthetic/temporary_folder.hpp"
#include "rprr_wire/camera_wire.hpp"

namespace rprr {
namespace {

const Camera kCamera{40, 24, 50.5, 51.25, 19.5, 11.75};
constexpr int kFrames = 3;

RecordedFrame random_frame(int number, double unit) {
  Random random(static_cast<std::uint64_t>(number));
  RecordedFrame frame;
  frame.stamp = from_seconds(100.0) + number * 100000001LL;
  frame.image = {cv::Mat(kCamera.height, kCamera.width, CV_8UC3),
                 {cv::Mat(kCamera.height, kCamera.width, CV_16UC1), unit}};
  for (int v = 0; v < kCamera.height; ++v) {
    for (int u = 0; u < kCamera.width; ++u) {
      frame.image.depth.counts.at<std::uint16_t>(v, u) = static_cast<std::uint16_t>(random.bits());
      frame.image.bgr.at<cv::Vec3b>(v, u) = {static_cast<std::uint8_t>(random.bits()), 1, 2};
    }
  }
  frame.image.depth.counts.at<std::uint16_t>(0, 0) = 0;
  frame.image.depth.counts.at<std::uint16_t>(0, 1) = 65535;
  Twist twist;
  for (int i = 0; i < 6; ++i) twist[i] = random.between(-1.0, 1.0);
  frame.world_from_camera = exp_se3(twist);
  frame.depth_stamp = frame.stamp - 15000000;
  return frame;
}

void write_bag(const std::string& path, double unit, BagShape shape, DepthEncoding encoding,
               const std::vector<std::string>& robots = {"eyebug_a"}) {
  auto bag = BagWriter::create(path, "lz4");
  ASSERT_TRUE(bag) << bag.reason();
  for (int k = 0; k < kFrames; ++k) {
    for (const auto& robot : robots) {
      const auto written = bag->add(random_frame(k, unit), kCamera, robot, shape, encoding);
      ASSERT_TRUE(written) << written.reason();
    }
  }
  const auto finished = bag->finish();
  ASSERT_TRUE(finished) << finished.reason();
}

/// A copy of a bag without some topics.
void copy_without(const std::string& from, const std::string& to,
                  const std::vector<std::string>& topics) {
  rosbag::Bag source(from);
  rosbag::Bag target(to, rosbag::bagmode::Write);
  rosbag::View view(source);
  for (const rosbag::MessageInstance& message : view) {
    if (std::find(topics.begin(), topics.end(), message.getTopic()) == topics.end()) {
      target.write(message.getTopic(), message.getTime(), message);
    }
  }
}

bool same(const cv::Mat& a, const cv::Mat& b) {
  return a.size() == b.size() && a.type() == b.type() && cv::norm(a, b, cv::NORM_INF) == 0.0;
}

struct Round {
  double unit;
  BagShape shape;
  DepthEncoding encoding;
};

class RoundTrip : public testing::TestWithParam<Round> {};

TEST_P(RoundTrip, CountsColoursStampsAndPosesSurvive) {
  const TemporaryFolder temporary;
  const std::string path = temporary.path("walk.bag");
  write_bag(path, GetParam().unit, GetParam().shape, GetParam().encoding);
  RecordingOptions options;
  options.depth.for_metres = GetParam().unit;
  const auto recording = open_recording(path, options);
  ASSERT_TRUE(recording) << recording.reason();
  EXPECT_EQ((*recording)->remark(), "");
  EXPECT_EQ(camera_hash((*recording)->camera()), camera_hash(kCamera));
  ASSERT_EQ((*recording)->size(), static_cast<std::size_t>(kFrames));
  for (int k = 0; k < kFrames; ++k) {
    const auto frame = (*recording)->load(static_cast<std::size_t>(k));
    ASSERT_TRUE(frame) << frame.reason();
    const RecordedFrame expected = random_frame(k, GetParam().unit);
    EXPECT_EQ(frame->stamp, expected.stamp);
    EXPECT_EQ(frame->depth_stamp,
              GetParam().shape == BagShape::tum ? expected.depth_stamp : expected.stamp);
    EXPECT_EQ(frame->image.depth.unit, GetParam().unit);
    EXPECT_TRUE(same(frame->image.depth.counts, expected.image.depth.counts)) << "depth is exact";
    EXPECT_TRUE(same(frame->image.bgr, expected.image.bgr));
    ASSERT_TRUE(frame->world_from_camera);
    EXPECT_TRUE(frame->world_from_camera->isApprox(*expected.world_from_camera, 1e-9));
  }
  EXPECT_FALSE((*recording)->load(kFrames));
}

INSTANTIATE_TEST_SUITE_P(Shapes, RoundTrip,
                         testing::Values(Round{0.001, BagShape::rprr, DepthEncoding::automatic},
                                         Round{0.001, BagShape::rprr, DepthEncoding::millimetres},
                                         Round{0.001, BagShape::rprr, DepthEncoding::metres},
                                         Round{0.0002, BagShape::rprr, DepthEncoding::automatic},
                                         Round{0.0002, BagShape::tum, DepthEncoding::automatic},
                                         Round{0.001, BagShape::tum, DepthEncoding::automatic}));

TEST(BagWriter, RefusesToRoundAndStampsThatBagsCannotHold) {
  const TemporaryFolder temporary;
  auto bag = BagWriter::create(temporary.path("x.bag"), "none");
  ASSERT_TRUE(bag);
  EXPECT_FALSE(
      bag->add(random_frame(0, 0.0002), kCamera, "r", BagShape::rprr, DepthEncoding::millimetres));
  RecordedFrame frame = random_frame(0, 0.001);
  frame.stamp = 0;
  EXPECT_FALSE(bag->add(frame, kCamera, "r", BagShape::rprr, DepthEncoding::automatic));
  EXPECT_FALSE(BagWriter::create(temporary.path("no/such/folder.bag"), "none"));
  EXPECT_FALSE(BagWriter::create(temporary.path("y.bag"), "zip"));
}

TEST(BagWriter, ABagIsThereWholeOrNotAtAll) {
  const TemporaryFolder temporary;
  const std::string path = temporary.path("x.bag");
  {
    auto bag = BagWriter::create(path, "none");
    ASSERT_TRUE(bag);
    EXPECT_TRUE(
        bag->add(random_frame(0, 0.001), kCamera, "r", BagShape::rprr, DepthEncoding::automatic));
  }
  EXPECT_TRUE(std::filesystem::is_empty(temporary.path())) << "what ended early leaves nothing";
}

// A device on which nothing fits stands for a disk that is full.
TEST(BagWriter, AFullDiskIsAnErrorAtTheLatestAtTheEnd) {
  const TemporaryFolder temporary;
  const std::string path = temporary.path("x.bag");
  std::filesystem::create_symlink("/dev/full", path + ".part");
  auto bag = BagWriter::create(path, "none");
  std::string reason = bag.reason();
  if (bag) {
    const auto added =
        bag->add(random_frame(0, 0.001), kCamera, "r", BagShape::rprr, DepthEncoding::automatic);
    const auto finished = bag->finish();
    EXPECT_FALSE(finished);
    reason = added.reason() + finished.reason();
  }
  EXPECT_NE(reason.find(path), std::string::npos) << reason;
  EXPECT_FALSE(std::filesystem::exists(path));
}

TEST(Recording, FolderAndBagOpenAlike) {
  const TemporaryFolder temporary;
  auto writer = TumWriter::create(temporary.path("walk"), kCamera, 0.001, true, "test");
  ASSERT_TRUE(writer);
  const RecordedFrame expected = random_frame(0, 0.001);
  ASSERT_TRUE(writer->add(expected.stamp, expected.image, expected.world_from_camera));
  const auto recording = open_recording(temporary.path("walk"));
  ASSERT_TRUE(recording) << recording.reason();
  const auto frame = (*recording)->load(0);
  ASSERT_TRUE(frame) << frame.reason();
  EXPECT_TRUE(same(frame->image.depth.counts, expected.image.depth.counts));
}

TEST(Recording, WithoutCameraInfoTheBagsNameOrTheCallerDecides) {
  const TemporaryFolder temporary;
  write_bag(temporary.path("all.bag"), 0.0002, BagShape::tum, DepthEncoding::automatic);
  const std::string path = temporary.path("rgbd_dataset_freiburg3_x.bag");
  copy_without(temporary.path("all.bag"), path,
               {"/camera/rgb/camera_info", "/camera/depth/camera_info", "/tf"});
  auto recording = open_recording(path);
  ASSERT_TRUE(recording) << recording.reason();
  EXPECT_EQ((*recording)->camera().fx, 535.4);
  EXPECT_NE((*recording)->remark().find("camera_info"), std::string::npos) << "a person is told";
  EXPECT_FALSE((*recording)->load(0)) << "images of 40x24 are not of a 640x480 camera";
  RecordingOptions options;
  options.camera = kCamera;
  recording = open_recording(path, options);
  ASSERT_TRUE(recording) << recording.reason();
  const auto frame = (*recording)->load(0);
  ASSERT_TRUE(frame) << frame.reason();
  EXPECT_FALSE(frame->world_from_camera) << "no /tf, no pose";
}

TEST(Recording, TwoRobotsAreRefusedUnlessTopicsAreNamed) {
  const TemporaryFolder temporary;
  const std::string path = temporary.path("two.bag");
  write_bag(path, 0.001, BagShape::rprr, DepthEncoding::automatic, {"eyebug_a", "eyebug_b"});
  const auto ambiguous = open_recording(path);
  ASSERT_FALSE(ambiguous);
  EXPECT_NE(ambiguous.reason().find("eyebug_b"), std::string::npos) << ambiguous.reason();
  RecordingOptions options;
  options.colour_topic = "/eyebug_b/camera/rgb/image_rect_color";
  options.depth_topic = "/eyebug_b/camera/depth_registered/image_rect";
  EXPECT_TRUE(open_recording(path, options));
  options.depth_topic = "/nowhere";
  EXPECT_FALSE(open_recording(path, options));
}

TEST(Recording, BrokenBagsAreErrors) {
  const TemporaryFolder temporary;
  EXPECT_FALSE(open_recording(temporary.path("none.bag")));
  temporary.write("text.bag", "this is not a bag");
  EXPECT_FALSE(open_recording(temporary.path("text.bag")));
  temporary.write("empty.bag", "");
  EXPECT_FALSE(open_recording(temporary.path("empty.bag")));
  const std::string path = temporary.path("cut.bag");
  write_bag(path, 0.001, BagShape::rprr, DepthEncoding::automatic);
  std::filesystem::resize_file(path, std::filesystem::file_size(path) / 2);
  EXPECT_FALSE(open_recording(path));
  write_bag(temporary.path("all.bag"), 0.001, BagShape::rprr, DepthEncoding::automatic);
  const std::string blind = temporary.path("blind.bag");
  copy_without(temporary.path("all.bag"), blind, {"/eyebug_a/camera/depth_registered/image_rect"});
  const auto recording = open_recording(blind);
  ASSERT_FALSE(recording);
  EXPECT_NE(recording.reason().find("depth"), std::string::npos) << recording.reason();
}

}  // namespace
}  // namespace rprr
