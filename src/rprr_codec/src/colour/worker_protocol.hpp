// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "rprr_wire/bytes.hpp"

namespace rprr {

// Between a decoder and its worker process, on a socket pair, little-endian:
//   request: u32 payload length, u16 width, u16 height, u8 length of the codec's name, name,
//   payload reply:   u8 1 and width * height * 3 bytes BGR, or u8 0, u16 length of the reason,
//   reason

constexpr int kWorkerSocket = 0;  // descriptor in the worker
constexpr std::size_t kRequestHeadBytes = 9;
constexpr std::size_t kMaxCodecName = 32;
constexpr std::size_t kMaxColourPayload = std::size_t{64} << 20;
constexpr std::size_t kMaxReason = 256;

using Deadline = std::optional<std::chrono::steady_clock::time_point>;  // nothing: wait for ever

enum class Transfer { kDone, kClosed, kTimeout };

/// All bytes, without ever raising SIGPIPE.
Transfer send_all(int socket, ByteView bytes, const Deadline& deadline);
Transfer receive_all(int socket, std::uint8_t* bytes, std::size_t count, const Deadline& deadline);

}  // namespace rprr
