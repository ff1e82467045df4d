// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_eval/curves/pair_curves.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "rprr_eval/curves/curve_comparison.hpp"
#include "rprr_synthetic/temporary_folder.hpp"
#include "synthetic_walk.hpp"

namespace rprr {
namespace {

using nlohmann::json;

constexpr int kBudgets = 5;
constexpr double kBytesOfTimes = 5.0;  // by which measured times lengthen or shorten a message

// One pair that overlaps and one that does not, through everything, once for all tests.
class PairCurvesTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    const TemporaryFolder files;
    write_walk(files.path("walk"), {0, 1, 50});
    const auto folder = open_tum_folder(files.path("walk"));
    ASSERT_TRUE(folder) << folder.reason();
    const auto ours = load_profile("default");
    const auto paper = load_profile("paper");
    ASSERT_TRUE(ours && paper);
    auto measurer = CurveMeasurer::create(*ours, *paper, kBudgets);
    ASSERT_TRUE(measurer) << measurer.reason();
    WholeFrames whole({{"webp", 40}, {"pgf", 6}}, ours->codec.depth_mode);
    for (const auto& [a, b] : {std::pair{0, 1}, std::pair{1, 2}}) {
      auto curves = measurer->measure(*folder, "walk", static_cast<std::size_t>(a),
                                      static_cast<std::size_t>(b), whole);
      ASSERT_TRUE(curves) << curves.reason();
      pairs_.push_back(std::move(*curves));
    }
    expected_ = *PairRunner(std::move(*PairRunner::create(*ours))).run(*folder, 0, 1);
    truth_ = folder->load(1)->bgr;
  }
  static void TearDownTestSuite() {
    pairs_.clear();
    truth_.release();
  }
  void SetUp() override { ASSERT_EQ(pairs_.size(), 2u); }

  static json comparison_of(const std::string& folder) {
    json comparison = compare_curves(pairs_, "webp");
    comparison["folder"] = folder;
    return comparison;
  }

  static std::vector<PairCurves> pairs_;
  static PairResult expected_;
  static cv::Mat truth_;
};
std::vector<PairCurves> PairCurvesTest::pairs_;
PairResult PairCurvesTest::expected_;
cv::Mat PairCurvesTest::truth_;

TEST_F(PairCurvesTest, EveryMethodIsThereAndItsBytesRise) {
  for (const PairCurves& pair : pairs_) {
    for (const char* name : {"view", "map", "paper", "pgf", "jpeg", "webp"}) {
      SCOPED_TRACE(name);
      const MethodCurve* method = pair.find(name);
      ASSERT_NE(method, nullptr);
      ASSERT_GE(method->points.size(), static_cast<std::size_t>(kBudgets));
      for (std::size_t i = 1; i < method->points.size(); ++i) {
        EXPECT_GE(method->points[i].bytes, method->points[i - 1].bytes);
      }
    }
  }
}

TEST_F(PairCurvesTest, BudgetsAreKeptAndReachFromTheLeastToIndependentsMost) {
  const PairCurves& pair = pairs_[0];
  ASSERT_TRUE(pair.accepted);
  for (const char* name : {"view", "map"}) {
    const RatePoints& points = pair.find(name)->points;
    EXPECT_LT(points.front().bytes, pair.find("webp")->points.front().bytes);
    EXPECT_GT(points.back().psnr, points.front().psnr);
    EXPECT_GT(*points.back().psnr_new, *points.front().psnr_new);
    const auto around = static_cast<double>(points.front().bytes);
    for (std::size_t i = 1; i < points.size(); ++i) {
      EXPECT_LE(static_cast<double>(points[i].bytes), points[i].setting + around);
    }
  }
}

TEST_F(PairCurvesTest, AtTheProfileItIsWhatPairsMeasures) {
  const RatePoint& point = *pairs_[0].find("view")->at_profile;
  EXPECT_NEAR(static_cast<double>(point.bytes), static_cast<double>(expected_.rebuilt.bytes_total),
              kBytesOfTimes);
  EXPECT_EQ(point.psnr, expected_.psnr);
  EXPECT_EQ(point.ssim, expected_.ssim);
  EXPECT_EQ(point.depth.coverage, expected_.depth.coverage);
  const RatePoint& independent = *pairs_[0].find("webp")->at_profile;
  EXPECT_NEAR(static_cast<double>(independent.bytes),
              static_cast<double>(expected_.independent.total), kBytesOfTimes);
  EXPECT_EQ(independent.psnr, expected_.independent_psnr);
  EXPECT_EQ(pairs_[0].overlap, expected_.overlap);
}

TEST_F(PairCurvesTest, IndependentDepthIsExact) {
  for (const char* name : {"pgf", "jpeg", "webp"}) {
    for (const RatePoint& point : pairs_[0].find(name)->points) {
      EXPECT_EQ(point.depth.rmse_mm, 0.0);
      EXPECT_EQ(point.depth.coverage, 1.0);
      EXPECT_EQ(point.predicted_depth.pixels, 0u);
    }
  }
  EXPECT_GT(pairs_[0].find("view")->at_profile->predicted_depth.pixels, 1000u);
  EXPECT_LT(pairs_[0].find("view")->at_profile->predicted_depth.relative_rmse, 0.05);
}

TEST_F(PairCurvesTest, ARejectedPairIsAllNew) {
  const PairCurves& pair = pairs_[1];
  EXPECT_FALSE(pair.accepted);
  EXPECT_EQ(pair.share_new, 1.0);
  for (const RatePoint& point : pair.find("view")->points) {
    EXPECT_EQ(point.psnr_new, point.psnr);
    EXPECT_EQ(point.predicted_depth.pixels, 0u);
  }
}

TEST_F(PairCurvesTest, JsonHasEveryField) {
  const json pair = to_json(pairs_[0]);
  for (const char* name : {"folder", "step", "a", "b", "accepted", "overlap", "share_new"}) {
    EXPECT_TRUE(pair.contains(name)) << name;
  }
  for (const auto& [method, curve] : pair["methods"].items()) {
    for (const json& point : curve["points"]) {
      for (const char* name :
           {"setting", "bytes", "bytes_depth", "bytes_colour", "bpp", "bpp_colour", "psnr", "ssim",
            "psnr_new", "depth_rmse_mm", "depth_coverage", "predicted_depth_rmse",
            "predicted_depth_off", "predicted_depth_pixels"}) {
        EXPECT_TRUE(point.contains(name)) << method << " " << name;
      }
    }
  }
}

TEST_F(PairCurvesTest, JsonReadBackComparesTheSame) {
  std::vector<PairCurves> read;
  for (const PairCurves& pair : pairs_) {
    auto again = pair_curves_of(json::parse(to_json(pair).dump()));
    ASSERT_TRUE(again) << again.reason();
    read.push_back(std::move(*again));
  }
  EXPECT_EQ(compare_curves(read, "webp"), compare_curves(pairs_, "webp"));
  EXPECT_FALSE(pair_curves_of(json::object()));
  EXPECT_FALSE(pair_curves_of(json::parse("{", nullptr, false)));
  json broken = to_json(pairs_[0]);
  broken["methods"]["view"]["points"][0]["psnr"] = "high";
  EXPECT_FALSE(pair_curves_of(broken));
}

TEST_F(PairCurvesTest, ComparisonsHaveEveryFieldAndAreDeterministic) {
  const json comparison = compare_curves(pairs_, "webp");
  EXPECT_EQ(comparison["pairs"], 2);
  EXPECT_EQ(comparison["accepted"], 1);
  EXPECT_EQ(comparison["pairs_overlap_half"], 1);
  const double ratio = comparison["equal_quality_overlap_half"]["view"]["webp"]["in_common"];
  EXPECT_GT(ratio, 0.0);
  EXPECT_LT(ratio, 1.0) << "it saves bytes";
  EXPECT_EQ(comparison["on_curve"]["pairs"], 2);
  EXPECT_FALSE(comparison["on_curve"]["short"].empty()) << "the preview of a rejected pair costs";
  EXPECT_EQ(comparison["against_paper"].size(), 7u);
  EXPECT_TRUE(comparison["depth"]["view"]["median_rmse"].is_number());
  for (const char* method : {"view", "map", "paper", "pgf", "webp"}) {
    EXPECT_TRUE(comparison["at_profile"].contains(method)) << method;
  }
  for (const char* method : {"view", "map", "paper", "pgf", "jpeg", "webp"}) {
    EXPECT_FALSE(comparison["curves"][method].empty()) << method;
  }
  EXPECT_EQ(comparison, compare_curves(pairs_, "webp"));
  EXPECT_FALSE(comparison_text(comparison).empty());
  EXPECT_NE(comparison_markdown(std::vector<json>{comparison_of("one"), comparison_of("two")})
                .find("| one | two |"),
            std::string::npos);
}

TEST_F(PairCurvesTest, NothingToCompareIsNoError) {
  json comparison = compare_curves({}, "webp");
  EXPECT_EQ(comparison["pairs"], 0);
  comparison["folder"] = "nothing";
  EXPECT_FALSE(comparison_markdown(std::vector<json>(1, comparison)).empty());
  EXPECT_FALSE(comparison_text(comparison).empty());
}

TEST_F(PairCurvesTest, TheSheetShowsSixPictures) {
  const cv::Mat sheet = curve_sheet(pairs_[0], truth_, "webp");
  EXPECT_EQ(sheet.type(), CV_8UC3);
  EXPECT_GT(sheet.cols, 2 * 480);
  EXPECT_GT(sheet.rows, 3 * 360);
}

}  // namespace
}  // namespace rprr
