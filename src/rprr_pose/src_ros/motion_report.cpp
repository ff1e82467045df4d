// SPDX-License-Identifier: BSD-3-Clause
#include "motion_report.hpp"

#include <rprr_msgs/CameraMotion.h>

#include <cmath>
#include <cstdio>

#include "rprr_ros/conversions.hpp"

namespace rprr {
namespace {

using Outcome = CameraMotion::Outcome;

const ros::WallDuration kPeriod(0.5);  // some milliseconds each: too much for every exchange

const char* const kRemedy =
    ". Views are right, since an exchange keeps its frames, but the pose on /tf and in "
    "relative_pose is that of their stamps: let robots stand while they exchange, look tf up at "
    "its stamp, or carry the pose on by odometry or the motion topic";

double degrees(const CameraMotion& motion) {
  return motion.radians * 180.0 / M_PI;
}

std::string in_words(const CameraMotion& motion, double seconds) {
  char text[80];
  switch (motion.outcome) {
    case Outcome::kUnknown:
      return "not to be told: too little depth, or a scene that looks the same from elsewhere";
    case Outcome::kStill:
      return "no";
    case Outcome::kMoved:
      std::snprintf(text, sizeof(text), "%.2f m, %.0f deg in %.2f s", motion.metres,
                    degrees(motion), seconds);
      return text;
    case Outcome::kSceneChanged:
      break;
  }
  std::snprintf(text, sizeof(text), "far, or the scene changed, in %.2f s", seconds);
  return text;
}

}  // namespace

MotionReport::MotionReport(ros::NodeHandle& nh, const std::string& robot, double stale_overlap,
                           Health& health)
    : stale_overlap_(stale_overlap),
      health_(health),
      publisher_(nh.advertise<rprr_msgs::CameraMotion>("/" + robot + "/rprr/motion", 10)) {
}

void MotionReport::report(const RgbdFramePtr& frame, const std::string& peer,
                          std::uint32_t exchange) {
  if (!newest_ || newest_->stamp <= frame->stamp) return;
  if (compared_ != frame || compared_to_ != newest_) {
    const ros::SteadyTime now = ros::SteadyTime::now();
    if (publisher_.getNumSubscribers() == 0 && now < next_) return;
    next_ = now + kPeriod;
    motion_ = camera_motion(*frame, *newest_);
    compared_ = frame;
    compared_to_ = newest_;
  }
  publish(motion_, *frame, peer, exchange);
  judge(motion_, to_seconds(newest_->stamp - frame->stamp), peer);
}

void MotionReport::publish(const CameraMotion& motion, const RgbdFrame& frame,
                           const std::string& peer, std::uint32_t exchange) {
  rprr_msgs::CameraMotion message;
  message.header.stamp = to_time(newest_->stamp);
  message.header.frame_id = newest_->frame_id;
  message.since = to_time(frame.stamp);
  message.exchange = exchange;
  message.peer = peer;
  message.outcome = static_cast<std::uint8_t>(motion.outcome);
  pose_to_fields(motion.later_from_earlier, message.translation, message.rotation);
  message.metres = static_cast<float>(motion.metres);
  message.degrees = static_cast<float>(degrees(motion));
  message.shared = static_cast<float>(motion.overlap);
  publisher_.publish(message);
}

void MotionReport::judge(const CameraMotion& motion, double seconds, const std::string& peer) {
  const std::string words = in_words(motion, seconds);
  health_.show("moved during an exchange", words);
  const bool changed = motion.outcome == Outcome::kSceneChanged;
  if (!changed && motion.outcome != Outcome::kMoved) return;
  health_.count("exchanges during which the camera moved");
  if (changed) {
    health_.warn("moved during an exchange",
                 "the newest frame does not fit to the one of the exchange with '" + peer +
                     "': the camera moved " + words + kRemedy);
  } else if (motion.overlap < stale_overlap_) {
    health_.warn("moved during an exchange",
                 "during the exchange with '" + peer + "' the camera moved " + words +
                     ", and shows " + std::to_string(std::lround(100.0 * motion.overlap)) +
                     "% of what it showed" + kRemedy);
  }
}

}  // namespace rprr
