// SPDX-License-Identifier: BSD-3-Clause
//
// The nodelet on a camera of our own behind OpenNI2 (openni2_test_driver.cpp), on a recording of
// it through OpenNI2's file driver, and without any camera.
#include <OniCProperties.h>
#include <dynamic_reconfigure/Reconfigure.h>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "camera_test.hpp"

namespace rprr {
namespace {

class OpenNi2Test : public CameraTest {
 protected:
  void SetUp() override {
    CameraTest::SetUp();
    cv::Mat millimetres;
    kinect_->truth.convertTo(millimetres, CV_16U, 1000.0);
    cv::imwrite(temporary_.path("colour.png"), kinect_->bgr);
    cv::imwrite(temporary_.path("depth.png"), millimetres);
    plug_in();
  }
  void plug_in() { temporary_.write("plugged", "yes"); }
  void unplug() { std::filesystem::remove(temporary_.path("plugged")); }
  /// What the driver was last told of a property; -1 if nothing.
  int last_set(int property) {
    int value = -1;
    std::ifstream(temporary_.path("set_" + std::to_string(property))) >> value;
    return value;
  }
  std::string environment() {
    return "RPRR_TEST_CAMERA=" + temporary_.path() + " " + home_and_libraries(RPRR_OPENNI2_FOLDER);
  }
};

TEST_F(OpenNi2Test, CameraThatRegistersIsPublishedAsItIs) {
  const ChildProcess camera("camera", "_device:=TEST1 _registration:=device", environment());
  ASSERT_TRUE(wait_for_frames(10)) << message_;
  check_against_truth(0.95);
  EXPECT_TRUE(spin_until([&] { return values_["registration"] == "by the device"; }));
  EXPECT_EQ(values_["serial"], "TEST1");
}

TEST_F(OpenNi2Test, ExposureAndRateAreSetWhileItRuns) {
  const ChildProcess camera("camera", "_auto_white_balance:=false", environment());
  ASSERT_TRUE(wait_for_frames(1)) << message_;
  EXPECT_EQ(last_set(ONI_STREAM_PROPERTY_AUTO_EXPOSURE), 1);
  EXPECT_EQ(last_set(ONI_STREAM_PROPERTY_AUTO_WHITE_BALANCE), 0);
  dynamic_reconfigure::Reconfigure call;
  dynamic_reconfigure::BoolParameter automatic;
  automatic.name = "auto_exposure";
  automatic.value = 0;
  dynamic_reconfigure::IntParameter exposure;
  exposure.name = "exposure";
  exposure.value = 123;
  dynamic_reconfigure::DoubleParameter rate;
  rate.name = "max_rate";
  rate.value = 1.0;
  call.request.config.bools.push_back(automatic);
  call.request.config.ints.push_back(exposure);
  call.request.config.doubles.push_back(rate);
  ASSERT_TRUE(ros::service::call("/camera/set_parameters", call));
  EXPECT_TRUE(spin_until([&] { return last_set(ONI_STREAM_PROPERTY_EXPOSURE) == 123; }));
  EXPECT_EQ(last_set(ONI_STREAM_PROPERTY_AUTO_EXPOSURE), 0);
  topics_.depth.clear();
  EXPECT_TRUE(spin_until([&] { return topics_.depth.size() == 4; }));
  const ros::Duration three_periods = topics_.depth.rbegin()->first - topics_.depth.begin()->first;
  // The first may have been under way before, and a busy machine stamps some late; at the camera's
  // own rate it would be a tenth of a second.
  EXPECT_GT(three_periods.toSec(), 1.0);
}

TEST_F(OpenNi2Test, UnpluggedItIsFoundAgain) {
  ChildProcess camera("camera", "_max_rate:=10", environment());
  ASSERT_TRUE(wait_for_frames(3)) << message_;
  unplug();
  EXPECT_TRUE(wait_for_message("is gone")) << message_;
  EXPECT_NE(trigger(), "");
  const std::size_t before = topics_.frames();
  plug_in();
  EXPECT_TRUE(wait_for_frames(before + 3)) << message_;
  EXPECT_TRUE(spin_until([&] { return values_["times opened"] == "2"; }));
  EXPECT_TRUE(camera.runs());
}

TEST_F(OpenNi2Test, RecordingIsPlayedAndPlayedAgain) {
  const std::string recording = temporary_.path("walk.oni");
  ASSERT_EQ(std::system((environment() + " " RPRR_OPENNI2_RECORD " " + recording + " 20").c_str()),
            0);
  unplug();
  const ChildProcess camera("camera", "_device:=" + recording, environment());
  ASSERT_TRUE(wait_for_frames(10)) << message_;
  check_against_truth(0.95);
  EXPECT_TRUE(wait_for_frames(50)) << "it has 20: " << message_;
  EXPECT_TRUE(spin_until([&] { return values_["times opened"] == "1"; }));
}

TEST_F(OpenNi2Test, ModesThatItDoesNotHaveAreRefusedInWords) {
  const ChildProcess camera("camera", "_width:=320 _height:=240", environment());
  EXPECT_TRUE(wait_for_message("320x240")) << message_;
  EXPECT_EQ(level_, diagnostic_msgs::DiagnosticStatus::ERROR);
}

TEST_F(OpenNi2Test, NoCameraIsSaidAndNothingCrashes) {
  unplug();
  ChildProcess camera("camera", "", environment());
  check_no_camera(camera, "OpenNI2");
}

}  // namespace
}  // namespace rprr

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "test_openni2");
  return RUN_ALL_TESTS();
}
