// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <rprr_msgs/BlockPreview.h>
#include <rprr_msgs/CameraMotion.h>

#include "exchange_bench.hpp"

namespace rprr {

// rprr::BlockPreview and rprr::CameraMotion are what is inside of these messages.
using PreviewOfBlocks = rprr_msgs::BlockPreview;
using CameraMotionOfRobot = rprr_msgs::CameraMotion;

/// The exchange nodes while they speak the protocol of previews.
class PreviewNodes : public ExchangeNodes {
 protected:
  PreviewNodes() {
    metres_allowed = 0.03;
    degrees_allowed = 0.7;
  }
  bool protocol_connected() const override {
    return previews.connected() && a_motions.connected() && b_motions.connected() &&
           are_heard({&radio_preview});
  }
  /// b looks elsewhere for one exchange: a has no fresh pose to begin with then.
  bool exchange_elsewhere() {
    CameraOfRobot elsewhere(nh, "eyebug_b", test_motion(0.2, 150.0));
    if (!wait([&] { return elsewhere.connected(); })) return false;
    next_stamp();
    elsewhere.show(stamp);
    a.show(stamp);
    return wait([this] { return event_of(b_events, stamp) && pose_of(stamp); }) &&
           pose_of(stamp)->status != RelativePose::ACCEPTED;
  }
  /// Whether the last exchange did without a search: RelativePose.iterations says so.
  bool was_warm() const { return pose_of(stamp)->iterations == 1; }

  const CameraMotionOfRobot* motion_of(const Inbox<CameraMotionOfRobot>& motions,
                                       ros::Time since) const {
    for (const auto& motion : motions.messages) {
      if (motion->since == since) return motion.get();
    }
    return nullptr;
  }

  Inbox<CameraMotionOfRobot> a_motions{nh, "/eyebug_a/rprr/motion"};
  Inbox<CameraMotionOfRobot> b_motions{nh, "/eyebug_b/rprr/motion"};
  Inbox<PreviewOfBlocks> previews{nh, "/eyebug_b/rprr/preview"};
  ros::Publisher radio_preview = nh.advertise<PreviewOfBlocks>("/eyebug_b/rprr/preview", 100);
};

}  // namespace rprr
