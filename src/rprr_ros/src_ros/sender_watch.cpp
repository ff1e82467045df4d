// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_ros/sender_watch.hpp"

#include <iterator>

namespace rprr {
namespace {

constexpr Duration kRecent = from_seconds(3.0);
constexpr std::size_t kMostTopics = 256;
constexpr std::size_t kMostPublishers = 8;

}  // namespace

std::string SenderWatch::note(const std::string& topic, const std::string& publisher,
                              SteadyTime now) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (seen_.size() >= kMostTopics && seen_.count(topic) == 0) return {};
  std::map<std::string, SteadyTime>& publishers = seen_[topic];
  for (auto other = publishers.begin(); other != publishers.end();) {
    other = now - other->second > kRecent ? publishers.erase(other) : std::next(other);
  }
  if (publishers.size() < kMostPublishers || publishers.count(publisher) > 0) {
    publishers[publisher] = now;
  }
  if (publishers.size() < 2) return {};
  std::string text = "messages of this robot come from more than one node (";
  for (const auto& [name, heard] : publishers) {
    text += (name == publishers.begin()->first ? "" : ", ") + name;
  }
  return text + "): give every robot a name of its own, and look who else publishes here";
}

}  // namespace rprr
