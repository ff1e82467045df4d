// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_eval/timing/preview_timing.hpp"

#include <gtest/gtest.h>

#include "room_views.hpp"
#include "rprr_eval/measure/metrics.hpp"

namespace rprr {
namespace {

Profile default_profile() {
  const Result<Profile> profile = load_profile("default");
  EXPECT_TRUE(profile) << profile.reason();
  return *profile;
}

// Keeps where it was told to start from.
class Recorder final : public Registration {
 public:
  explicit Recorder(std::vector<Pose>& starts) : starts_(starts) {}
  std::string name() const override { return "recorder"; }
  RegistrationResult align(const RgbdFrame&, const RgbdFrame&, const Pose& start) override {
    starts_.push_back(start);
    return {};
  }

 private:
  std::vector<Pose>& starts_;
};

NamedRegistrations recorder(std::vector<Pose>& starts) {
  NamedRegistrations peers;
  peers.push_back(std::make_unique<Recorder>(starts));
  return peers;
}

TEST(PreviewTiming, AWarmStartVerifiesAndThePeersStartFromIt) {
  const RoomViews views = room_views(0.05, 3.0);
  std::vector<Pose> starts;
  const PairTimes times =
      time_pair(views.a, views.b, default_profile(), recorder(starts), WarmStart{}, 4);
  EXPECT_TRUE(times.preview.accepted);
  EXPECT_TRUE(times.preview.warm_verified);
  ASSERT_EQ(times.peers.size(), 1u);
  ASSERT_EQ(starts.size(), 2u);
  EXPECT_TRUE(starts[0].isApprox(Pose::Identity()));
  const PoseError off = pose_error(starts[1], views.truth);
  EXPECT_GT(off.degrees, 0.5);
  EXPECT_LT(off.degrees, 1.5);
  EXPECT_LT(off.metres, 0.08);
}

TEST(PreviewTiming, WithoutAnAcceptedPoseThereIsNoWarmStart) {
  RoomViews views = room_views(0.05, 3.0);
  views.b.depth.counts = cv::Mat::zeros(views.b.depth.counts.size(), CV_16UC1);
  std::vector<Pose> starts;
  const PairTimes times =
      time_pair(views.a, views.b, default_profile(), recorder(starts), WarmStart{}, 4);
  EXPECT_FALSE(times.preview.accepted);
  EXPECT_FALSE(times.preview.warm_verified);
  EXPECT_EQ(starts.size(), 1u);
}

TEST(PreviewTiming, WarmRowsCountVerifiedPairsAlone) {
  std::vector<PairTimes> times(3);
  for (std::size_t i = 0; i < times.size(); ++i) {
    const auto k = static_cast<double>(i);
    times[i].preview = {0.25, 0.75, 0.5, 2.0, 10.0 + k, true, i > 0, 1.0 + k};
    times[i].peers = {{100.0 + k, 50.0 + k}};
  }
  const TimingSummary summary = summarise(times, {"peer"});
  EXPECT_EQ(summary.pairs, 3u);
  EXPECT_EQ(summary.accepted, 3u);
  EXPECT_EQ(summary.warm_verified, 2u);
  EXPECT_EQ(summary.cold.time.pairs, 3u);
  EXPECT_DOUBLE_EQ(summary.cold.time.median, 11.0);
  EXPECT_EQ(summary.warm.time.pairs, 2u);
  EXPECT_DOUBLE_EQ(summary.warm.time.median, 2.0);
  EXPECT_DOUBLE_EQ(summary.all_warm.time.median, 5.5);
  EXPECT_DOUBLE_EQ(summary.all_cold.time.median, 14.5);
  ASSERT_EQ(summary.peers_warm.size(), 1u);
  EXPECT_EQ(summary.peers_warm[0].time.pairs, 2u);
  EXPECT_DOUBLE_EQ(summary.peers_warm[0].time.median, 51.0);
  EXPECT_DOUBLE_EQ(summary.peers_cold[0].time.median, 101.0);
}

TEST(PreviewTiming, NothingMeasuredIsNoTime) {
  const TimingSummary summary = summarise(std::vector<PairTimes>{}, {"peer"});
  EXPECT_EQ(summary.pairs, 0u);
  EXPECT_EQ(summary.warm.time.pairs, 0u);
  EXPECT_EQ(spread({}).p95, 0.0);
}

}  // namespace
}  // namespace rprr
