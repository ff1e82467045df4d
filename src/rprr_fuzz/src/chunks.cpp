// SPDX-License-Identifier: BSD-3-Clause
// Any bytes as a sequence of chunks: u8 stamp, u8 length, then the chunk, whose checksum is made
// good.
#include "fuzz.hpp"
#include "rprr_radio/frame_chunk.hpp"
#include "rprr_wire/bytes.hpp"

using namespace rprr;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  constexpr std::size_t kLargest = 1000;
  FrameAssembler assembler(kLargest, 2);
  ByteView rest(data, size);
  while (rest.size >= 2) {
    const Stamp stamp = rest.data[0] % 4;
    const std::size_t length = std::min<std::size_t>(rest.data[1], rest.size - 2);
    Bytes bytes(rest.data + 2, rest.data + 2 + length);
    rest = rest.from(2 + length);
    parse_chunk(bytes);
    seal(bytes);
    const Result<FrameChunk> chunk = parse_chunk(bytes);
    if (!chunk) continue;
    fuzz::require(chunk->index < chunk->count && chunk->count <= kMostChunks);
    fuzz::require(chunk->piece.size > 0);
    const auto frame = assembler.add(stamp, "frame", *chunk, bytes.size());
    fuzz::require(!frame || frame->data.size() <= kLargest);
  }
  return 0;
}
