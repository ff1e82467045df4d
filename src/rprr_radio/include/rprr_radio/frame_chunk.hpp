// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "rprr_geometry/result.hpp"
#include "rprr_geometry/stamp.hpp"
#include "rprr_geometry/steady_time.hpp"
#include "rprr_wire/bytes.hpp"

namespace rprr {

/// Length of the rprr_msgs/EncodedFrame that carries data_bytes, serialised by ROS.
constexpr std::size_t encoded_message_bytes(std::size_t frame_id_length, std::size_t data_bytes) {
  return ros_header_bytes(frame_id_length) + 4 + ros_array_bytes(data_bytes);
}

/// A piece of an encoded frame: a long frame that goes out in pieces lets short messages pass, and
/// takes its share of a narrow radio evenly. As data of rprr_msgs/EncodedFrame in place of the
/// container: u8 kChunkMark, u16 number of the frame, u16 index, u16 count, the piece, u32 CRC-32
/// of everything before.
struct FrameChunk {
  std::uint16_t frame = 0;  // counted by the sender
  std::uint16_t index = 0;
  std::uint16_t count = 0;
  ByteView piece;
};

/// The first byte of a chunk; that of a container is its version.
constexpr std::uint8_t kChunkMark = 0xC1;
constexpr std::size_t kMostChunks = 4096;
/// Bytes that a chunk adds to its piece.
constexpr std::size_t kChunkBytes = 1 + 3 * 2 + 4;

bool is_chunk(ByteView data);
Bytes serialise(const FrameChunk& chunk);
/// Untrusted bytes. Errors: damaged, no piece in it, more than kMostChunks. The piece points into
/// the bytes.
Result<FrameChunk> parse_chunk(ByteView bytes);

/// Puts one sender's frames together again from chunks in any order, repeated or missing ones
/// among them. Memory is bounded: a few frames at a time, each of a bounded length; the oldest
/// gives way.
class FrameAssembler {
 public:
  struct Frame {
    Bytes data;
    std::string frame_id;           // of the chunk that named one
    std::size_t message_bytes = 0;  // of all its chunks, serialised, repeated ones too
  };

  explicit FrameAssembler(std::size_t largest_frame = std::size_t{8} << 20,
                          std::size_t at_once = 3);

  /// The frame, when this was its last missing chunk. message_bytes: of the message that carried
  /// it. Chunks that contradict those before them (another count, too long) end their frame.
  std::optional<Frame> add(Stamp stamp, const std::string& frame_id, const FrameChunk& chunk,
                           std::size_t message_bytes, SteadyTime now = {});
  /// Gives up frames of which nothing came for a while.
  void expire(SteadyTime now);

  /// Frames of which something was lost.
  std::size_t incomplete() const { return incomplete_; }

 private:
  struct Partial {
    Stamp stamp = 0;
    std::uint16_t number = 0;
    SteadyTime touched;
    std::vector<Bytes> pieces;
    std::size_t missing = 0;
    std::size_t bytes = 0;
    Frame frame;

    bool is(Stamp other_stamp, std::uint16_t other_number) const {
      return stamp == other_stamp && number == other_number;
    }
  };

  std::deque<Partial>::iterator find_or_begin(Stamp stamp, const FrameChunk& chunk);

  std::size_t largest_frame_;
  std::size_t at_once_;
  std::deque<Partial> partial_;  // oldest first
  std::deque<std::pair<Stamp, std::uint16_t>> complete_;
  std::size_t incomplete_ = 0;
};

}  // namespace rprr
