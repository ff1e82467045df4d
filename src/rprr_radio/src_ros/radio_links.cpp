// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_radio_ros/radio_links.hpp"
#include "rprr_ros/steady_now.hpp"

#include <netdb.h>
#include <ros/network.h>
#include <ros/ros.h>
#include <ros/xmlrpc_manager.h>
#include <xmlrpcpp/XmlRpc.h>

#include <chrono>
#include <cmath>
#include <set>
#include <vector>

namespace rprr {
namespace {

constexpr std::chrono::milliseconds kPeriod(250);

struct HostAndPort {
  std::string host;
  std::uint32_t port = 0;
};

HostAndPort split(const std::string& uri) {
  HostAndPort out;
  if (!ros::network::splitURI(uri, out.host, out.port)) return {};
  return out;
}

bool is_at(const std::string& uri, const std::string& address) {
  const std::string host = split(uri).host;
  if (host == address) return true;
  addrinfo hints{};
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  if (host.empty() || getaddrinfo(host.c_str(), nullptr, &hints, &found) != 0) return false;
  bool is_same = false;
  for (const addrinfo* entry = found; entry != nullptr; entry = entry->ai_next) {
    char name[NI_MAXHOST];
    is_same = is_same || (getnameinfo(entry->ai_addr, entry->ai_addrlen, name, sizeof(name),
                                      nullptr, 0, NI_NUMERICHOST) == 0 &&
                          name == address);
  }
  freeaddrinfo(found);
  return is_same;
}

// A call of this node's own slave API. The result's value, or nothing.
bool call(const char* method, const XmlRpc::XmlRpcValue& parameters, XmlRpc::XmlRpcValue& value) {
  const HostAndPort own = split(ros::XMLRPCManager::instance()->getServerURI());
  if (own.host.empty()) return false;
  try {
    XmlRpc::XmlRpcClient client(own.host.c_str(), static_cast<int>(own.port), "/");
    XmlRpc::XmlRpcValue result;
    if (!client.execute(method, parameters, result) || client.isFault()) return false;
    if (result.getType() != XmlRpc::XmlRpcValue::TypeArray || result.size() < 3) return false;
    value = result[2];
    return true;
  } catch (const XmlRpc::XmlRpcException&) {
    return false;
  }
}

using Publishers = std::set<std::string>;  // URIs

// The publishers that this node is connected to, by topic.
std::map<std::string, Publishers> subscriptions() {
  std::map<std::string, Publishers> out;
  XmlRpc::XmlRpcValue parameters;
  parameters[0] = ros::this_node::getName();
  XmlRpc::XmlRpcValue links;
  if (!call("getBusInfo", parameters, links)) return out;
  if (links.getType() != XmlRpc::XmlRpcValue::TypeArray) return out;
  for (int i = 0; i < links.size(); ++i) {
    XmlRpc::XmlRpcValue& link = links[i];  // number, publisher, direction, transport, topic, ...
    const auto is_text = [&link](int at) {
      return link[at].getType() == XmlRpc::XmlRpcValue::TypeString;
    };
    if (link.size() < 5 || !is_text(1) || !is_text(2) || !is_text(4)) continue;
    if (std::string(link[2]) == "i") out[std::string(link[4])].insert(std::string(link[1]));
  }
  return out;
}

bool tell_publishers(const std::string& topic, const Publishers& publishers) {
  XmlRpc::XmlRpcValue parameters;
  parameters[0] = std::string("/master");
  parameters[1] = topic;
  parameters[2].setSize(static_cast<int>(publishers.size()));
  int at = 0;
  for (const std::string& publisher : publishers) parameters[2][at++] = publisher;
  XmlRpc::XmlRpcValue ignored;
  return call("publisherUpdate", parameters, ignored);
}

}  // namespace

std::size_t renew_subscriptions(const std::string& host, const std::set<std::string>& topics) {
  std::size_t renewed = 0;
  const std::string own = ros::XMLRPCManager::instance()->getServerURI();
  for (const auto& [topic, publishers] : subscriptions()) {
    if (topics.count(topic) == 0) continue;
    Publishers others;
    for (const std::string& publisher : publishers) {
      if (publisher == own || !is_at(publisher, host)) others.insert(publisher);
    }
    if (others.size() == publishers.size()) continue;
    if (tell_publishers(topic, others) && tell_publishers(topic, publishers)) ++renewed;
  }
  return renewed;
}

void show(const RadioLinks::State& state, Health& health) {
  health.show("subscriptions made anew after silence", std::to_string(state.renewed));
  for (const auto& [host, seconds] : state.unanswered_for) {
    health.warn("no way to " + host, host + " does not answer for " +
                                         std::to_string(std::lround(seconds)) +
                                         " s: look at the radio, and at that host");
  }
}

std::shared_ptr<RadioLinks> RadioLinks::look_after(const std::vector<std::string>& topics) {
  static std::mutex mutex;
  static std::weak_ptr<RadioLinks> known;
  const std::lock_guard<std::mutex> lock(mutex);
  std::shared_ptr<RadioLinks> links = known.lock();
  if (!links) {
    links.reset(new RadioLinks);
    known = links;
  }
  const std::lock_guard<std::mutex> state_lock(links->state_mutex_);
  links->topics_.insert(topics.begin(), topics.end());
  return links;
}

RadioLinks::RadioLinks() : thread_([this] { run(); }) {
}

RadioLinks::~RadioLinks() {
  {
    const std::lock_guard<std::mutex> lock(state_mutex_);
    stop_ = true;
  }
  wake_.notify_all();
  thread_.join();
}

RadioLinks::State RadioLinks::state() const {
  const std::lock_guard<std::mutex> lock(state_mutex_);
  return state_;
}

void RadioLinks::run() {
  std::unique_lock<std::mutex> lock(state_mutex_);
  while (!wake_.wait_for(lock, kPeriod, [this] { return stop_; })) {
    lock.unlock();
    if (ros::ok()) look();
    lock.lock();
  }
}

void RadioLinks::look() {
  std::set<std::string> topics;
  {
    const std::lock_guard<std::mutex> lock(state_mutex_);
    topics = topics_;
  }
  std::set<int> probes;
  for (const auto& [name, host] : hosts_) host.probe.add_sockets(probes);
  const std::map<std::string, Peer> peers = peers_of_this_process(probes);
  for (auto host = hosts_.begin(); host != hosts_.end();) {
    host = peers.count(host->first) > 0 ? std::next(host) : hosts_.erase(host);
  }
  std::map<std::string, double> unanswered;
  std::size_t renewed = 0;
  for (const auto& [name, peer] : peers) {
    if (peer.is_local) continue;
    Host& host = hosts_[name];
    const SteadyTime now = steady_now();
    const HostWatch::Step step = host.watch.step(peer.quiet, host.probe.was_answered(now), now);
    if (step == HostWatch::Step::kProbe) host.probe.send(peer.listener, now);
    if (step == HostWatch::Step::kRenew) {
      renewed += renew_subscriptions(name, topics);
      ROS_WARN_STREAM(name << " was out of reach and is back after " << std::lround(peer.quiet)
                           << " s: subscriptions to its nodes are made anew");
    }
    const double seconds = host.watch.unanswered_for(now);
    if (seconds > 0.0) unanswered[name] = seconds;
  }
  const std::lock_guard<std::mutex> lock(state_mutex_);
  state_.renewed += renewed;
  state_.unanswered_for = std::move(unanswered);
}

}  // namespace rprr
