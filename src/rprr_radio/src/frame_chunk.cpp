// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_radio/frame_chunk.hpp"
#include "rprr_wire/bytes.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

namespace rprr {
namespace {

constexpr std::size_t kCompleteKept = 8;
constexpr Duration kPatience = from_seconds(3.0);  // chunks follow each other much faster

}  // namespace

bool is_chunk(ByteView data) {
  return data.size > 0 && data.data[0] == kChunkMark;
}

Bytes serialise(const FrameChunk& chunk) {
  ByteWriter writer;
  writer.bytes().reserve(kChunkBytes + chunk.piece.size);
  writer.put<std::uint8_t>(kChunkMark);
  writer.put<std::uint16_t>(chunk.frame);
  writer.put<std::uint16_t>(chunk.index);
  writer.put<std::uint16_t>(chunk.count);
  writer.append(chunk.piece);
  seal(writer.bytes());
  return writer.take();
}

Result<FrameChunk> parse_chunk(ByteView bytes) {
  const ByteView body = unseal(bytes);
  ByteReader reader(body);
  FrameChunk chunk;
  const auto mark = reader.get<std::uint8_t>();
  chunk.frame = reader.get<std::uint16_t>();
  chunk.index = reader.get<std::uint16_t>();
  chunk.count = reader.get<std::uint16_t>();
  if (!reader.ok() || mark != kChunkMark) return Error{"chunk of a frame is damaged"};
  if (chunk.index >= chunk.count || chunk.count > kMostChunks) {
    return Error{"chunk of a frame has an impossible number"};
  }
  chunk.piece = reader.get_view(reader.left());
  if (chunk.piece.size == 0) return Error{"chunk of a frame is empty"};
  return chunk;
}

FrameAssembler::FrameAssembler(std::size_t largest_frame, std::size_t at_once)
    : largest_frame_(largest_frame), at_once_(std::max<std::size_t>(at_once, 1)) {
}

std::optional<FrameAssembler::Frame> FrameAssembler::add(Stamp stamp, const std::string& frame_id,
                                                         const FrameChunk& chunk,
                                                         std::size_t message_bytes,
                                                         SteadyTime now) {
  const auto done = std::make_pair(stamp, chunk.frame);
  if (std::find(complete_.begin(), complete_.end(), done) != complete_.end()) return {};
  const auto partial = find_or_begin(stamp, chunk);
  Bytes& place = partial->pieces[chunk.index];
  partial->frame.message_bytes += message_bytes;
  partial->touched = now;
  if (!place.empty()) return {};  // repeated
  place.assign(chunk.piece.data, chunk.piece.data + chunk.piece.size);
  partial->bytes += chunk.piece.size;
  if (!frame_id.empty()) partial->frame.frame_id = frame_id;
  if (--partial->missing > 0 && partial->bytes <= largest_frame_) return {};

  Partial whole = std::move(*partial);
  partial_.erase(partial);
  if (whole.bytes > largest_frame_) {
    ++incomplete_;
    return {};
  }
  complete_.push_back(done);
  if (complete_.size() > kCompleteKept) complete_.pop_front();
  whole.frame.data.reserve(whole.bytes);
  for (const Bytes& piece : whole.pieces) {
    whole.frame.data.insert(whole.frame.data.end(), piece.begin(), piece.end());
  }
  return std::move(whole.frame);
}

void FrameAssembler::expire(SteadyTime now) {
  const auto is_old = [now](const Partial& partial) { return now - partial.touched > kPatience; };
  const auto kept = std::remove_if(partial_.begin(), partial_.end(), is_old);
  incomplete_ += static_cast<std::size_t>(partial_.end() - kept);
  partial_.erase(kept, partial_.end());
}

std::deque<FrameAssembler::Partial>::iterator FrameAssembler::find_or_begin(
    Stamp stamp, const FrameChunk& chunk) {
  const auto found = std::find_if(partial_.begin(), partial_.end(), [&](const Partial& partial) {
    return partial.is(stamp, chunk.frame);
  });
  if (found != partial_.end()) {
    if (found->pieces.size() == chunk.count) return found;
    partial_.erase(found);
    ++incomplete_;
  }
  if (partial_.size() >= at_once_) {
    partial_.pop_front();
    ++incomplete_;
  }
  Partial partial;
  partial.stamp = stamp;
  partial.number = chunk.frame;
  partial.pieces.resize(chunk.count);
  partial.missing = chunk.count;
  partial_.push_back(std::move(partial));
  return std::prev(partial_.end());
}

}  // namespace rprr
