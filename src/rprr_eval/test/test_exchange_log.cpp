// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_eval/exchange/exchange_log.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace rprr {
namespace {

TEST(ExchangeLog, TellsStartedCompletedLostAndAccepted) {
  ExchangeLog log(3);
  EXPECT_FALSE(log.finished());
  for (const std::uint32_t number : {70u, 71u, 72u}) log.start(number);
  EXPECT_EQ(log.started(), 3u);
  log.find(70)->rebuilt = true;
  log.find(70)->accepted = true;
  log.find(71)->rebuilt = true;   // rejected, came whole
  log.find(72)->accepted = true;  // accepted, never rebuilt: lost
  EXPECT_EQ(log.completed(), 2u);
  EXPECT_FALSE(log.finished()) << "one is still to come";
  const nlohmann::json counts = log.summary()["exchanges"];
  EXPECT_EQ(counts,
            nlohmann::json({{"started", 3}, {"completed", 2}, {"lost", 1}, {"accepted", 2}}));
  log.find(72)->rebuilt = true;
  EXPECT_TRUE(log.finished());
}

TEST(ExchangeLog, OnlyTheFirstOnesCount) {
  ExchangeLog log(2);
  for (const std::uint32_t number : {5u, 5u, 6u, 7u}) log.start(number);
  EXPECT_EQ(log.started(), 2u) << "the same number is the same exchange";
  EXPECT_NE(log.find(5), nullptr);
  EXPECT_NE(log.find(6), nullptr);
  EXPECT_EQ(log.find(7), nullptr) << "beyond those wanted";
  EXPECT_EQ(log.find(1), nullptr) << "never started";
}

TEST(ExchangeLog, StartingAgainKeepsWhatIsKnown) {
  ExchangeLog log(2);
  log.start(5);
  log.find(5)->rebuilt = true;
  log.start(5);
  EXPECT_TRUE(log.find(5)->rebuilt);
}

TEST(ExchangeLog, MediansAreOverTheCompletedOnes) {
  ExchangeLog log(4);
  double bytes = 100;
  for (const std::uint32_t number : {1u, 2u, 3u, 4u}) {
    log.start(number);
    log.find(number)->bytes_total = bytes;
    log.find(number)->independent_bytes = 1000;
    log.find(number)->rebuilt = number != 4;  // the largest is lost
    bytes *= 2;
  }
  log.find(2)->psnr = 31.5;
  const nlohmann::json medians = log.summary()["medians"];
  EXPECT_EQ(medians["bytes_total"], 200.0);
  EXPECT_EQ(medians["bytes_share"], 0.2);
  EXPECT_EQ(medians["psnr"], 31.5) << "over those where it is known";
}

TEST(ExchangeLog, WhatWasNotMeasuredIsNull) {
  ExchangeLog log(2);
  EXPECT_TRUE(log.summary()["medians"]["bytes_total"].is_null());
  log.start(1);
  log.find(1)->rebuilt = true;
  log.find(1)->bytes_total = 100;
  const nlohmann::json medians = log.summary()["medians"];
  EXPECT_TRUE(medians["independent_bytes"].is_null());
  EXPECT_TRUE(medians["bytes_share"].is_null());
  EXPECT_TRUE(medians["psnr"].is_null());
  EXPECT_TRUE(medians["pose_error_m"].is_null());
}

TEST(ExchangeLog, PoseErrorsAreThoseOfAcceptedPoses) {
  ExchangeLog log(2);
  log.start(1);
  log.find(1)->rebuilt = true;
  log.find(1)->pose_error = PoseError{5.0, 90.0};
  EXPECT_TRUE(log.summary()["medians"]["pose_error_m"].is_null()) << "rejected: used by nobody";
  log.start(2);
  log.find(2)->rebuilt = log.find(2)->accepted = true;
  log.find(2)->pose_error = PoseError{0.01, 0.5};
  EXPECT_EQ(log.summary()["medians"]["pose_error_m"], 0.01);
  EXPECT_EQ(log.summary()["medians"]["pose_error_deg"], 0.5);
}

TEST(ExchangeLog, TheTableSaysTheSame) {
  ExchangeLog log(2);
  log.start(1);
  log.start(2);
  log.find(1)->rebuilt = log.find(1)->accepted = true;
  log.find(1)->bytes_total = 4321;
  const std::string table = log.table();
  EXPECT_NE(table.find("2 exchanges: 1 completed, 1 lost, 1 poses accepted"), std::string::npos)
      << table;
  EXPECT_NE(table.find("4321"), std::string::npos) << table;
}

}  // namespace
}  // namespace rprr
