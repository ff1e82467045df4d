// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_eval/poses/methods.hpp"

#include <gtest/gtest.h>

#include <iostream>
#include <set>

#include "room_views.hpp"
#include "rprr_eval/measure/metrics.hpp"

namespace rprr {
namespace {

TEST(Methods, HaveNamesOfTheirOwn) {
  std::set<std::string> names;
  for (const Method& method : methods()) {
    EXPECT_TRUE(names.insert(method.name).second) << method.name << " twice";
    const auto made = method.make();
    if (made) {
      EXPECT_EQ((*made)->name(), method.name);
    } else {
      std::cout << method.name << ": " << made.reason() << "\n";
      EXPECT_NE(made.reason().find("install"), std::string::npos) << made.reason();
    }
  }
}

// One and all: from the identity to M_ab, not to its inverse.
TEST(Methods, FindASmallMotionInTheRoom) {
  const RoomViews views = room_views(0.05, 3.0);
  std::vector<std::string> notes;
  const auto made = make_methods({}, notes);
  ASSERT_TRUE(made) << made.reason();
  for (const auto& method : *made) {
    const RegistrationResult result = method->align(views.a, views.b, Pose::Identity());
    const PoseError error = pose_error(result.b_from_a, views.truth);
    EXPECT_TRUE(is_right(error)) << method->name() << ": " << error.metres << " m, "
                                 << error.degrees << " deg";
    EXPECT_TRUE(result.accepted) << method->name();
    EXPECT_GT(result.iterations, 0) << method->name();
  }
}

TEST(Methods, SurviveFramesWithoutDepthOrColour) {
  RoomViews views = room_views(0.05, 3.0);
  RgbdFrame no_depth = views.b;
  no_depth.depth.counts = cv::Mat::zeros(views.b.depth.counts.size(), CV_16UC1);
  RgbdFrame nothing = no_depth;
  nothing.bgr = cv::Mat();
  std::vector<std::string> notes;
  const auto made = make_methods({}, notes);
  ASSERT_TRUE(made) << made.reason();
  for (const auto& method : *made) {
    for (const RgbdFrame& empty : {no_depth, nothing}) {
      EXPECT_FALSE(method->align(empty, views.b, Pose::Identity()).accepted) << method->name();
      // Colour alone is enough for features, as long as a has depth.
      if (method->name() == "orb_pnp" && !empty.bgr.empty()) continue;
      EXPECT_FALSE(method->align(views.a, empty, Pose::Identity()).accepted) << method->name();
    }
  }
}

TEST(Methods, AnUnknownNameIsAnError) {
  std::vector<std::string> notes;
  const auto made = make_methods({"icp", "astrology"}, notes);
  ASSERT_FALSE(made);
  EXPECT_NE(made.reason().find("astrology"), std::string::npos);
  EXPECT_NE(made.reason().find("icp_bd"), std::string::npos) << "names those that there are";
}

}  // namespace
}  // namespace rprr
