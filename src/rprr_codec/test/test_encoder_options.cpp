// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "encoder_options.hpp"
#include "rprr_synthetic/option_check.hpp"

namespace rprr {
namespace {

TEST(EncoderOptions, HoldWhatHoldsForEveryTableAndAreDocumented) {
  EncoderOptions options;
  const OptionTable table = table_of(options);
  check_options(table);
  check_document(table, "Private parameters of rprr_codec/Encoder.", RPRR_CONFIG "/encoder.yaml");
}

TEST(EncoderOptions, ABandwidthIsNoneOrEnoughForAChunk) {
  EncoderOptions options;
  const OptionTable table = table_of(options);
  EXPECT_EQ(table.assign("bandwidth", 0), "");
  EXPECT_EQ(table.assign("bandwidth", kLeastBandwidth), "");
  EXPECT_NE(table.assign("bandwidth", kLeastBandwidth - 1.0), "");
  EXPECT_EQ(options.sending.bandwidth, kLeastBandwidth);
}

TEST(SparseColours, AreQualityBytesOrAPsnr) {
  using By = SparseColours::By;
  for (const char* text : {"quality", "bytes:1", "bytes:12000", "psnr:34", "psnr:34.5"}) {
    const auto colours = sparse_colours_of(text);
    ASSERT_TRUE(colours) << text;
    EXPECT_EQ(text_of(*colours), text);
  }
  EXPECT_EQ(sparse_colours_of("bytes:12000")->by, By::kBytes);
  EXPECT_EQ(sparse_colours_of("bytes:12000")->amount, 12000.0);
  EXPECT_EQ(sparse_colours_of("psnr:34.5")->amount, 34.5);
  for (const char* text : {"", "Quality", "quality:40", "bytes", "bytes:", "bytes:0", "bytes:-1",
                           "bytes:1.5", "bytes:1e3", "bytes: 5", "bytes:12k", "bytes:99999999",
                           "psnr:", "psnr:0", "psnr:100", "psnr:nan", "psnr:3.4.5", "jpeg:4"}) {
    EXPECT_FALSE(sparse_colours_of(text)) << text;
  }
}

}  // namespace
}  // namespace rprr
