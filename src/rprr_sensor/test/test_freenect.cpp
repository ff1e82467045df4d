// SPDX-License-Identifier: BSD-3-Clause
//
// The nodelet on recordings that fakenect plays in libfreenect's place, and without any camera.
#include <sensor_msgs/SetCameraInfo.h>

#include <opencv2/imgproc.hpp>

#include "camera_test.hpp"

namespace rprr {
namespace {

/// A recording as libfreenect's fakenect-record makes them: one view, at 30 images a second.
std::string record(const TemporaryFolder& folder, const SyntheticKinect& kinect, int frames) {
  const auto write = [&](const std::string& name, const std::string& header,
                         const cv::Mat& pixels) {
    std::ofstream file(folder.path(name), std::ios::binary);
    file << header;
    file.write(reinterpret_cast<const char*>(pixels.data),
               static_cast<std::streamsize>(pixels.total() * pixels.elemSize()));
  };
  cv::Mat rgb;
  cv::cvtColor(kinect.bgr, rgb, cv::COLOR_BGR2RGB);
  write("depth.pgm", "P5 640 480 65535\n", kinect.disparity);
  write("colour.ppm", "P6 640 480 255\n", rgb);
  std::ofstream index(folder.path("INDEX.txt"));
  const auto add = [&](char kind, double time, const std::string& file) {
    char name[64];
    std::snprintf(name, sizeof name, "%c-%.6f-%u.%s", kind, time,
                  static_cast<unsigned>(std::fmod(time * 60e6, 4294967296.0)),
                  file.substr(file.find('.') + 1).c_str());
    std::filesystem::create_symlink(file, folder.path(name));
    index << name << "\n";
  };
  for (int k = 0; k < frames; ++k) {
    add('d', 70.0 + k / 30.0, "depth.pgm");  // the camera's clock begins again on the way
    add('r', 70.01 + k / 30.0, "colour.ppm");
  }
  return folder.path();
}

class FreenectTest : public CameraTest {
 protected:
  std::string fakenect(int frames) {
    return "FAKENECT_PATH=" + record(temporary_, *kinect_, frames) + " " +
           home_and_libraries(RPRR_FAKENECT_FOLDER);
  }
};

TEST_F(FreenectTest, RawRecordingIsRegisteredToColour) {
  const ChildProcess camera("camera", "_registration:=own", fakenect(900));
  ASSERT_TRUE(wait_for_frames(10)) << message_;
  check_against_truth(0.7);
  EXPECT_TRUE(spin_until([&] { return values_["registration"] == "own"; }));
  EXPECT_EQ(values_["serial"], "none");
  ASSERT_TRUE(wait_for_message("not calibrated")) << message_;
}

TEST_F(FreenectTest, PausedItPublishesOneForEachTrigger) {
  const ChildProcess camera("camera", "_registration:=own _paused:=true", fakenect(900));
  ASSERT_TRUE(ros::service::waitForService("/camera/pause", 20000));
  EXPECT_FALSE(wait_for_frames(1, 0.5)) << "it was to begin paused";
  ASSERT_TRUE(pause(false));
  ASSERT_TRUE(wait_for_frames(1)) << message_;  // now all three topics are connected
  EXPECT_NE(trigger(), "") << "not paused";
  ASSERT_TRUE(pause(true));
  spin_until([] { return false; }, 0.3);  // what was under way
  const std::size_t before = topics_.frames();
  EXPECT_EQ(trigger(), "");
  EXPECT_TRUE(wait_for_frames(before + 1));
  EXPECT_FALSE(wait_for_frames(before + 2, 0.5)) << "one, not more";
  EXPECT_EQ(trigger(), "");
  EXPECT_TRUE(wait_for_frames(before + 2));
}

TEST_F(FreenectTest, CalibrationThatIsSetIsUsedAndKept) {
  const ChildProcess camera("camera", "_registration:=own _every_nth:=3", fakenect(900));
  ASSERT_TRUE(wait_for_frames(1)) << message_;
  sensor_msgs::SetCameraInfo call;
  call.request.camera_info = info_from_camera({640, 480, 530.0, 531.0, 322.0, 241.0}, {});
  ASSERT_TRUE(ros::service::call("/eyebug_a/camera/rgb/set_camera_info", call));
  ASSERT_TRUE(call.response.success) << call.response.status_message;
  EXPECT_TRUE(spin_until([&] { return topics_.info.rbegin()->second.P[0] == 530.0; }));
  EXPECT_TRUE(std::filesystem::exists(temporary_.path("home/camera_info/rgb_camera.yaml")));
}

TEST_F(FreenectTest, EndOfTheRecordingIsSaidAndNothingCrashes) {
  ChildProcess camera("camera", "_registration:=own", fakenect(15));
  ASSERT_TRUE(wait_for_frames(5)) << message_;
  EXPECT_TRUE(wait_for_message("is gone")) << message_;
  EXPECT_EQ(level_, diagnostic_msgs::DiagnosticStatus::ERROR);
  EXPECT_TRUE(camera.runs());
}

TEST_F(FreenectTest, NoCameraIsSaidAndNothingCrashes) {
  ChildProcess camera("camera", "_device:=A00000000000000A", home());
  check_no_camera(camera, "libfreenect");
}

}  // namespace
}  // namespace rprr

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "test_freenect");
  return RUN_ALL_TESTS();
}
