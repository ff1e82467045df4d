// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_eval/profile.hpp"

#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <fstream>
#include <set>

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
}

TEST_F(ProfileTest, ByPathTheyAreTheSame) {
  const auto by_name = load_profile("default");
  const auto by_path = load_profile(kShipped + "/default.yaml");
  ASSERT_TRUE(by_name && by_path) << by_path.reason();
  EXPECT_EQ(by_name->codec.colour_quality, by_path->codec.colour_quality);
  EXPECT_EQ(by_name->samples.limits.min_matched, by_path->samples.limits.min_matched);
}

// Whether the loader reads a key shows in its complaint about a value that no key can have.
TEST_F(ProfileTest, EveryKeyOfTheShippedOnesIsRead) {
  for (const char* name : {"default", "paper"}) {
    for (const std::string& key : keys_of(kShipped + "/" + name + ".yaml")) {
      const std::string wrong = complaint(key + ": [not, a, value]\n");
      EXPECT_NE(wrong.find(key), std::string::npos) << "rprr_eval does not read " << key << " of "
                                                    << name << ".yaml; it says '" << wrong << "'";
      EXPECT_NE(wrong.find("test.yaml"), std::string::npos) << wrong;
    }
  }
}

// What one says and the other does not could only be of the protocol that the other does not speak.
TEST_F(ProfileTest, ShippedOnesDifferInKeysOfThePreviewProtocolAlone) {
  const std::set<std::string> best = keys_of(kShipped + "/default.yaml");
  const std::set<std::string> paper = keys_of(kShipped + "/paper.yaml");
  for (const std::string& key : paper) EXPECT_TRUE(best.count(key)) << key << " only in paper.yaml";
  for (const std::string& key : best) {
    const bool of_previews =
        key.rfind("preview_", 0) == 0 || key.rfind("search_", 0) == 0 || key == "reference_age";
    EXPECT_TRUE(of_previews || paper.count(key)) << key << " only in default.yaml";
  }
}

TEST_F(ProfileTest, MissingKeysKeepTheirDefaults) {
  const auto profile = load_profile(file("colour_quality: 9\n"));
  ASSERT_TRUE(profile) << profile.reason();
  EXPECT_EQ(profile->codec.colour_quality, 9);
  EXPECT_EQ(profile->samples.sample_count, SamplesOptions().sample_count);
  EXPECT_EQ(profile->codec.colour_codec, FrameCodecOptions().colour_codec);
}

TEST_F(ProfileTest, BadWordsNameTheFileTheKeyAndWhatIsAllowed) {
  for (const char* key : {"unsent_fill", "synthesis", "unknown_fill"}) {
    const std::string wrong = complaint(std::string(key) + ": sideways\n");
    for (const char* part : {"test.yaml", key, "sideways", "nor"}) {
      EXPECT_NE(wrong.find(part), std::string::npos) << "'" << part << "' is not in: " << wrong;
    }
  }
  const std::string wrong = complaint("max_iterations: many\n");
  EXPECT_NE(wrong.find("max_iterations"), std::string::npos) << wrong;
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
