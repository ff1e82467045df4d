// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_eval/poses/pose_survey.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <set>

#include "room_views.hpp"
#include "rprr_sensor/recordings/tum_writer.hpp"

namespace rprr {
namespace {

// A short recording in the synthetic room, made once for the tests of this file.
class PoseSurvey : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    char name[] = "/tmp/rprr_pose_survey_XXXXXX";
    ASSERT_NE(mkdtemp(name), nullptr);
    root_ = name;
    const Scene room = make_room(2);
    const SensorModel sensor = example_sensor_a(160, 120);
    Result<TumWriter> writer =
        TumWriter::create(root_ + "/room", sensor.camera, 0.001, true, "synthetic");
    ASSERT_TRUE(writer) << writer.reason();
    // Five frames 10 degrees apart, and one that looks the other way.
    for (int k = 0; k < 6; ++k) {
      const double yaw = k < 5 ? 10.0 * k : 200.0;
      const Pose pose = look_along({0.0, 0.0, 1.3}, yaw * M_PI / 180.0, -0.2, 0.0);
      const auto noise = static_cast<std::uint32_t>(k);
      const auto added = writer->add(from_seconds(1.0 + k), sense(room, sensor, pose, noise), pose);
      ASSERT_TRUE(added) << added.reason();
    }
  }
  static void TearDownTestSuite() { std::filesystem::remove_all(root_); }

  static FrameSource source() {
    const Result<TumFolder> folder = open_tum_folder(root_ + "/room");
    EXPECT_TRUE(folder) << folder.reason();
    return FrameSource(*folder);
  }

  static std::string root_;
};
std::string PoseSurvey::root_;

TEST_F(PoseSurvey, BinsEveryOrderedPairByOverlap) {
  FrameSource frames = source();
  const Result<KnownPairs> known = known_pairs(frames, 100);
  ASSERT_TRUE(known) << known.reason();
  EXPECT_EQ(known->entries_used, 6u);
  std::size_t pairs = 0;
  for (std::size_t bin = 0; bin < kOverlapBins.size(); ++bin) {
    for (const KnownPair& pair : known->bins[bin]) {
      ++pairs;
      EXPECT_EQ(overlap_bin(pair.overlap), bin);
      const bool apart = pair.a == 5 || pair.b == 5;
      EXPECT_EQ(pair.overlap < 0.05, apart) << pair.a << ", " << pair.b << ": " << pair.overlap;
    }
  }
  EXPECT_EQ(pairs, 30u);
}

TEST_F(PoseSurvey, TakesNoMoreEntriesThanAsked) {
  FrameSource frames = source();
  const Result<KnownPairs> known = known_pairs(frames, 3);
  ASSERT_TRUE(known) << known.reason();
  EXPECT_EQ(known->entries_used, 3u);
}

TEST_F(PoseSurvey, RunsAMethodOverAPair) {
  FrameSource frames = source();
  const Result<KnownPairs> known = known_pairs(frames, 100);
  ASSERT_TRUE(known) << known.reason();
  ASSERT_FALSE(known->bins[0].empty());
  const auto method = make_icp_ivd();
  const KnownPair& pair = known->bins[0].front();
  const Result<PairRecord> record = survey_pair(frames, pair, *method);
  ASSERT_TRUE(record) << record.reason();
  EXPECT_EQ(record->pair.a, pair.a);
  EXPECT_EQ(record->pair.b, pair.b);
  EXPECT_EQ(record->solved, is_right(record->error));
  EXPECT_GE(record->ms, 0.0);
}

TEST(Pick, IsTheSameForTheSameSeedAndWithoutRepeats) {
  std::vector<KnownPair> bin(50);
  for (std::size_t i = 0; i < bin.size(); ++i) bin[i].a = i;
  const auto first = pick(bin, 20, 7);
  const auto second = pick(bin, 20, 7);
  const auto other = pick(bin, 20, 8);
  std::set<std::size_t> seen;
  bool differs = false;
  for (std::size_t i = 0; i < first.size(); ++i) {
    EXPECT_EQ(first[i].a, second[i].a);
    differs = differs || first[i].a != other[i].a;
    seen.insert(first[i].a);
  }
  EXPECT_EQ(seen.size(), 20u);
  EXPECT_TRUE(differs);
  EXPECT_EQ(pick(bin, 80, 7).size(), 50u) << "there are no more";
}

// A record of a pair whose estimate is so many metres off.
PairRecord record(double metres, bool accepted, double ms = 1.0, double overlap = 1.0) {
  RegistrationResult result;
  result.b_from_a.translation().x() = metres;
  result.accepted = accepted;
  return make_record({0, 1, overlap, Pose::Identity()}, result, ms);
}

TEST(PoseTally, TellsRightFromWrongFromBetween) {
  PoseTally tally;
  for (const double metres : {0.0, 0.12, 0.5}) tally.add(record(metres, true));
  tally.add(record(0.0, false));
  EXPECT_EQ(tally.pairs, 4);
  EXPECT_EQ(tally.solved, 2);
  EXPECT_EQ(tally.accepted, 3);
  EXPECT_EQ(tally.accepted_right, 1);
  EXPECT_EQ(tally.accepted_wrong, 1);
  EXPECT_EQ(tally.wrong_pairs.size(), 1u);
}

TEST(PoseTally, IsOfOneBinOrOfAll) {
  const std::vector<PairRecord> records = {record(0.0, true, 1.0, 0.9), record(0.0, true, 1.0, 0.6),
                                           record(0.5, true, 1.0, 0.6)};
  EXPECT_EQ(tally_of(records, 0).pairs, 1);
  EXPECT_EQ(tally_of(records, 1).pairs, 2);
  EXPECT_EQ(tally_of(records, 1).accepted_wrong, 1);
  EXPECT_EQ(tally_of(records, 2).pairs, 0);
  EXPECT_EQ(tally_of(records, std::nullopt).pairs, 3);
}

TEST(HeadToHead, ComparesErrorsWhereBothSolveAndTimesEverywhere) {
  const std::vector<PairRecord> first = {record(0.01, true, 10.0), record(0.02, true, 20.0),
                                         record(0.50, true, 30.0), record(0.50, true, 40.0),
                                         record(0.01, true, 50.0)};
  const std::vector<PairRecord> other = {record(0.03, true, 100.0), record(0.50, true, 200.0),
                                         record(0.04, true, 300.0), record(0.50, true, 400.0),
                                         record(0.05, false, 500.0)};
  const HeadToHead duel = head_to_head(first, other);
  EXPECT_EQ(duel.both, 2) << "also where the method does not vouch for it";
  EXPECT_EQ(duel.only_first, 1);
  EXPECT_EQ(duel.only_other, 1);
  EXPECT_EQ(duel.neither, 1);
  EXPECT_NEAR(duel.first.metres, 0.01, 1e-12);
  EXPECT_NEAR(duel.other.metres, 0.03, 1e-12);
  EXPECT_NEAR(duel.times_slower, 10.0, 1e-12);
  const HeadToHead turned = head_to_head(other, first);
  EXPECT_EQ(turned.only_first, duel.only_other);
  EXPECT_NEAR(turned.times_slower, 0.1, 1e-12);
}

TEST(HeadToHead, OfNothingIsNothing) {
  EXPECT_EQ(head_to_head({}, {}).both, 0);
  EXPECT_EQ(head_to_head({}, {}).times_slower, 0.0);
}

TEST(OverlapBin, BoundsBelongToTheHigherBin) {
  EXPECT_EQ(overlap_bin(0.7), 0u);
  EXPECT_EQ(overlap_bin(0.699), 1u);
  EXPECT_EQ(overlap_bin(0.05), 3u);
  EXPECT_EQ(overlap_bin(0.0), 4u);
}

}  // namespace
}  // namespace rprr
