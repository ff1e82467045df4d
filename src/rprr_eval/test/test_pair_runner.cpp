// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_eval/pairs/pair_runner.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <map>
#include <nlohmann/json.hpp>

#include "rprr_synthetic/temporary_folder.hpp"
#include "synthetic_walk.hpp"

namespace rprr {
namespace {

using nlohmann::json;

// Every name of the object that `rprr_eval pairs` writes. Scripts rely on them.
const std::map<std::string, std::vector<std::string>> kFields = {
    {"pose", {"accepted", "reason", "iterations", "err_m", "err_deg", "bytes", "messages"}},
    {"blocks", {"total", "p", "v", "sent", "sent_without_depth"}},
    {"bytes", {"pose", "masks", "depth", "colour", "extras", "total"}},
    {"independent_bytes", {"depth", "colour", "total"}},
    {"quality",
     {"psnr", "psnr_predicted", "share_predicted", "ssim", "depth_rmse_mm", "depth_coverage",
      "independent_psnr", "independent_ssim"}},
    {"ms", {"pose", "predict", "validate", "encode", "decode", "reconstruct"}}};

class PairRunnerTest : public testing::Test {
 protected:
  // Entries: two neighbours, and one that looks the other way.
  static void SetUpTestSuite() {
    files_ = std::make_unique<TemporaryFolder>();
    write_walk(files_->path("walk"), {0, 1, 50});
  }
  static void TearDownTestSuite() { files_.reset(); }

  void SetUp() override {
    auto folder = open_tum_folder(files_->path("walk"));
    ASSERT_TRUE(folder) << folder.reason();
    folder_ = *folder;
  }
  static PairRunner runner(const std::string& profile_name = "default") {
    const auto profile = load_profile(profile_name);
    EXPECT_TRUE(profile) << profile.reason();
    auto made = PairRunner::create(*profile);
    EXPECT_TRUE(made) << made.reason();
    return std::move(*made);
  }
  static void bytes_add_up(const json& pair) {
    const json& bytes = pair["bytes"];
    EXPECT_EQ(bytes["total"].get<int>(),
              bytes["pose"].get<int>() + bytes["masks"].get<int>() + bytes["depth"].get<int>() +
                  bytes["colour"].get<int>() + bytes["extras"].get<int>())
        << bytes;
    EXPECT_EQ(bytes["pose"], pair["pose"]["bytes"]) << "no messages forgotten";
    EXPECT_GT(bytes["depth"].get<int>(), 0);
    EXPECT_GT(bytes["colour"].get<int>(), 0);
    const json& independent = pair["independent_bytes"];
    EXPECT_GT(independent["total"].get<int>(),
              independent["depth"].get<int>() + independent["colour"].get<int>());
  }

  static std::unique_ptr<TemporaryFolder> files_;
  TumFolder folder_;
};
std::unique_ptr<TemporaryFolder> PairRunnerTest::files_;

TEST_F(PairRunnerTest, JsonHasTheFixedNames) {
  PairRunner pairs = runner();
  const auto result = pairs.run(folder_, 0, 1);
  ASSERT_TRUE(result) << result.reason();
  const json pair = to_json(*result);
  EXPECT_EQ(pair["a"], 0);
  EXPECT_EQ(pair["b"], 1);
  EXPECT_TRUE(pair["overlap"].is_number());
  for (const auto& [group, names] : kFields) {
    ASSERT_TRUE(pair.contains(group)) << group;
    for (const std::string& name : names) {
      EXPECT_TRUE(pair[group].contains(name)) << group << "." << name;
      const bool text = name == "reason";
      const bool flag = name == "accepted";
      EXPECT_TRUE(text   ? pair[group][name].is_string()
                  : flag ? pair[group][name].is_boolean()
                         : pair[group][name].is_number())
          << group << "." << name << " is " << pair[group][name];
    }
  }
  EXPECT_EQ(pair.dump().find('\n'), std::string::npos) << "one object a line";
}

TEST_F(PairRunnerTest, NeighboursAreAcceptedAndRightAndSaveBytes) {
  for (const std::string profile : {"default", "paper"}) {
    SCOPED_TRACE(profile);
    PairRunner pairs = runner(profile);
    const auto result = pairs.run(folder_, 0, 1);
    ASSERT_TRUE(result) << result.reason();
    const json pair = to_json(*result);
    EXPECT_TRUE(pair["pose"]["accepted"].get<bool>()) << pair["pose"];
    EXPECT_EQ(pair["pose"]["reason"], "");
    EXPECT_EQ(pair["pose"]["verdict"]["status"], "accepted");
    EXPECT_NE(pair["pose"]["verdict"]["quantity"], "none") << "by how much it was accepted";
    EXPECT_LT(pair["pose"]["err_m"].get<double>(), 0.05);
    EXPECT_LT(pair["pose"]["err_deg"].get<double>(), 2.0);
    EXPECT_GT(pair["overlap"].get<double>(), 0.6);
    bytes_add_up(pair);
    EXPECT_EQ(pair["blocks"]["total"], 40 * 30);
    const int sent = pair["blocks"]["sent"];
    EXPECT_LT(sent, 40 * 30 / 2);
    EXPECT_GE(sent, std::max(pair["blocks"]["p"].get<int>(), pair["blocks"]["v"].get<int>()));
    EXPECT_LE(sent, pair["blocks"]["p"].get<int>() + pair["blocks"]["v"].get<int>());
    EXPECT_LT(pair["bytes"]["depth"].get<int>(), pair["independent_bytes"]["depth"].get<int>());
    EXPECT_LT(pair["bytes"]["colour"].get<int>(), pair["independent_bytes"]["colour"].get<int>());
    EXPECT_TRUE(result->depth_exact) << "received blocks differ from b's own depth";
    EXPECT_GT(pair["quality"]["psnr"].get<double>(), 20.0);
    EXPECT_GT(pair["quality"]["depth_coverage"].get<double>(), 0.8);
    EXPECT_GT(pair["quality"]["share_predicted"].get<double>(), 0.3);
    EXPECT_GT(pair["quality"]["independent_psnr"].get<double>(), pair["quality"]["psnr"]);
  }
}

TEST_F(PairRunnerTest, ARejectedPairIsSentWhole) {
  PairRunner pairs = runner();
  const auto result = pairs.run(folder_, 0, 2);
  ASSERT_TRUE(result) << result.reason();
  const json pair = to_json(*result);
  EXPECT_FALSE(pair["pose"]["accepted"].get<bool>());
  const std::string reason = pair["pose"]["reason"];
  EXPECT_NE(reason.find("needs"), std::string::npos) << reason;
  const json verdict = pair["pose"]["verdict"];
  EXPECT_NE(verdict["status"], "accepted");
  EXPECT_NE(verdict["quantity"], "none") << verdict;
  EXPECT_NE(verdict["measured"].get<double>(), verdict["needed"].get<double>()) << verdict;
  EXPECT_EQ(pair["blocks"]["sent"], pair["blocks"]["total"]);
  EXPECT_EQ(pair["bytes"]["depth"], pair["independent_bytes"]["depth"]);
  EXPECT_EQ(pair["bytes"]["colour"], pair["independent_bytes"]["colour"]);
  EXPECT_GT(pair["bytes"]["pose"].get<int>(), 0) << "the attempt is paid for";
  bytes_add_up(pair);
  EXPECT_TRUE(result->depth_exact);
  EXPECT_EQ(pair["quality"]["depth_rmse_mm"], 0.0);
  EXPECT_EQ(pair["quality"]["depth_coverage"], 1.0);
  EXPECT_EQ(pair["quality"]["share_predicted"], 0.0);
  EXPECT_TRUE(pair["quality"]["psnr_predicted"].is_null());
  EXPECT_EQ(pair["quality"]["psnr"], pair["quality"]["independent_psnr"]);
}

TEST_F(PairRunnerTest, WithoutGroundTruthErrorsAreNull) {
  for (RgbdEntry& entry : folder_.entries) entry.world_from_camera.reset();
  PairRunner pairs = runner();
  const auto result = pairs.run(folder_, 0, 1);
  ASSERT_TRUE(result) << result.reason();
  const json pair = to_json(*result);
  EXPECT_TRUE(pair["overlap"].is_null());
  EXPECT_TRUE(pair["pose"]["err_m"].is_null());
  EXPECT_TRUE(pair["pose"]["err_deg"].is_null());
  EXPECT_TRUE(pair["pose"]["accepted"].get<bool>());
}

TEST_F(PairRunnerTest, PairsAfterAFaultyOneGoOn) {
  TumFolder broken = folder_;
  broken.entries[1].depth_path += ".absent";
  PairRunner pairs = runner();
  const auto wrong = pairs.run(broken, 0, 1);
  EXPECT_FALSE(wrong);
  EXPECT_NE(wrong.reason().find(".absent"), std::string::npos) << wrong.reason();
  EXPECT_FALSE(pairs.run(folder_, 0, 99));
  const auto result = pairs.run(folder_, 0, 1);
  ASSERT_TRUE(result) << result.reason();
  EXPECT_EQ(result->exchange.at_dependent.action, FrameDecision::Action::kSendSparse);
}

TEST_F(PairRunnerTest, OddSizesWork) {
  write_walk(files_->path("odd"), {0, 1}, 324, 244);
  const auto folder = open_tum_folder(files_->path("odd"));
  ASSERT_TRUE(folder) << folder.reason();
  PairRunner pairs = runner();
  const auto result = pairs.run(*folder, 0, 1);
  ASSERT_TRUE(result) << result.reason();
  const json pair = to_json(*result);
  EXPECT_TRUE(pair["pose"]["accepted"].get<bool>()) << pair["pose"];
  EXPECT_EQ(pair["blocks"]["total"], 41 * 31);
  EXPECT_TRUE(result->depth_exact);
  bytes_add_up(pair);
}

TEST_F(PairRunnerTest, AnUnknownCodecIsRefused) {
  Profile profile = *load_profile("default");
  profile.codec.colour_codec = "smoke";
  const auto made = PairRunner::create(profile);
  ASSERT_FALSE(made);
  EXPECT_NE(made.reason().find("smoke"), std::string::npos) << made.reason();
}

TEST_F(PairRunnerTest, TheKitchensFirstPairsAreRight) {
  const char* named = std::getenv("RPRR_DATA");
  const std::string path = std::string(named != nullptr ? named : RPRR_DATA_FOLDER) + "/kitchen";
  if (!std::filesystem::exists(path)) {
    GTEST_SKIP() << "no recorded frames in " << path << "; set RPRR_DATA";
  }
  const auto kitchen = open_tum_folder(path);
  ASSERT_TRUE(kitchen) << kitchen.reason();
  PairRunner pairs = runner();
  for (std::size_t k = 0; k < 2; ++k) {
    SCOPED_TRACE("pair " + std::to_string(k));
    const auto result = pairs.run(*kitchen, k, k + 1);
    ASSERT_TRUE(result) << result.reason();
    const json pair = to_json(*result);
    EXPECT_TRUE(pair["pose"]["accepted"].get<bool>()) << pair["pose"];
    EXPECT_EQ(pair["pose"]["reason"], "");
    EXPECT_EQ(pair["pose"]["verdict"]["status"], "accepted");
    EXPECT_NE(pair["pose"]["verdict"]["quantity"], "none") << "by how much it was accepted";
    EXPECT_LT(pair["pose"]["err_m"].get<double>(), 0.08);
    EXPECT_LT(pair["pose"]["err_deg"].get<double>(), 3.0);
    EXPECT_LT(pair["bytes"]["total"].get<double>(),
              0.6 * pair["independent_bytes"]["total"].get<double>());
    EXPECT_TRUE(result->depth_exact);
    bytes_add_up(pair);
  }
}

}  // namespace
}  // namespace rprr
