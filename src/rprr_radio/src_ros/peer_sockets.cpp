// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_radio_ros/peer_sockets.hpp"

#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <optional>
#include <set>
#include <vector>

namespace rprr {
namespace {

constexpr Duration kAnswerWithin = from_seconds(2.0);

struct NumericAddress {
  std::string host;
  std::string port;
};

struct Connection {
  NumericAddress local;
  NumericAddress remote;
  SocketAddress remote_address;
  double quiet = 0.0;
};

const sockaddr* pointer(const SocketAddress& address) {
  return reinterpret_cast<const sockaddr*>(&address.storage);
}

std::optional<NumericAddress> numeric(const SocketAddress& address) {
  char host[NI_MAXHOST];
  char port[NI_MAXSERV];
  const int failed = getnameinfo(pointer(address), address.size, host, sizeof(host), port,
                                 sizeof(port), NI_NUMERICHOST | NI_NUMERICSERV);
  if (failed != 0) return {};
  return NumericAddress{host, port};
}

template <typename Ask>  // getsockname or getpeername
std::optional<SocketAddress> ask(int socket, Ask name) {
  SocketAddress address;
  address.size = sizeof(address.storage);
  if (name(socket, reinterpret_cast<sockaddr*>(&address.storage), &address.size) != 0) return {};
  const int family = address.storage.ss_family;
  if (family != AF_INET && family != AF_INET6) return {};
  return address;
}

bool is_listening(int socket) {
  int listens = 0;
  socklen_t size = sizeof(listens);
  return getsockopt(socket, SOL_SOCKET, SO_ACCEPTCONN, &listens, &size) == 0 && listens != 0;
}

// Seconds since bytes came, of an established TCP connection.
std::optional<double> quiet_of(int socket) {
  tcp_info info{};
  socklen_t size = sizeof(info);
  if (getsockopt(socket, IPPROTO_TCP, TCP_INFO, &info, &size) != 0) return {};
  if (info.tcpi_state != TCP_ESTABLISHED) return {};
  return 1e-3 * info.tcpi_last_data_recv;
}

std::vector<int> open_files() {
  std::vector<int> numbers;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator("/proc/self/fd", error)) {
    numbers.push_back(std::atoi(entry.path().filename().c_str()));
  }
  return numbers;
}

std::optional<Connection> connection_of(int socket) {
  const auto remote = ask(socket, getpeername);
  const auto local = remote ? ask(socket, getsockname) : std::nullopt;
  const auto quiet = local ? quiet_of(socket) : std::nullopt;
  if (!quiet) return {};
  const auto local_name = numeric(*local);
  const auto remote_name = numeric(*remote);
  if (!local_name || !remote_name) return {};
  return Connection{*local_name, *remote_name, *remote, *quiet};
}

}  // namespace

std::map<std::string, Peer> peers_of_this_process(const std::set<int>& except) {
  std::set<std::string> own_ports;  // where this process listens
  std::vector<Connection> connections;
  for (const int file : open_files()) {
    if (except.count(file) > 0) continue;
    if (const auto connection = connection_of(file)) {
      connections.push_back(*connection);
    } else if (is_listening(file)) {
      const auto local = ask(file, getsockname);
      const auto name = local ? numeric(*local) : std::nullopt;
      if (name) own_ports.insert(name->port);
    }
  }
  std::map<std::string, Peer> peers;
  for (const Connection& connection : connections) {
    if (own_ports.count(connection.local.port) > 0) continue;  // the other side opened it
    const bool is_local = connection.local.host == connection.remote.host;
    const Peer peer{connection.remote_address, connection.quiet, is_local};
    const auto [known, is_new] = peers.try_emplace(connection.remote.host, peer);
    if (!is_new) known->second.quiet = std::min(known->second.quiet, connection.quiet);
  }
  return peers;
}

Probe::~Probe() {
  for (const Attempt& attempt : attempts_) close(attempt.socket);
}

void Probe::send(const SocketAddress& to, SteadyTime now) {
  const int family = to.storage.ss_family;
  const int number = socket(family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  if (number < 0) return;
  // No farewell: it would be two packets more.
  const linger at_once{1, 0};
  setsockopt(number, SOL_SOCKET, SO_LINGER, &at_once, sizeof(at_once));
  if (connect(number, pointer(to), to.size) != 0 && errno != EINPROGRESS && errno != ECONNREFUSED) {
    close(number);
    return;
  }
  attempts_.push_back({number, now});
}

void Probe::add_sockets(std::set<int>& sockets) const {
  for (const Attempt& attempt : attempts_) sockets.insert(attempt.socket);
}

bool Probe::was_answered(SteadyTime now) {
  bool answered = false;
  for (auto attempt = attempts_.begin(); attempt != attempts_.end();) {
    pollfd state{attempt->socket, POLLOUT, 0};
    const bool ended = poll(&state, 1, 0) > 0;
    int error = 0;
    socklen_t size = sizeof(error);
    getsockopt(attempt->socket, SOL_SOCKET, SO_ERROR, &error, &size);
    answered = answered || (ended && (error == 0 || error == ECONNREFUSED));
    const bool is_over = ended || now - attempt->since > kAnswerWithin;
    if (is_over) close(attempt->socket);
    attempt = is_over ? attempts_.erase(attempt) : std::next(attempt);
  }
  // What else is under way asks the same.
  for (const Attempt& attempt : attempts_) {
    if (answered) close(attempt.socket);
  }
  if (answered) attempts_.clear();
  return answered;
}

}  // namespace rprr
