// SPDX-License-Identifier: BSD-3-Clause
#include "cameras/camera_options.hpp"

namespace rprr {
namespace {

void list_device(CameraOptions& o, OptionTable& table) {
  table.group("The camera");
  table.robot("robot", o.robot, "Whose camera it is: topics in /ROBOT/camera").as_wiring();
  table.text("frame_id", o.frame_id, "Frame of the images; empty: ROBOT_rgb_optical_frame");
  table.text("device", o.session.serial,
             "Serial number (OpenNI2 also: URI, .oni file); empty: the first camera");
  table.whole("width", o.session.modes.width, {16, 10000}, "pixels",
              "Width of both images; libfreenect has 640x480 only");
  table.whole("height", o.session.modes.height, {16, 10000}, "pixels", "Height of both images");
  table.whole("fps", o.session.modes.rate, {1, 1000}, "images/s",
              "What the camera is asked for; libfreenect has 30 only");
  table.word<RegistrationChoice>("registration", o.session.modes.registration,
                                 {{"auto", RegistrationChoice::automatic},
                                  {"device", RegistrationChoice::device},
                                  {"own", RegistrationChoice::own}},
                                 "Who registers depth to the colour image: the device, our own "
                                 "code from the calibration of both cameras, or auto, the device "
                                 "where it can");
  table.seconds("max_skew", o.session.window, {0.0, 1.0},
                "Most time between the colour and the depth image of a pair");
  table.seconds("silence_timeout", o.session.silence, {0.1, 3600.0},
                "Without an image of either stream for so long the camera is opened anew");
  table.flag("paused", o.paused,
             "Begin paused; services ~pause (std_srvs/SetBool) and ~trigger (std_srvs/Trigger)");
}

void list_calibration(CameraOptions& o, OptionTable& table) {
  table.group("Calibration");
  table.text("camera_info_url", o.camera_info_url,
             "Calibration of the colour camera; ${NAME} is rgb_<serial>; empty: "
             "file://${ROS_HOME}/camera_info/${NAME}.yaml");
  table.text("depth_info_url", o.depth_info_url,
             "Calibration of the depth camera, for registration: own; ${NAME} is depth_<serial>");
  table.numbers("depth_to_colour_translation", o.depth_to_colour_translation, {-1.0, 1.0}, "m",
                "For registration: own. A point p of the depth camera is R p + t of the colour "
                "camera; this is t");
  table.numbers("depth_to_colour_rotation", o.depth_to_colour_rotation, {-3.15, 3.15}, "rad",
                "R of the same: roll, pitch, yaw");
  table.number("disparity_offset", o.disparity.offset, {0.1, 100.0}, "1/m",
               "Of libfreenect's raw depth, for registration: own: 1/z = offset - step * raw");
  table.number("disparity_step", o.disparity.step, {0.00001, 1.0}, "1/m",
               "Step of the same, for each count of raw depth");
}

void list_controls(CameraOptions& o, OptionTable& table) {
  DeviceControls& controls = o.session.controls;
  table.group("Controls");
  table.flag("auto_exposure", controls.auto_exposure, "false: exposure stays as it is").as_live();
  table
      .flag("auto_white_balance", controls.auto_white_balance,
            "false: white balance stays as it is")
      .as_live();
  table
      .whole("exposure", controls.exposure, {0, 100000}, "",
             "Without auto_exposure, in the camera's units, where it can; 0: as it is")
      .as_live();
  table
      .whole("gain", controls.gain, {0, 100000}, "",
             "Without auto_exposure, in the camera's units, where it can; 0: as it is")
      .as_live();
  table.whole("every_nth", o.every_nth, {1, 10000}, "pairs", "Publish one of so many").as_live();
  table
      .number("max_rate", o.max_rate, {0.0, 1000.0}, "pairs/s",
              "Publish no more than this, at whole multiples of the period; 0: no limit")
      .as_live();
}

}  // namespace

void list_options(CameraOptions& options, OptionTable& table) {
  list_device(options, table);
  list_calibration(options, table);
  list_controls(options, table);
}

Pose colour_from_depth(const CameraOptions& options) {
  const std::array<double, 3>& t = options.depth_to_colour_translation;
  const std::array<double, 3>& r = options.depth_to_colour_rotation;
  Pose pose = Pose::Identity();
  pose.translation() = Eigen::Vector3d(t[0], t[1], t[2]);
  pose.linear() = (Eigen::AngleAxisd(r[2], Eigen::Vector3d::UnitZ()) *
                   Eigen::AngleAxisd(r[1], Eigen::Vector3d::UnitY()) *
                   Eigen::AngleAxisd(r[0], Eigen::Vector3d::UnitX()))
                      .toRotationMatrix();
  return pose;
}

}  // namespace rprr
