// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_radio_ros/peer_sockets.hpp"

#include <gtest/gtest.h>
#include <netinet/in.h>
#include <unistd.h>

#include <chrono>
#include <set>
#include <thread>

namespace rprr {
namespace {

// A port of this host, and a connection to it of which both ends are this process's.
class Loopback {
 public:
  Loopback() : listener_(socket(AF_INET, SOCK_STREAM, 0)) {
    address_.size = sizeof(sockaddr_in);
    auto* const place = reinterpret_cast<sockaddr_in*>(&address_.storage);
    place->sin_family = AF_INET;
    place->sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    bind(listener_, generic(), address_.size);
    getsockname(listener_, generic(), &address_.size);
  }
  ~Loopback() {
    for (const int number : {listener_, opened_, accepted_}) {
      if (number >= 0) close(number);
    }
  }
  void listen_there(int waiting = 5) { ASSERT_EQ(listen(listener_, waiting), 0); }
  void connect_there() {
    listen_there();
    opened_ = socket(AF_INET, SOCK_STREAM, 0);
    ASSERT_EQ(connect(opened_, generic(), address_.size), 0);
    accepted_ = accept(listener_, nullptr, nullptr);
    ASSERT_GE(accepted_, 0);
  }
  void ask() const { ASSERT_EQ(send(opened_, "x", 1, 0), 1); }
  void answer() const { ASSERT_EQ(send(accepted_, "x", 1, 0), 1); }
  const SocketAddress& address() const { return address_; }

 private:
  sockaddr* generic() { return reinterpret_cast<sockaddr*>(&address_.storage); }

  int listener_;
  int opened_ = -1;
  int accepted_ = -1;
  SocketAddress address_;
};

void rest() {
  std::this_thread::sleep_for(std::chrono::milliseconds(60));
}

bool answered_soon(Probe& probe, SteadyTime now) {
  for (int i = 0; i < 50; ++i) {
    if (probe.was_answered(now)) return true;
    rest();
  }
  return false;
}

TEST(PeersOfThisProcess, AHostThatWasConnectedToIsFound) {
  EXPECT_EQ(peers_of_this_process().count("127.0.0.1"), 0U);
  Loopback loopback;
  loopback.connect_there();
  const auto peers = peers_of_this_process();
  ASSERT_EQ(peers.count("127.0.0.1"), 1U);
  EXPECT_TRUE(peers.at("127.0.0.1").is_local);
}

TEST(PeersOfThisProcess, QuietIsTheTimeSinceTheLastByte) {
  Loopback loopback;
  loopback.connect_there();
  for (int i = 0; i < 5; ++i) rest();
  const double before = peers_of_this_process().at("127.0.0.1").quiet;
  EXPECT_GE(before, 0.25);
  loopback.answer();
  EXPECT_LT(peers_of_this_process().at("127.0.0.1").quiet, before);
}

TEST(PeersOfThisProcess, ConnectionsThatOthersOpenedDoNotCount) {
  Loopback loopback;
  loopback.connect_there();
  for (int i = 0; i < 5; ++i) rest();
  loopback.ask();  // heard at the end that was accepted
  EXPECT_GE(peers_of_this_process().at("127.0.0.1").quiet, 0.25);
}

TEST(PeersOfThisProcess, ProbesDoNotCount) {
  Loopback loopback;
  loopback.listen_there();
  Probe probe;
  probe.send(loopback.address(), {});
  rest();
  EXPECT_EQ(peers_of_this_process().count("127.0.0.1"), 1U);
  std::set<int> probes;
  probe.add_sockets(probes);
  EXPECT_EQ(probes.size(), 1U);
  EXPECT_EQ(peers_of_this_process(probes).count("127.0.0.1"), 0U);
}

TEST(Probe, IsAnsweredByAListener) {
  Loopback loopback;
  loopback.listen_there();
  Probe probe;
  EXPECT_FALSE(probe.was_answered({}));
  probe.send(loopback.address(), {});
  EXPECT_TRUE(answered_soon(probe, {}));
  EXPECT_FALSE(probe.was_answered({})) << "an answer counts once";
}

TEST(Probe, IsAnsweredByARefusal) {
  const Loopback loopback;  // bound, but nobody listens
  Probe probe;
  probe.send(loopback.address(), {});
  EXPECT_TRUE(answered_soon(probe, {}));
}

TEST(Probe, NoAnswerIsNone) {
  // A listener with no room for another connection answers nothing at all.
  Loopback loopback;
  loopback.listen_there(0);
  Probe earlier;
  for (int i = 0; i < 4; ++i) earlier.send(loopback.address(), {});
  rest();
  Probe probe;
  probe.send(loopback.address(), {});
  rest();
  EXPECT_FALSE(probe.was_answered(steady_seconds(0.1)));
  EXPECT_FALSE(probe.was_answered(steady_seconds(10.0)));
}

}  // namespace
}  // namespace rprr
