// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_ros/parameters.hpp"

#include <gtest/gtest.h>

#include <ctime>

namespace rprr {
namespace {

using XmlRpc::XmlRpcValue;

XmlRpcValue list(const XmlRpcValue& one, const XmlRpcValue& other) {
  XmlRpcValue value;
  value.setSize(2);
  value[0] = one;
  value[1] = other;
  return value;
}

TEST(Parameters, KeepTheKindThatTheServerHasThemOf) {
  EXPECT_EQ(option_value(XmlRpcValue(true)), OptionValue(true));
  EXPECT_EQ(option_value(XmlRpcValue(0)), OptionValue(0));
  EXPECT_EQ(option_value(XmlRpcValue(2.0)), OptionValue(2.0));
  EXPECT_EQ(option_value(XmlRpcValue("true")), OptionValue(std::string("true")));
}

TEST(Parameters, ListsAreOfOneKind) {
  EXPECT_EQ(option_value(list("a", "b")), OptionValue(std::vector<std::string>{"a", "b"}));
  EXPECT_EQ(option_value(list(1, 2.5)), OptionValue(std::vector<double>{1.0, 2.5}));
  EXPECT_EQ(option_value(list("a", 1)), OptionValue());
  EXPECT_EQ(option_value(list(true, false)), OptionValue());
  XmlRpcValue none;
  none.setSize(0);
  EXPECT_EQ(option_value(none), OptionValue(std::vector<std::string>{}));
}

TEST(Parameters, WhatNoOptionHasIsOfNoKind) {
  XmlRpcValue mapping;
  mapping["key"] = 1;
  std::tm date{};
  EXPECT_EQ(option_value(mapping), OptionValue());
  EXPECT_EQ(option_value(XmlRpcValue(&date)), OptionValue());
  EXPECT_EQ(option_value(XmlRpcValue()), OptionValue());
}

}  // namespace
}  // namespace rprr
