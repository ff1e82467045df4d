// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_eval/report/result_file.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "rprr_synthetic/temporary_folder.hpp"

namespace rprr {
namespace {

std::string text_in(const std::string& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST(ResultFile, IsThereWholeOrNotAtAll) {
  const TemporaryFolder folder;
  const std::string path = folder.path("results.json");
  {
    ResultFile file(path);
    file.stream() << "half";
    EXPECT_FALSE(std::filesystem::exists(path));
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder.path())) << "a run that ended early leaves nothing";
  ResultFile file(path);
  file.stream() << "whole";
  EXPECT_TRUE(file.finish()) << file.problem();
  EXPECT_EQ(text_in(path), "whole");
  EXPECT_FALSE(std::filesystem::exists(path + ".part"));
}

TEST(ResultFile, KeepsAnEarlierOneUntilItIsWhole) {
  const TemporaryFolder folder;
  folder.write("results.json", "earlier");
  const std::string path = folder.path("results.json");
  { ResultFile(path).stream() << "half"; }
  EXPECT_EQ(text_in(path), "earlier");
}

TEST(ResultFile, WhatCannotBeWrittenIsOneSentenceThatNamesIt) {
  ResultFile nowhere("/nowhere/results.json");
  EXPECT_NE(nowhere.problem().find("/nowhere/results.json"), std::string::npos);
  EXPECT_FALSE(nowhere.finish());
}

// A device on which nothing fits stands for a disk that is full.
TEST(ResultFile, AFullDiskIsToldAtTheEnd) {
  std::ofstream full("/dev/full");
  full << std::string(100000, 'x');
  EXPECT_NE(stream_problem(full, "results.json").find("results.json"), std::string::npos);
  const TemporaryFolder folder;
  const std::string path = folder.path("results.json");
  std::filesystem::create_symlink("/dev/full", path + ".part");
  ResultFile file(path);
  file.stream() << std::string(100000, 'x');
  EXPECT_FALSE(file.finish());
  EXPECT_NE(file.problem().find("results.json"), std::string::npos) << file.problem();
  EXPECT_FALSE(std::filesystem::exists(path));
}

}  // namespace
}  // namespace rprr
