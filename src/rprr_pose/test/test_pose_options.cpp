// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "rprr_pose/pose_options.hpp"
#include "rprr_ros/rgbd_subscriber.hpp"
#include "rprr_synthetic/option_check.hpp"

namespace rprr {
namespace {

struct Tables {
  ExchangeOptions exchange;
  PoseOptions pose;
  InputOptions input;
  OptionTable all() {
    OptionTable table = options_of(exchange);
    table.append(options_of(pose));
    table.append(options_of(input));
    return table;
  }
};

TEST(PoseOptions, HoldWhatHoldsForEveryTable) {
  Tables tables;
  check_options(tables.all());
}

TEST(PoseOptions, TheirDocumentIsUpToDate) {
  Tables tables;
  check_document(tables.all(), "Private parameters of rprr_pose/Exchange.",
                 RPRR_CONFIG "/pose.yaml");
}

TEST(PoseOptions, WhatBothProtocolsNeedIsSetInBoth) {
  PoseOptions pose;
  const OptionTable table = options_of(pose);
  EXPECT_EQ(table.assign("step_timeout", 0.25), "");
  EXPECT_EQ(table.assign("min_period", 2), "");
  EXPECT_EQ(table.assign("max_frame_difference", 0.1), "");
  EXPECT_EQ(pose.preview.step_timeout, from_seconds(0.25));
  EXPECT_EQ(pose.samples.step_timeout, from_seconds(0.25));
  EXPECT_EQ(pose.preview.min_period, from_seconds(2.0));
  EXPECT_EQ(pose.samples.min_period, from_seconds(2.0));
  EXPECT_EQ(pose.preview.max_stamp_difference, from_seconds(0.1));
  EXPECT_EQ(pose.samples.max_stamp_difference, from_seconds(0.1));
}

TEST(PoseOptions, AProtocolIsOneOfTwoWords) {
  PoseOptions pose;
  const OptionTable table = options_of(pose);
  EXPECT_EQ(table.assign("protocol", std::string("samples")), "");
  EXPECT_FALSE(pose.use_previews);
  EXPECT_EQ(table.assign("protocol", std::string("sample")),
            "protocol: sample is not, allowed: preview, samples");
}

}  // namespace
}  // namespace rprr
