// SPDX-License-Identifier: BSD-3-Clause
//
// Runs the command line tools as a person would.
#include <gtest/gtest.h>

#include <cstdlib>
#include <opencv2/core.hpp>

#include "rprr_sensor/recordings/tum_folder.hpp"
#include "rprr_sensor_ros/recording.hpp"
#include "rprr_synthetic/temporary_folder.hpp"

namespace rprr {
namespace {

bool run(const std::string& tool, const std::string& arguments) {
  const std::string command = std::string(RPRR_TOOLS) + "/" + tool + " " + arguments;
  return std::system((command + " > /dev/null 2>&1").c_str()) == 0;
}

TEST(Tools, ExplainThemselvesAndRefuseNonsense) {
  for (const char* tool : {"folder_to_bag", "synthetic_to_bag", "synthetic_to_folder"}) {
    EXPECT_TRUE(run(tool, "--help")) << tool;
    EXPECT_FALSE(run(tool, "")) << tool;
    EXPECT_FALSE(run(tool, "/no/such/place /no/such/place --no-such-option")) << tool;
  }
  EXPECT_FALSE(run("folder_to_bag", "/no/such/folder /tmp/never.bag"));
  EXPECT_FALSE(run("synthetic_to_bag", "/no/such/folder/x.bag --frames 1 --width 64 --height 48"));
}

TEST(Tools, ExposureSwingsAsFarAsOneAsks) {
  const TemporaryFolder temporary;
  const std::string size = " --frames 3 --width 96 --height 64 --exposure-swing ";
  std::vector<double> ratios;
  for (const char* swing : {"0", "0.25"}) {
    const std::string walk = temporary.path(swing);
    ASSERT_TRUE(run("synthetic_to_folder", walk + size + swing));
    const auto folder = open_tum_folder(walk);
    ASSERT_TRUE(folder) << folder.reason();
    const auto first = folder->load(std::size_t{0});
    const auto last = folder->load(std::size_t{2});
    ASSERT_TRUE(first && last);
    ratios.push_back(cv::mean(last->bgr)[1] / cv::mean(first->bgr)[1]);
  }
  EXPECT_GT(ratios[1], 1.05 * ratios[0]);
  EXPECT_FALSE(run("synthetic_to_folder", temporary.path("dark") + size + "1.5"));
}

TEST(Tools, SyntheticFolderBecomesBagsOfTheSameDepth) {
  const TemporaryFolder temporary;
  const std::string walk = temporary.path("walk");
  ASSERT_TRUE(run("synthetic_to_folder", walk + " --frames 2 --width 96 --height 64"));
  EXPECT_FALSE(run("synthetic_to_folder", walk)) << "must not overwrite a recording";
  const auto folder = open_tum_folder(walk);
  ASSERT_TRUE(folder) << folder.reason();
  ASSERT_EQ(folder->entries.size(), 2u);
  const auto expected = folder->load(std::size_t{1});
  ASSERT_TRUE(expected) << expected.reason();
  for (const char* shape : {"rprr", "tum"}) {
    const std::string path = temporary.path(std::string(shape) + ".bag");
    ASSERT_TRUE(run("folder_to_bag", walk + " " + path + " --compress lz4 --shape " + shape));
    RecordingOptions options;
    options.depth.for_metres = 0.001;
    const auto bag = open_recording(path, options);
    ASSERT_TRUE(bag) << bag.reason();
    const auto frame = (*bag)->load(1);
    ASSERT_TRUE(frame) << frame.reason();
    EXPECT_EQ(cv::norm(frame->image.depth.counts, expected->depth.counts, cv::NORM_INF), 0.0);
    ASSERT_TRUE(frame->world_from_camera);
    EXPECT_TRUE(frame->world_from_camera->isApprox(*folder->entries[1].world_from_camera, 1e-9));
  }
}

TEST(Tools, SyntheticBagHasTwoRobots) {
  const TemporaryFolder temporary;
  const std::string path = temporary.path("two.bag");
  ASSERT_TRUE(run("synthetic_to_bag", path + " --frames 2 --width 96 --height 64 --seed 5"));
  double fx[2] = {0.0, 0.0};
  for (int i = 0; i < 2; ++i) {
    const std::string root = i == 0 ? "/eyebug_a/camera" : "/eyebug_b/camera";
    RecordingOptions options;
    options.colour_topic = root + "/rgb/image_rect_color";
    options.depth_topic = root + "/depth_registered/image_rect";
    const auto robot = open_recording(path, options);
    ASSERT_TRUE(robot) << robot.reason();
    EXPECT_EQ((*robot)->size(), 2u);
    const auto frame = (*robot)->load(0);
    ASSERT_TRUE(frame) << frame.reason();
    EXPECT_TRUE(frame->world_from_camera);
    EXPECT_EQ(frame->image.depth.unit, 0.001);
    fx[i] = (*robot)->camera().fx;
  }
  EXPECT_NE(fx[0], fx[1]) << "the robots' intrinsics differ";
}

}  // namespace
}  // namespace rprr
