// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <ros/serialization.h>
#include <rprr_msgs/EncodedFrame.h>

#include "rprr_radio/frame_chunk.hpp"

namespace rprr {
namespace {

TEST(MessageSizes, TheCoreCountsWhatRosSerialises) {
  for (const std::size_t bytes : {0u, 1u, 1000u, 70000u}) {
    for (const std::string frame_id : {"", "eyebug_b_rgb_optical_frame"}) {
      rprr_msgs::EncodedFrame message;
      message.header.frame_id = frame_id;
      message.data.resize(bytes);
      EXPECT_EQ(encoded_message_bytes(frame_id.size(), bytes),
                ros::serialization::serializationLength(message));
    }
  }
}

}  // namespace
}  // namespace rprr
