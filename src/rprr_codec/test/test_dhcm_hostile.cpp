// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <random>

#include "rprr_codec/dhcm.hpp"
#include "rprr_geometry/block_mask.hpp"
#include "rprr_synthetic/coded_images.hpp"
#include "rprr_wire/bytes.hpp"

namespace rprr {
namespace {

constexpr DhcmMode kAttackedModes[] = {DhcmMode::kFast, DhcmMode::kDefault, DhcmMode::kSmall};

std::size_t head_of(const Bytes& payload) {
  return 6 + 4 + ((payload[1] & 8) != 0 ? 8 : 4);
}

TEST(DhcmHostile, ACutPayloadIsAnErrorAtEveryByte) {
  DhcmDecoder decoder;
  for (const DhcmMode mode : kAttackedModes) {
    DhcmEncoder encoder(mode);
    for (const DepthFrame& frame : {synthetic::kinect_like(45, 30), synthetic::noise(12, 12)}) {
      const Bytes payload = encoder.encode(frame);
      const std::size_t head = head_of(payload);
      for (std::size_t size = 0; size < payload.size(); ++size) {
        EXPECT_FALSE(decoder.decode(ByteView(payload).first(size))) << "cut to " << size;
        // The same with all lengths and the checksum made good: less data than pixels need.
        if (size < head || size + 4 >= payload.size()) continue;
        Bytes resealed(payload.begin(), payload.begin() + static_cast<std::ptrdiff_t>(size));
        for (std::size_t i = 0; i < 4; ++i) {
          resealed[6 + i] = static_cast<std::uint8_t>((size - head) >> (8 * i));
        }
        seal(resealed);
        EXPECT_FALSE(decoder.decode(resealed)) << "cut to " << size << " and sealed anew";
      }
    }
  }
}

// Damages a payload, which the checksum must find; then makes the checksum good, after which the
// decoder may take it for an image, or not, but must do no harm.
void damage(const Bytes& good, const BlockMask* mask, DhcmDecoder& decoder, std::mt19937& random) {
  Bytes payload = good;
  for (std::uint32_t i = 0; i <= random() % 4; ++i) {
    payload[random() % (payload.size() - 4)] ^= static_cast<std::uint8_t>(1 + random() % 255);
  }
  if (payload == good) return;
  const auto decode = [&] {
    return mask != nullptr ? decoder.decode(payload, *mask) : decoder.decode(payload);
  };
  ASSERT_FALSE(decode()) << "damage that the checksum must find";
  payload.resize(payload.size() - 4);
  seal(payload);
  const Result<DepthFrame> hostile = decode();
  if (hostile && mask != nullptr) {
    ASSERT_EQ(hostile->width(), mask->grid().width);
    ASSERT_EQ(hostile->height(), mask->grid().height);
  }
}

TEST(DhcmHostile, AHundredThousandDamagedPayloadsDoNoHarm) {
  std::mt19937 random(11);
  const BlockGrid grid(43, 30);
  const BlockMask mask = synthetic::some_blocks(grid, 0.5);
  const DepthFrame frame = synthetic::kinect_like(43, 30);
  DhcmDecoder decoder(64 * 64);
  for (const DhcmMode mode : kAttackedModes) {
    DhcmEncoder encoder(mode);
    const Bytes whole = encoder.encode(frame);
    const Bytes masked = encoder.encode(frame, mask);
    for (int trial = 0; trial < 17000; ++trial) {
      ASSERT_NO_FATAL_FAILURE(damage(whole, nullptr, decoder, random));
      ASSERT_NO_FATAL_FAILURE(damage(masked, &mask, decoder, random));
    }
    const Result<DepthFrame> good = decoder.decode(whole);
    ASSERT_TRUE(good) << "hostile payloads left something behind: " << good.reason();
    EXPECT_TRUE(synthetic::same(good->counts, frame.counts));
  }
}

}  // namespace
}  // namespace rprr
