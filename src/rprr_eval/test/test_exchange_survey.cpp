// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_eval/iterations/exchange_survey.hpp"

#include <gtest/gtest.h>

#include "room_views.hpp"
#include "rprr_eval/exchange/exchange_registration.hpp"

namespace rprr {
namespace {

ExchangeSurvey survey_at(const RoomViews& views, const Profile& profile, double one_way_s,
                         int exchanges = 2) {
  ExchangeSurveyor surveyor(make_exchange(profile, from_seconds(one_way_s)));
  for (int i = 0; i < exchanges; ++i) surveyor.add(views.a, views.b);
  return surveyor.survey();
}

Profile samples_profile() {
  Profile profile;
  profile.use_previews = false;
  profile.samples.max_iterations = 50;
  return profile;
}

TEST(ExchangeSurvey, CountsWhatAcceptedExchangesCost) {
  const ExchangeSurvey survey = survey_at(room_views(0.05, 3.0), samples_profile(), 0.005);
  EXPECT_EQ(survey.pairs, 2);
  ASSERT_EQ(survey.accepted, 2);
  int histogram = 0;
  for (const auto& [iterations, count] : survey.histogram) histogram += count;
  EXPECT_EQ(histogram, survey.accepted);
  EXPECT_GE(survey.max_iterations, survey.mean_iterations);
  EXPECT_GT(survey.mean_bytes, 2 * 1094.0) << "both robots send 250 points";
  EXPECT_GE(survey.mean_messages, 2.0 * survey.mean_iterations + 1.0);
  EXPECT_NEAR(survey.bytes_per_iteration * survey.mean_iterations, survey.mean_bytes, 1.0);
}

TEST(ExchangeSurvey, LatencyGrowsWithTheRoundTripNotWithTheMachine) {
  const RoomViews views = room_views(0.05, 3.0);
  const ExchangeSurvey near = survey_at(views, samples_profile(), 0.01);
  const ExchangeSurvey far = survey_at(views, samples_profile(), 0.05);
  EXPECT_NEAR(far.median_latency_ms, 5.0 * near.median_latency_ms, 1e-6);
  EXPECT_EQ(far.mean_bytes, near.mean_bytes);
}

TEST(ExchangeSurvey, SaysWhyPairsWereRejected) {
  Profile strict = samples_profile();
  strict.samples.limits.max_sigma_translation = 1e-9;
  const ExchangeSurvey survey = survey_at(room_views(0.05, 3.0), strict, 0.005, 1);
  EXPECT_EQ(survey.accepted, 0);
  ASSERT_EQ(survey.rejected.size(), 1u);
  EXPECT_EQ(survey.rejected.begin()->first, cause_of(PoseStatus::kFreeDirection));
  EXPECT_EQ(survey.mean_iterations, 0.0);
}

TEST(ExchangeSurvey, APreviewTakesOneRoundTrip) {
  const ExchangeSurvey survey = survey_at(room_views(0.05, 3.0), Profile(), 0.05);
  EXPECT_EQ(survey.accepted, 2);
  EXPECT_NEAR(survey.median_latency_ms, 100.0, 1e-6);
}

TEST(Distances, AreThoseThatTheStrideAllows) {
  TumFolder folder;
  folder.frame_stride = 10;
  folder.entries.resize(3);
  const Distances distances = distances_of(folder, {5, 10, 20, 30});
  ASSERT_EQ(distances.allowed.size(), 2u);
  EXPECT_EQ(distances.allowed[1], std::make_pair(20, std::size_t{2}));
  ASSERT_EQ(distances.refused.size(), 2u);
  EXPECT_NE(distances.refused[0].second.find("every 10th"), std::string::npos);
  EXPECT_NE(distances.refused[1].second.find("3 entries"), std::string::npos);
}

}  // namespace
}  // namespace rprr
