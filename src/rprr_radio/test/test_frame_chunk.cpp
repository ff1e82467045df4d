// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_radio/frame_chunk.hpp"
#include "rprr_wire/bytes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <string>
#include <vector>

namespace rprr {
namespace {

Bytes some_bytes(std::size_t count, unsigned seed) {
  std::mt19937 random(seed);
  Bytes bytes(count);
  for (auto& byte : bytes) byte = static_cast<std::uint8_t>(random());
  return bytes;
}

std::vector<Bytes> in_chunks(const Bytes& data, std::uint16_t number, std::size_t size) {
  std::vector<Bytes> chunks;
  const auto count = static_cast<std::uint16_t>((data.size() + size - 1) / size);
  for (std::uint16_t i = 0; i < count; ++i) {
    const ByteView rest = ByteView(data).from(i * size);
    chunks.push_back(
        serialise(FrameChunk{number, i, count, rest.first(std::min(rest.size, size))}));
  }
  return chunks;
}

// What the last of these chunks that completes a frame yields.
std::optional<FrameAssembler::Frame> add_all(FrameAssembler& assembler, Stamp stamp,
                                             const std::vector<Bytes>& chunks) {
  std::optional<FrameAssembler::Frame> last;
  for (const Bytes& bytes : chunks) {
    const Result<FrameChunk> chunk = parse_chunk(bytes);
    EXPECT_TRUE(chunk) << chunk.reason();
    auto frame = assembler.add(stamp, chunk->index == 0 ? "camera" : "", *chunk, bytes.size());
    if (frame) last = std::move(frame);
  }
  return last;
}

TEST(FrameChunk, WhatIsWrittenIsRead) {
  const Bytes data = some_bytes(100, 1);
  const Bytes bytes = serialise(FrameChunk{65535, 7, 9, data});
  EXPECT_EQ(bytes.size(), data.size() + kChunkBytes);
  EXPECT_TRUE(is_chunk(bytes));
  const Result<FrameChunk> chunk = parse_chunk(bytes);
  ASSERT_TRUE(chunk) << chunk.reason();
  EXPECT_EQ(chunk->frame, 65535);
  EXPECT_EQ(chunk->index, 7);
  EXPECT_EQ(chunk->count, 9);
  EXPECT_EQ(Bytes(chunk->piece.data, chunk->piece.data + chunk->piece.size), data);
}

TEST(FrameChunk, DamageIsFoundAndNonsenseRefused) {
  const Bytes data = some_bytes(60, 2);
  const Bytes good = serialise(FrameChunk{1, 0, 2, data});
  for (std::size_t i = 0; i < good.size(); ++i) {
    Bytes bad = good;
    bad[i] ^= 0x10;
    EXPECT_FALSE(parse_chunk(bad)) << "byte " << i;
    EXPECT_FALSE(parse_chunk(ByteView(good).first(i))) << "cut to " << i;
  }
  EXPECT_FALSE(parse_chunk(serialise(FrameChunk{1, 2, 2, data}))) << "index beyond count";
  EXPECT_FALSE(parse_chunk(serialise(FrameChunk{1, 0, 0, data})));
  EXPECT_FALSE(parse_chunk(serialise(FrameChunk{1, 0, 65535, data}))) << "too many";
  EXPECT_FALSE(parse_chunk(serialise(FrameChunk{1, 0, 2, {}}))) << "empty";
}

TEST(FrameAssembler, AnyOrderAndRepeatedChunksMakeTheFrame) {
  const Bytes data = some_bytes(10007, 3);
  for (unsigned seed = 0; seed < 20; ++seed) {
    std::vector<Bytes> chunks = in_chunks(data, 5, 700);
    for (std::size_t i = 0; i < 4; ++i) chunks.push_back(Bytes(chunks[i]));
    std::shuffle(chunks.begin(), chunks.end(), std::mt19937(seed));
    FrameAssembler assembler;
    const auto frame = add_all(assembler, 99, chunks);
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->data, data);
    EXPECT_EQ(frame->frame_id, "camera");
    EXPECT_FALSE(add_all(assembler, 99, chunks)) << "a frame that is complete comes once";
  }
}

TEST(FrameAssembler, FramesMayLieInEachOther) {
  FrameAssembler assembler;
  const Bytes one = some_bytes(3000, 4);
  const Bytes two = some_bytes(3000, 5);
  const std::vector<Bytes> a = in_chunks(one, 1, 1000);
  const std::vector<Bytes> b = in_chunks(two, 2, 1000);
  EXPECT_FALSE(add_all(assembler, 1, {a[0], a[1]}));
  const auto second = add_all(assembler, 2, b);
  ASSERT_TRUE(second);
  EXPECT_EQ(second->data, two);
  const auto first = add_all(assembler, 1, {a[2]});
  ASSERT_TRUE(first);
  EXPECT_EQ(first->data, one);
  EXPECT_EQ(assembler.incomplete(), 0u);
}

TEST(FrameAssembler, LostChunksCostTheirFrameAndNoMemory) {
  FrameAssembler assembler(1 << 20, 3);
  for (std::uint16_t number = 0; number < 1000; ++number) {
    std::vector<Bytes> chunks = in_chunks(some_bytes(3000, number), number, 1000);
    chunks.pop_back();
    EXPECT_FALSE(add_all(assembler, number, chunks));
  }
  EXPECT_EQ(assembler.incomplete(), 997u) << "three may still be completed";
  const Bytes data = some_bytes(3000, 1);
  const auto frame = add_all(assembler, 5000, in_chunks(data, 7, 1000));
  ASSERT_TRUE(frame) << "the next frame is not affected";
  EXPECT_EQ(frame->data, data);
}

TEST(FrameAssembler, GivesUpFramesOfWhichNothingMoreComes) {
  FrameAssembler assembler;
  const std::vector<Bytes> chunks = in_chunks(some_bytes(3000, 1), 1, 1000);
  const SteadyTime start = steady_seconds(50.0);
  assembler.add(1, "", *parse_chunk(chunks[0]), 1, start);
  assembler.add(1, "", *parse_chunk(chunks[1]), 1, start + from_seconds(2.0));
  assembler.expire(start + from_seconds(4.0));
  EXPECT_EQ(assembler.incomplete(), 0u) << "something came not long ago";
  assembler.expire(start + from_seconds(6.0));
  EXPECT_EQ(assembler.incomplete(), 1u);
  EXPECT_FALSE(assembler.add(1, "", *parse_chunk(chunks[2]), 1, start + from_seconds(6.0)));
}

TEST(FrameAssembler, ChunksThatContradictEachOtherMakeNothing) {
  FrameAssembler assembler;
  const std::vector<Bytes> three = in_chunks(some_bytes(3000, 1), 1, 1000);
  const std::vector<Bytes> two = in_chunks(some_bytes(2000, 2), 1, 1000);
  EXPECT_FALSE(add_all(assembler, 1, {three[0], three[1], two[0], three[2]}));
}

TEST(FrameAssembler, AFrameThatIsTooLongEnds) {
  FrameAssembler assembler(2500);
  const std::vector<Bytes> chunks = in_chunks(some_bytes(5000, 1), 1, 1000);
  EXPECT_FALSE(add_all(assembler, 1, chunks));
  EXPECT_GE(assembler.incomplete(), 1u);
}

}  // namespace
}  // namespace rprr
