// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_geometry/option_table.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "rprr_geometry/option_text.hpp"
#include "rprr_geometry/profile_keys.hpp"

namespace rprr {
namespace {

enum class Fill { kBlack, kSmooth };

struct Options {
  bool resample = false;
  int iterations = 20;
  std::size_t queue = 4;
  double step = 0.003;
  float tolerance = 0.05f;
  Duration timeout = from_seconds(1.5);
  Duration same_timeout = from_seconds(1.5);
  Fill fill = Fill::kSmooth;
  std::string codec = "webp";
  std::string device;
  std::string robot = "eyebug_a";
  std::vector<std::string> peers = {"eyebug_b"};
  std::array<double, 3> translation = {-0.025, 0.0, 0.0};
  double bandwidth = 0.0;
};

void list_options(Options& o, OptionTable& table) {
  table.flag("resample", o.resample, "New points in every iteration");
  table.whole("iterations", o.iterations, {1, 1000}, "", "Then the pose is rejected");
  table.whole("queue", o.queue, {1, 100}, "messages", "How many may wait");
  table.number("step", o.step, {0.0005, 0.05}, "1/m", "Step of inverse depth");
  table.number("tolerance", o.tolerance, {0.0, 1.0}, "", "Share of the depth").as_live();
  table.seconds("timeout", {&o.timeout, &o.same_timeout}, {0, 60}, "How long an answer may take");
  table.group("Colours");
  table.word<Fill>("fill", o.fill, {{"black", Fill::kBlack}, {"smooth", Fill::kSmooth}},
                   "What stands where nothing is sent");
  table.word("codec", o.codec, {"jpeg", "pgf", "webp"}, "Codec of the colours");
  table.text("device", o.device, "Serial number; empty: the first");
  table.robot("robot", o.robot, "This robot").as_wiring();
  table.texts("peers", o.peers, "Robots that it hears")
      .only_if(are_robot_names, "names of robots, none twice");
  table.numbers("translation", o.translation, {-1, 1}, "m", "Where the other camera is");
  table.number("bandwidth", o.bandwidth, {0, 1e9}, "bytes/s", "What the radio may take")
      .only_if(
          [](const OptionValue& value) {
            const double given = std::get<double>(value);
            return given == 0.0 || given >= 8000.0;
          },
          "0 (no limit) or at least 8000 bytes/s");
}

class OptionTableTest : public testing::Test {
 protected:
  std::string complaint(const std::string& name, const OptionValue& value) {
    const std::string before = option_document(options_of(options_), "") + values();
    const std::string wrong = table_.assign(name, value);
    if (!wrong.empty()) {
      EXPECT_EQ(option_document(options_of(options_), "") + values(), before);
    }
    return wrong;
  }
  std::string values() const {
    std::string text;
    for (const Option& option : table_.options()) text += yaml_text(option.get()) + "\n";
    return text;
  }

  Options options_;
  OptionTable table_ = options_of(options_);
};

TEST_F(OptionTableTest, EveryKindIsAssignedAndReadBack) {
  const std::vector<std::pair<std::string, OptionValue>> values = {
      {"resample", true},
      {"iterations", 50},
      {"queue", 7},
      {"step", 0.004},
      {"tolerance", 0.1},
      {"timeout", 0.3},
      {"fill", std::string("black")},
      {"codec", std::string("pgf")},
      {"device", std::string("A00367")},
      {"robot", std::string("eyebug_7")},
      {"peers", std::vector<std::string>{"x", "y"}},
      {"translation", std::vector<double>{0.1, 0.2, 0.3}},
      {"bandwidth", 8000.0}};
  EXPECT_EQ(values.size(), table_.options().size());
  for (const auto& [name, value] : values) {
    EXPECT_EQ(table_.assign(name, value), "");
    EXPECT_EQ(table_.find(name)->get(), value) << name;
  }
  EXPECT_TRUE(options_.resample);
  EXPECT_EQ(options_.queue, 7u);
  EXPECT_FLOAT_EQ(options_.tolerance, 0.1f);
  EXPECT_EQ(options_.timeout, 300000000);
  EXPECT_EQ(options_.same_timeout, 300000000) << "one parameter, two fields";
  EXPECT_EQ(options_.fill, Fill::kBlack);
  EXPECT_EQ(options_.translation[2], 0.3);
}

TEST_F(OptionTableTest, AWholeNumberIsANumberAndNothingElseIsConverted) {
  EXPECT_EQ(table_.assign("timeout", 2), "");
  EXPECT_EQ(options_.timeout, from_seconds(2.0));
  EXPECT_EQ(complaint("resample", 0), "resample: a number was given (0), allowed: true, false");
  EXPECT_NE(complaint("resample", std::string("true")), "");
  EXPECT_NE(complaint("iterations", 20.0), "");
  EXPECT_NE(complaint("iterations", true), "");
  EXPECT_NE(complaint("step", std::string("0.003")), "");
  EXPECT_NE(complaint("device", 367), "");
  EXPECT_NE(complaint("peers", std::string("eyebug_b")), "");
  EXPECT_NE(complaint("translation", std::vector<std::string>{"a", "b", "c"}), "");
  for (const Option& option : table_.options()) EXPECT_NE(complaint(option.name, {}), "");
}

TEST_F(OptionTableTest, WhatIsOutOfRangeIsRefusedByNameWithWhatIsAllowed) {
  EXPECT_EQ(complaint("step", 0.5), "step: 0.5 is not, allowed: 0.0005 to 0.05 1/m");
  EXPECT_EQ(complaint("iterations", 0), "iterations: 0 is not, allowed: 1 to 1000, a whole number");
  EXPECT_EQ(complaint("fill", std::string("sideways")),
            "fill: sideways is not, allowed: black, smooth");
  EXPECT_EQ(complaint("bandwidth", 100.0),
            "bandwidth: 100.0 is not, allowed: 0 (no limit) or at least 8000 bytes/s");
  EXPECT_NE(complaint("step", std::nan("")), "");
  EXPECT_NE(complaint("step", INFINITY), "");
  EXPECT_NE(complaint("codec", std::string()), "");
  EXPECT_NE(complaint("robot", std::string("a/b")), "");
  EXPECT_NE(complaint("peers", std::vector<std::string>{"x", "x"}), "");
  EXPECT_NE(complaint("translation", std::vector<double>{0.0, 0.0}), "");
  EXPECT_NE(complaint("translation", std::vector<double>{0.0, 0.0, 2.0}), "");
}

TEST_F(OptionTableTest, AMisspeltNameIsRefusedWithTheNearestOne) {
  EXPECT_EQ(complaint("iteratoins", 5),
            "unknown parameter 'iteratoins' (did you mean 'iterations'?)");
  EXPECT_EQ(complaint("colour", 5), "unknown parameter 'colour'");
}

TEST_F(OptionTableTest, ManyValuesAtOnceNameEveryFault) {
  const auto wrong = assign_all(
      table_, {{"iterations", 30}, {"step", 9.0}, {"search_yaw", 1.0}, {"search_jaw", 1.0}},
      {"search_yaw"});
  ASSERT_EQ(wrong.size(), 2u) << joined(wrong);
  EXPECT_EQ(joined(wrong),
            "unknown parameter 'search_jaw' (did you mean 'search_yaw'?); step: 9.0 is not, "
            "allowed: 0.0005 to 0.05 1/m");
  EXPECT_EQ(options_.iterations, 30);
}

TEST_F(OptionTableTest, DefaultsAreThoseOfANewStruct) {
  options_.iterations = 3;
  const OptionTable table = options_of(options_);
  EXPECT_EQ(table.find("iterations")->initial, OptionValue(20));
  EXPECT_EQ(table.find("iterations")->get(), OptionValue(3));
}

TEST_F(OptionTableTest, TheDocumentSaysWhatEachOptionIs) {
  const std::string text = option_document(table_, "Parameters of a test.");
  for (const char* part :
       {"# Parameters of a test.",
        "\n# Step of inverse depth. Allowed: 0.0005 to 0.05 1/m.\n"
        "step: 0.003\n",
        "\ntolerance: 0.05\n", "May change while the node runs.", "\n# ---- Colours\n",
        "\ndevice: \"\"\n", "\n# robot: eyebug_a\n", "\npeers: [eyebug_b]\n",
        "\ntranslation: [-0.025, 0.0, 0.0]\n", "\nbandwidth: 0.0\n"}) {
    EXPECT_NE(text.find(part), std::string::npos) << part << "\nis not in\n" << text;
  }
}

TEST(OptionText, ValuesAreWrittenSoThatYamlReadsTheSameKind) {
  EXPECT_EQ(yaml_text(1e6), "1000000.0");
  EXPECT_EQ(yaml_text(1e30), "1.0e+30");
  EXPECT_EQ(yaml_text(0.1 + 0.2), "0.30000000000000004");
  EXPECT_EQ(yaml_text(std::string("true")), "\"true\"");
  EXPECT_EQ(yaml_text(std::string("12")), "\"12\"");
  EXPECT_EQ(yaml_text(std::string("bytes:12000")), "\"bytes:12000\"");
  EXPECT_EQ(yaml_text(std::string("a \"b\"")), "\"a \\\"b\\\"\"");
  EXPECT_EQ(yaml_text(std::vector<std::string>{}), "[]");
}

TEST(ProfileKeys, AreSortedAndUnique) {
  const auto& keys = profile_keys();
  EXPECT_GT(keys.size(), 40u);
  EXPECT_TRUE(std::is_sorted(keys.begin(), keys.end()));
  EXPECT_EQ(std::adjacent_find(keys.begin(), keys.end()), keys.end());
}

}  // namespace
}  // namespace rprr
