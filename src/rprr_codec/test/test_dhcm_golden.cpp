// SPDX-License-Identifier: BSD-3-Clause
// Payloads of the format as it is, test/golden/*.dhcm. Whoever changes the format changes the
// version byte and doc/dhcm.md, and writes them anew: RPRR_WRITE_GOLDEN=1 test_dhcm_golden
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <iterator>

#include "rprr_codec/dhcm.hpp"
#include "rprr_geometry/block_mask.hpp"
#include "rprr_synthetic/coded_images.hpp"
#include "rprr_wire/bytes.hpp"

namespace rprr {
namespace {

std::string path_of(const std::string& name) {
  return std::string(RPRR_GOLDEN_FOLDER) + "/" + name + ".dhcm";
}

// The payload of that name, which is what was just encoded, or becomes it.
void expect_golden(const std::string& name, const Bytes& payload) {
  if (std::getenv("RPRR_WRITE_GOLDEN") != nullptr) {
    std::ofstream(path_of(name), std::ios::binary)
        .write(reinterpret_cast<const char*>(payload.data()),
               static_cast<std::streamsize>(payload.size()));
  }
  std::ifstream file(path_of(name), std::ios::binary);
  const Bytes golden((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  EXPECT_EQ(payload, golden) << "the format has changed: " << name;
}

TEST(DhcmGolden, CountsAreAsTheyWere) {
  const DepthFrame frame = synthetic::kinect_like(60, 44);
  const BlockMask mask = synthetic::some_blocks(BlockGrid(60, 44), 0.4);
  DhcmDecoder decoder;
  for (const DhcmMode mode : {DhcmMode::kFast, DhcmMode::kDefault, DhcmMode::kSmall}) {
    DhcmEncoder encoder(mode);
    const std::string name = dhcm_mode_name(mode);
    const Bytes whole = encoder.encode(frame);
    const Bytes masked = encoder.encode(frame, mask);
    expect_golden(name, whole);
    expect_golden(name + "_masked", masked);
    const Result<DepthFrame> back = decoder.decode(whole);
    ASSERT_TRUE(back) << back.reason();
    EXPECT_TRUE(synthetic::same(back->counts, frame.counts));
    const Result<DepthFrame> blocks = decoder.decode(masked, mask);
    ASSERT_TRUE(blocks) << blocks.reason();
    EXPECT_TRUE(synthetic::same(blocks->counts, synthetic::only(frame.counts, mask)));
  }
  expect_golden("ranked", DhcmEncoder().encode(synthetic::kinect_like(160, 120)));
  // Large enough for tables fitted to every other row.
  expect_golden("fast_large",
                DhcmEncoder(DhcmMode::kFast).encode(synthetic::kinect_like(320, 240)));
  expect_golden("stored", DhcmEncoder().encode(synthetic::noise(9, 9)));
}

TEST(DhcmGolden, FloatsAreAsTheyWere) {
  cv::Mat metres(20, 30, CV_32FC1);
  for (int i = 0; i < 600; ++i) {
    metres.at<float>(i / 30, i % 30) = 1.0f + static_cast<float>(i) / 1024.0f;
  }
  DhcmEncoder encoder;
  const Result<Bytes> halves = encoder.encode_float(metres, 0.0);
  const Result<Bytes> quantised = encoder.encode_float(metres, 0.0005);
  ASSERT_TRUE(halves && quantised);
  expect_golden("float_halves", *halves);
  expect_golden("float_quantised", *quantised);
  metres.forEach<float>(
      [](float& z, const int* at) { z = 0.001f * static_cast<float>(900 + *at); });
  const Result<Bytes> grid = encoder.encode_float(metres, 0.0);
  ASSERT_TRUE(grid);
  expect_golden("float_grid", *grid);
}

}  // namespace
}  // namespace rprr
