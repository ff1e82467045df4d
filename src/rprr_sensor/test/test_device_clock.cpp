// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_sensor/cameras/device_clock.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "rprr_synthetic/random.hpp"

namespace rprr {
namespace {

constexpr Stamp kEpoch = from_seconds(1.7e9);
constexpr Duration kPeriod = from_seconds(1.0 / 30.0);

TEST(DeviceClock, DelaysOfArrivalDoNotShow) {
  DeviceClock clock;
  Random random(1);
  Stamp last = 0;
  for (int k = 0; k < 300; ++k) {
    const Duration device = from_seconds(77.0) + k * kPeriod;
    const auto delay = static_cast<Duration>(random.bits() % 20000000);
    const Stamp stamp = clock.stamp(device, kEpoch + k * kPeriod + delay);
    EXPECT_LE(stamp, kEpoch + k * kPeriod + delay) << "in the future";
    if (k > 100) {
      EXPECT_NEAR(to_seconds(stamp - last), to_seconds(kPeriod), 0.002) << k;
    }
    last = stamp;
  }
}

TEST(DeviceClock, DriftIsFollowed) {
  DeviceClock clock;
  for (int k = 0; k < 30000; ++k) {
    const auto device = static_cast<Duration>(static_cast<double>(k * kPeriod) * (1.0 - 1e-4));
    const Stamp arrival = kEpoch + k * kPeriod;
    EXPECT_NEAR(to_seconds(arrival - clock.stamp(device, arrival)), 0.0, 0.001) << k;
  }
}

TEST(DeviceClock, JumpsAreFoundOut) {
  DeviceClock clock;
  clock.stamp(from_seconds(100.0), kEpoch);
  const Stamp later = kEpoch + from_seconds(1.0);
  EXPECT_EQ(clock.stamp(from_seconds(3.0), later), later) << "began again";
  EXPECT_EQ(clock.stamp(from_seconds(900.0), later + 1), later + 1) << "went ahead";
  EXPECT_EQ(clock.stamp(from_seconds(900.1), kEpoch), kEpoch) << "our clock was set back";
}

TEST(TickCounter, GoesOnWhereThirtyTwoBitsEnd) {
  TickCounter counter(60e6);
  EXPECT_EQ(counter.read(0xffffff00u), 0);
  EXPECT_NEAR(static_cast<double>(counter.read(0x00000100u)), 512 / 60e6 * 1e9, 1.0);
  EXPECT_NEAR(static_cast<double>(counter.read(0x000000f0u)), 496 / 60e6 * 1e9, 1.0)
      << "streams may be read slightly out of order";
}

}  // namespace
}  // namespace rprr
