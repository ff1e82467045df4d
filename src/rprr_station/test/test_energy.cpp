// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_station/energy.hpp"

#include <gtest/gtest.h>

namespace rprr {
namespace {

// The paper's own inputs: 509 to 553 ms of processing and encoding, 32 to 42 ms of sending. (It
// states 480 to 520 mJ, which its formula does not give.)
TEST(Energy, PapersInputsThroughPapersFormula) {
  EnergyModel model;
  model.bytes_per_second = 1000;  // a byte is a millisecond
  EXPECT_NEAR(energy_millijoules(model, 400, 109, 32), 515.7, 0.1);
  EXPECT_NEAR(energy_millijoules(model, 400, 153, 42), 573.3, 0.1);
}

TEST(Energy, ARadioWithoutARateCostsNothing) {
  EnergyModel model;
  model.bytes_per_second = 0;
  EXPECT_EQ(energy_millijoules(model, 0, 0, 1000), 0);
}

}  // namespace
}  // namespace rprr
