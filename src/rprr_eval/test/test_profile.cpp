// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_eval/profile/profile.hpp"

#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <fstream>
#include <set>

#include "rprr_geometry/option_text.hpp"
#include "rprr_geometry/profile_keys.hpp"
#include "rprr_ros/input_options.hpp"
#include "rprr_synthetic/option_check.hpp"
#include "rprr_synthetic/temporary_folder.hpp"

namespace rprr {
namespace {

const std::string kShipped = RPRR_PROFILES;

std::set<std::string> keys_of(const std::string& path) {
  std::set<std::string> keys;
  for (const auto& entry : YAML::LoadFile(path)) keys.insert(entry.first.as<std::string>());
  return keys;
}

class ProfileTest : public testing::Test {
 protected:
  std::string file(const std::string& text) const {
    std::ofstream(folder_.path("test.yaml")) << text;
    return folder_.path("test.yaml");
  }
  // The complaint about a file, empty if it loads.
  std::string complaint(const std::string& text) const { return load_profile(file(text)).reason(); }

  TemporaryFolder folder_;
};

TEST_F(ProfileTest, BothShippedOnesLoadByTheirNames) {
  const auto best = load_profile("default");
  ASSERT_TRUE(best) << best.reason();
  EXPECT_EQ(best->name, "default");
  EXPECT_TRUE(best->samples.local_start);
  EXPECT_EQ(best->samples.max_iterations, 20);
  EXPECT_EQ(best->station.synthesis.mode, Synthesis::kBackward);
  const auto paper = load_profile("paper");
  ASSERT_TRUE(paper) << paper.reason();
  EXPECT_FALSE(paper->samples.local_start);
  EXPECT_TRUE(paper->samples.resample);
  EXPECT_EQ(paper->samples.max_iterations, 50);
  EXPECT_EQ(paper->samples.sample_count, 250);
  EXPECT_EQ(paper->station.synthesis.mode, Synthesis::kForward);
  EXPECT_EQ(paper->station.stitch.fill, UnknownFill::kBlack);
  EXPECT_EQ(paper->codec.fill, UnsentFill::kBlack);
  EXPECT_EQ(paper->codec.colour_codec, "pgf");
  EXPECT_EQ(paper->codec.colour_quality, 6);
  EXPECT_EQ(paper->sending.receipt_timeout, 0);
}

TEST_F(ProfileTest, ByPathTheyAreTheSame) {
  auto by_name = load_profile("paper");
  auto by_path = load_profile(kShipped + "/paper.yaml");
  ASSERT_TRUE(by_name && by_path) << by_path.reason();
  EXPECT_EQ(values_of(options_of(*by_name)), values_of(options_of(*by_path)));
}

// So a node without a profile runs profile default.
TEST_F(ProfileTest, DefaultIsWhatTheStructsHave) {
  auto best = load_profile("default");
  ASSERT_TRUE(best) << best.reason();
  const OptionTable table = options_of(*best);
  for (const Option& option : table.options())
    EXPECT_EQ(option.get(), option.initial) << option.name;
}

TEST_F(ProfileTest, PaperSaysNothingButWhatDiffers) {
  auto paper = load_profile("paper");
  ASSERT_TRUE(paper) << paper.reason();
  const OptionTable table = options_of(*paper);
  for (const std::string& key : keys_of(kShipped + "/paper.yaml")) {
    ASSERT_NE(table.find(key), nullptr) << key;
    EXPECT_NE(table.find(key)->get(), table.find(key)->initial) << key;
  }
}

TEST_F(ProfileTest, ItsTableHoldsWhatHoldsForEveryTable) {
  Profile profile;
  check_options(options_of(profile));
}

// Of all nodes into which launch files load a profile. All four have link_recovery; the table of
// one of them says so for all. A name in two tables is one parameter: a profile sets it in both.
TEST(ProfileKeys, AreThoseOfAllTables) {
  Profile profile;
  ExchangeNodeOptions exchange;
  InputOptions input;
  StationOutputOptions output;
  OptionTable all = options_of(profile);
  all.append(options_of(exchange));
  all.append(options_of(input));
  all.append(options_of(output));
  std::set<std::string> wanted;
  for (const Option& option : all.options()) {
    if (option.wiring) continue;
    wanted.insert(option.name);
    const Option& first = *all.find(option.name);
    EXPECT_EQ(option.initial, first.initial) << option.name;
    EXPECT_EQ(allowed_text(option), allowed_text(first)) << option.name;
    EXPECT_EQ(option.unit, first.unit) << option.name;
  }
  const std::set<std::string> listed(profile_keys().begin(), profile_keys().end());
  EXPECT_EQ(listed, wanted) << "mend rprr_geometry/src/profile_keys.cpp";
}

TEST_F(ProfileTest, MissingKeysKeepTheirDefaults) {
  const auto profile = load_profile(file("colour_quality: 9\n"));
  ASSERT_TRUE(profile) << profile.reason();
  EXPECT_EQ(profile->codec.colour_quality, 9);
  EXPECT_EQ(profile->samples.sample_count, SamplesOptions().sample_count);
  EXPECT_EQ(profile->codec.colour_codec, FrameCodecOptions().colour_codec);
}

TEST_F(ProfileTest, ParametersOfNodesAloneMayStandInIt) {
  EXPECT_EQ(complaint("cloud_points: 1000\npublish_tf: false\ndepth_unit: 0.001\n"), "");
}

TEST_F(ProfileTest, MisspeltNamesAreRefused) {
  const std::string wrong = complaint("previw_step: 0.003\n");
  EXPECT_NE(wrong.find("test.yaml"), std::string::npos) << wrong;
  EXPECT_NE(wrong.find("unknown parameter 'previw_step' (did you mean 'preview_step'?)"),
            std::string::npos)
      << wrong;
  EXPECT_NE(complaint("robot: eyebug_a\n"), "") << "a profile does not say who a node is";
  EXPECT_NE(complaint("robots: [eyebug_a]\n"), "");
}

TEST_F(ProfileTest, OtherKindsAreRefusedAsTheyAreByANode) {
  for (const char* text :
       {"resample: 0\n", "resample: \"false\"\n", "max_iterations: many\n",
        "max_iterations: 20.0\n", "max_iterations: \"20\"\n", "preview_step: [0.003]\n",
        "preview_step: 3e-3\n", "preview_step:\n", "colour_codec: 5\n", "in_flight: {a: 1}\n"}) {
    const std::string wrong = complaint(text);
    const std::string key(text, std::string(text).find(':'));
    EXPECT_NE(wrong.find(key + ": "), std::string::npos) << text << " says '" << wrong << "'";
    EXPECT_NE(wrong.find("allowed: "), std::string::npos) << wrong;
  }
  EXPECT_EQ(complaint("resample: yes\nreceipt_timeout: 2\npreview_step: 3.0e-3\n"), "");
}

TEST_F(ProfileTest, BadValuesNameTheFileTheKeyAndWhatIsAllowed) {
  for (const char* key : {"unsent_fill", "synthesis", "unknown_fill", "protocol", "objective"}) {
    const std::string wrong = complaint(std::string(key) + ": sideways\n");
    for (const char* part : {"test.yaml", key, "sideways", "allowed: "}) {
      EXPECT_NE(wrong.find(part), std::string::npos) << "'" << part << "' is not in: " << wrong;
    }
  }
  const std::string wrong = complaint("preview_step: 0.5\nmax_iterations: 0\n");
  EXPECT_NE(wrong.find("max_iterations: 0 is not, allowed: 1 to 250"), std::string::npos) << wrong;
  EXPECT_NE(wrong.find("preview_step: 0.5 is not, allowed: 0.0005 to 0.05 1/m"), std::string::npos)
      << wrong;
}

TEST_F(ProfileTest, AQualityThatTheCodecHasNotIsRefused) {
  const std::string wrong = complaint("colour_codec: pgf\n");
  EXPECT_NE(wrong.find("colour_quality: quality of pgf is 40"), std::string::npos) << wrong;
  EXPECT_EQ(complaint("colour_codec: pgf\ncolour_quality: 6\n"), "");
  EXPECT_NE(complaint("objective: fixed\nsparse_colours: \"bytes:3000\"\n"), "");
  EXPECT_EQ(complaint("objective: map\nsparse_colours: bytes:3000\n"), "");
}

TEST_F(ProfileTest, FilesThatAreNoProfileAreRefused) {
  const auto absent = load_profile(folder_.path("absent.yaml"));
  EXPECT_NE(absent.reason().find("absent.yaml"), std::string::npos) << absent.reason();
  EXPECT_FALSE(load_profile("no_such_profile"));
  EXPECT_NE(complaint("synthesis: {").find("test.yaml"), std::string::npos);
  EXPECT_FALSE(load_profile(file("- a\n- list\n")));
  EXPECT_FALSE(load_profile(file("only words")));
}

}  // namespace
}  // namespace rprr
