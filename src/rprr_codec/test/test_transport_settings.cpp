// SPDX-License-Identifier: BSD-3-Clause
#include "transport/transport_settings.hpp"

#include <gtest/gtest.h>

#include "rprr_synthetic/option_check.hpp"

namespace rprr {
namespace {

template <typename Settings>
class TransportSettings : public testing::Test {};

using AllSettings = testing::Types<DhcmSending, PgfSending, DhcmReceiving, PgfReceiving>;
TYPED_TEST_SUITE(TransportSettings, AllSettings);

TYPED_TEST(TransportSettings, HoldWhatHoldsForEveryTableAndMayChangeAtRunTime) {
  TypeParam settings;
  const OptionTable table = options_of(settings);
  check_options(table);
  for (const Option& option : table.options()) EXPECT_TRUE(option.live) << option.name;
}

}  // namespace
}  // namespace rprr
