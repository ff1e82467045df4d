// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "rprr_synthetic/option_check.hpp"
#include "station_parameters.hpp"

namespace rprr {
namespace {

TEST(StationOptions, HoldWhatHoldsForEveryTableAndAreDocumented) {
  StationParameters parameters;
  const OptionTable table = table_of(parameters);
  check_options(table);
  check_document(table,
                 "Private parameters of rprr_station/Station. `robots` has no usable default: the "
                 "launch file sets it, e.g. [eyebug_a, eyebug_b].",
                 RPRR_CONFIG "/station.yaml");
}

TEST(StationOptions, WindowsAreOdd) {
  StationParameters parameters;
  const OptionTable table = table_of(parameters);
  EXPECT_EQ(table.assign("mend_largest_window", 9), "");
  EXPECT_EQ(table.assign("mend_largest_window", 4),
            "mend_largest_window: 4 is not, allowed: 3, 5, 7, 9 pixels");
}

TEST(StationOptions, CloudsFollowTheNumberOfRobots) {
  StationParameters parameters;
  parameters.station.robots = {"a", "b", "c"};
  parameters.station.references_held = 7;
  parameters.output.cloud_points = 10;
  const SceneCloudOptions cloud = cloud_options(parameters);
  EXPECT_EQ(cloud.views, 2u);
  EXPECT_EQ(cloud.references, 7u);
  EXPECT_EQ(cloud.most_points, 10u);
}

}  // namespace
}  // namespace rprr
