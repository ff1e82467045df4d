// SPDX-License-Identifier: BSD-3-Clause
// What codec objects keep: what doc/dhcm.md states, and no more after many frames than after one.
#include <gtest/gtest.h>

#include <cstdlib>
#include <new>

#include "rprr_codec/dhcm.hpp"
#include "rprr_synthetic/coded_images.hpp"
#include "rprr_wire/bytes.hpp"

namespace {

std::size_t kept = 0;  // bytes of what was allocated and not yet freed, by this single thread
[[maybe_unused]] constexpr std::size_t kHead = alignof(std::max_align_t);

}  // namespace

// Sanitizers have an operator new of their own.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kCounted = false;
#else
constexpr bool kCounted = true;

void* operator new(std::size_t size) {
  auto* const block = static_cast<char*>(std::malloc(size + kHead));
  if (block == nullptr) throw std::bad_alloc();
  *reinterpret_cast<std::size_t*>(block) = size;
  kept += size;
  return block + kHead;
}
void operator delete(void* at) noexcept {
  if (at == nullptr) return;
  char* const block = static_cast<char*>(at) - kHead;
  kept -= *reinterpret_cast<std::size_t*>(block);
  std::free(block);
}
void operator delete(void* at, std::size_t) noexcept {
  operator delete(at);
}
#endif

namespace rprr {
namespace {

constexpr std::size_t kEncoder = (1u << 20) + 16u * 640 * 480;
constexpr std::size_t kDecoder = 1u << 19;

// Kept by what code makes.
template <typename Code>
std::size_t kept_by(const Code& code) {
  const std::size_t before = kept;
  code();
  return kept - before;
}

TEST(DhcmMemory, IsWhatIsStatedAndFlat) {
  if (!kCounted) GTEST_SKIP() << "allocations are the sanitizer's here";
  const DepthFrame frames[] = {synthetic::kinect_like(640, 480), synthetic::noise(640, 480)};
  for (const DhcmMode mode : {DhcmMode::kFast, DhcmMode::kDefault, DhcmMode::kSmall}) {
    for (const DepthFrame& frame : frames) {
      DhcmEncoder encoder(mode);
      DhcmDecoder decoder;
      Bytes payload;
      const DepthFrame other = synthetic::kinect_like(320, 240, 5);
      const std::size_t with_payload = kept_by([&] {
        encoder.encode(other);
        payload = encoder.encode(frame);
      });
      EXPECT_LE(with_payload - payload.capacity(), kEncoder) << "more than stated";
      const cv::Mat counts(frame.counts.size(), CV_16UC1);
      const std::size_t by_decoder =
          kept_by([&] { EXPECT_TRUE(decoder.decode(payload, counts.size(), counts)); });
      EXPECT_LE(by_decoder, kDecoder) << "more than stated";
      const std::size_t more = kept_by([&] {
        for (int i = 0; i < 20; ++i) {
          encoder.encode(frame);
          encoder.encode(other);
          EXPECT_TRUE(decoder.decode(payload, counts.size(), counts));
        }
      });
      EXPECT_LE(static_cast<std::ptrdiff_t>(more), 0) << "grew";
    }
  }
}

}  // namespace
}  // namespace rprr
