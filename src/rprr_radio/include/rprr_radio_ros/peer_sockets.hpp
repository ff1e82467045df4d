// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sys/socket.h>

#include <deque>
#include <map>
#include <set>
#include <string>

#include "rprr_geometry/steady_time.hpp"

namespace rprr {

/// Where something listens.
struct SocketAddress {
  sockaddr_storage storage{};
  socklen_t size = 0;
};

/// A host that this process opened TCP connections to.
struct Peer {
  SocketAddress listener;  // one of the places where the host accepted a connection
  double quiet = 0.0;      // seconds since bytes came on any of them
  bool is_local = false;   // it is this host
};

/// Hosts to which this process has opened connections, by numeric address; sockets in `except`
/// (those of probes) do not count. Reads the process's own sockets (/proc/self/fd, TCP_INFO:
/// Linux); those of other processes are not seen.
std::map<std::string, Peer> peers_of_this_process(const std::set<int>& except = {});

/// Asks a host for a sign of life with a TCP handshake, without waiting for it.
class Probe {
 public:
  Probe() = default;
  ~Probe();
  Probe(const Probe&) = delete;
  Probe& operator=(const Probe&) = delete;

  /// Sends one; those of the last two seconds may still be answered.
  void send(const SocketAddress& to, SteadyTime now);
  /// Whether one was answered since the last call: accepted, or refused.
  bool was_answered(SteadyTime now);
  /// Adds the sockets of probes that may still be answered.
  void add_sockets(std::set<int>& sockets) const;

 private:
  struct Attempt {
    int socket = -1;
    SteadyTime since;
  };
  std::deque<Attempt> attempts_;
};

}  // namespace rprr
