// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_pose/pose_options.hpp"

#include <gtest/gtest.h>

#include "pose_parameters.hpp"
#include "rprr_synthetic/option_check.hpp"
#include "tf_prior.hpp"

namespace rprr {
namespace {

TEST(PoseOptions, HoldWhatHoldsForEveryTable) {
  ExchangeParameters parameters;
  check_options(table_of(parameters));
}

TEST(PoseOptions, TheirDocumentIsUpToDate) {
  ExchangeParameters parameters;
  check_document(table_of(parameters), "Private parameters of rprr_pose/Exchange.",
                 RPRR_CONFIG "/pose.yaml");
}

TEST(PoseOptions, WhatBothProtocolsNeedIsSetInBoth) {
  ExchangeOptions pose;
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
  ExchangeOptions pose;
  const OptionTable table = options_of(pose);
  EXPECT_EQ(table.assign("protocol", std::string("samples")), "");
  EXPECT_FALSE(pose.use_previews);
  EXPECT_EQ(table.assign("protocol", std::string("sample")),
            "protocol: sample is not, allowed: preview, samples");
}

TEST(PoseOptions, NamesGoTogether) {
  ExchangeNodeOptions options;
  options.robot = "a";
  EXPECT_EQ(problem_of(options), "") << "a robot may be alone";
  options.peers = {"b", "c"};
  options.references = {"c"};
  EXPECT_EQ(problem_of(options), "");
  options.references = {"c", "d"};
  EXPECT_EQ(problem_of(options), "references: d is none of the peers");
  options.references = {};
  options.peers = {"b", "a"};
  EXPECT_EQ(problem_of(options), "peers: a is this robot itself, allowed: other robots");
}

TEST(PoseOptions, TfIsAskedForTheRobotAndItsPeer) {
  ExchangeNodeOptions options;
  options.robot = "a";
  options.tf_prior_odom_frame = "{robot}/odom";
  options.tf_target = TfTarget::kRoot;
  const auto tf = tf_prior_options(options, "b");
  ASSERT_TRUE(tf);
  EXPECT_EQ(tf->robot, "a");
  EXPECT_EQ(tf->peer, "b");
  EXPECT_EQ(tf->fixed_frame, "") << "auto";
  EXPECT_EQ(tf->odom_frame, "{robot}/odom");
  EXPECT_TRUE(tf->publishes_root);
  options.publish_tf = false;
  EXPECT_FALSE(tf_prior_options(options, "b")->publishes_root);
  options.tf_prior = false;
  EXPECT_FALSE(tf_prior_options(options, "b"));
}

}  // namespace
}  // namespace rprr
