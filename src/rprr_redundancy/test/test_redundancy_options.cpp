// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "rprr_redundancy/redundancy_options.hpp"
#include "rprr_synthetic/option_check.hpp"

namespace rprr {
namespace {

TEST(RedundancyOptions, HoldWhatHoldsForEveryTableAndAreDocumented) {
  RedundancyWiring wiring;
  RedundancyOptions options;
  OptionTable table = options_of(wiring);
  table.append(options_of(options));
  check_options(table);
  check_document(table, "Private parameters of rprr_redundancy/Redundancy.",
                 RPRR_CONFIG "/redundancy.yaml");
}

TEST(RedundancyOptions, ARobotIsNoPeerOfItself) {
  RedundancyWiring wiring;
  wiring.robot = "a";
  wiring.peers = {"b", "c"};
  EXPECT_EQ(problem_of(wiring), "");
  wiring.peers = {"b", "a"};
  EXPECT_EQ(problem_of(wiring), "peers: a is this robot itself, allowed: other robots");
}

}  // namespace
}  // namespace rprr
