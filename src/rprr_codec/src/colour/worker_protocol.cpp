// SPDX-License-Identifier: BSD-3-Clause
#include "colour/worker_protocol.hpp"
#include "rprr_wire/bytes.hpp"

#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>

namespace rprr {
namespace {

Transfer wait_for(int socket, short events, const Deadline& deadline) {
  while (true) {
    int timeout = -1;
    if (deadline) {
      const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(
          *deadline - std::chrono::steady_clock::now());
      if (left.count() <= 0) return Transfer::kTimeout;
      timeout = static_cast<int>(std::min<std::int64_t>(left.count() + 1, 1 << 20));
    }
    pollfd poll_fd = {socket, events, 0};
    const int ready = ::poll(&poll_fd, 1, timeout);
    if (ready > 0) return Transfer::kDone;
    if (ready < 0 && errno != EINTR) return Transfer::kClosed;
  }
}

template <typename Move>
Transfer transfer(int socket, std::size_t count, short events, const Deadline& deadline,
                  const Move& move) {
  for (std::size_t done = 0; done < count;) {
    const ssize_t moved = move(done);
    if (moved > 0) {
      done += static_cast<std::size_t>(moved);
    } else if (moved < 0 && (errno == EAGAIN || errno == EWOULDBLOCK)) {
      const Transfer waited = wait_for(socket, events, deadline);
      if (waited != Transfer::kDone) return waited;
    } else if (moved == 0 || errno != EINTR) {
      return Transfer::kClosed;
    }
  }
  return Transfer::kDone;
}

}  // namespace

Transfer send_all(int socket, ByteView bytes, const Deadline& deadline) {
  return transfer(socket, bytes.size, POLLOUT, deadline, [&](std::size_t done) {
    return ::send(socket, bytes.data + done, bytes.size - done, MSG_NOSIGNAL | MSG_DONTWAIT);
  });
}

Transfer receive_all(int socket, std::uint8_t* bytes, std::size_t count, const Deadline& deadline) {
  return transfer(socket, count, POLLIN, deadline, [&](std::size_t done) {
    return ::recv(socket, bytes + done, count - done, MSG_DONTWAIT);
  });
}

}  // namespace rprr
