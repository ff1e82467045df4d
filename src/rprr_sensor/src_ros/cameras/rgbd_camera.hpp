// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nodelet/nodelet.h>
#include <ros/ros.h>
#include <std_srvs/SetBool.h>
#include <std_srvs/Trigger.h>

#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "cameras/camera_calibration.hpp"
#include "cameras/camera_options.hpp"
#include "rprr_ros/health.hpp"
#include "rprr_ros/live_options.hpp"
#include "rprr_ros/worker.hpp"
#include "rprr_sensor/cameras/device_session.hpp"
#include "rprr_sensor/cameras/pair_processor.hpp"
#include "rprr_sensor/cameras/publish_gate.hpp"

namespace rprr {

/// An RGB-D camera as RPRR's inputs of one robot, whatever library drives it. Parameters:
/// config/rgbd_camera.yaml.
///
/// Publishes /<robot>/camera/rgb/image_rect_color (bgr8), .../rgb/camera_info and
/// .../depth_registered/image_rect (16UC1) with one stamp, that of the colour image, and
/// .../rgb/image_raw for calibration. Services: ~pause (std_srvs/SetBool), ~trigger
/// (std_srvs/Trigger) publishes one pair while paused, /<robot>/camera/rgb/set_camera_info.
class RgbdCamera : public nodelet::Nodelet {
 public:
  ~RgbdCamera() override;

 protected:
  virtual std::unique_ptr<RgbdDriver> make_driver() const = 0;

 private:
  void onInit() override;
  void advertise();
  void apply_live_options();
  bool on_pause(std_srvs::SetBool::Request& request, std_srvs::SetBool::Response& response);
  bool on_trigger(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);

  // On the worker's thread:
  void run(const SessionOptions& options);
  void handle(SessionStep step, DeviceSession& session);
  void opened(const DeviceSession& session);
  void prepare(const RgbdDevice& device);
  void publish(const DevicePair& pair);
  void show(const DeviceSession& session);
  bool has_listeners() const;
  bool running() const;
  void sleep(Duration at_most);

  CameraOptions options_;  // the live ones change, in callbacks
  std::unique_ptr<Health> health_;
  std::unique_ptr<CameraCalibration> calibration_;
  std::optional<PairProcessor> processor_;
  ros::Publisher colour_;
  ros::Publisher raw_colour_;
  ros::Publisher camera_info_;
  ros::Publisher depth_;
  ros::ServiceServer pause_;
  ros::ServiceServer trigger_;
  std::unique_ptr<LiveOptions> live_;
  ros::WallTime last_look_;  // at what changes slowly

  mutable std::mutex mutex_;
  std::condition_variable wake_;
  bool stop_ = false;
  bool streaming_ = false;
  PublishGate gate_;
  std::optional<DeviceControls> new_controls_;
  std::unique_ptr<Worker> worker_;  // last: stops before the rest goes
};

}  // namespace rprr
