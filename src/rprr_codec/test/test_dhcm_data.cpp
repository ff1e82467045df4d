// SPDX-License-Identifier: BSD-3-Clause
// Real depth images, where the data folder is present.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>

#include "rprr_codec/dhcm.hpp"
#include "rprr_geometry/block_mask.hpp"
#include "rprr_synthetic/coded_images.hpp"
#include "rprr_wire/bytes.hpp"

namespace rprr {
namespace {

namespace fs = std::filesystem;

fs::path data_folder() {
  const char* named = std::getenv("RPRR_DATA");
  return named != nullptr ? named : RPRR_DATA_FOLDER;
}

std::vector<fs::path> images_in(const fs::path& folder) {
  std::vector<fs::path> files;
  if (!fs::is_directory(folder)) return files;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() == ".png") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

struct Folder {
  const char* name;
  double ratio;  // to raw 16 bit, that must be reached
};

class DhcmData : public ::testing::TestWithParam<Folder> {};

TEST_P(DhcmData, IsLosslessAndSmall) {
  const std::vector<fs::path> files = images_in(data_folder() / GetParam().name);
  if (files.empty()) GTEST_SKIP() << "no images in " << data_folder() / GetParam().name;
  DhcmEncoder encoder;
  DhcmDecoder decoder;
  double raw = 0.0;
  double coded = 0.0;
  for (const fs::path& file : files) {
    const DepthFrame frame = {cv::imread(file.string(), cv::IMREAD_UNCHANGED), 0.001};
    ASSERT_EQ(frame.counts.type(), CV_16UC1) << file;
    const Bytes payload = encoder.encode(frame);
    const Result<DepthFrame> back = decoder.decode(payload);
    ASSERT_TRUE(back) << file << ": " << back.reason();
    EXPECT_TRUE(synthetic::same(back->counts, frame.counts)) << file;
    const BlockMask mask = synthetic::some_blocks(BlockGrid(frame.width(), frame.height()), 0.25);
    const Result<DepthFrame> blocks = decoder.decode(encoder.encode(frame, mask), mask);
    ASSERT_TRUE(blocks) << file << ": " << blocks.reason();
    EXPECT_TRUE(synthetic::same(blocks->counts, synthetic::only(frame.counts, mask))) << file;
    raw += 2.0 * static_cast<double>(frame.counts.total());
    coded += static_cast<double>(payload.size());
  }
  EXPECT_GT(raw / coded, GetParam().ratio) << GetParam().name;
}

INSTANTIATE_TEST_SUITE_P(
    Folders, DhcmData,
    ::testing::Values(Folder{"kinect_depth_native", 14.0}, Folder{"kitchen/depth", 10.0},
                      Folder{"freiburg1_360/depth", 7.0}, Folder{"office/depth", 8.0},
                      Folder{"household/depth", 4.0}, Folder{"tabletop/depth", 10.0}));

}  // namespace
}  // namespace rprr
