// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "rprr_geometry/steady_time.hpp"
#include "rprr_ros/silence_watch.hpp"

namespace rprr {

/// How often a topic is heard while all is well.
enum class InputKind {
  kStream,     // all the time
  kOnce,       // at least once, as a latched camera_info
  kSometimes,  // when there is a reason: only publishers are missed, not messages
  kRegularly,  // perhaps never; but once it was heard, silence is missed
};

/// What a node needs to hear, and what is missing of it. Knows no ROS: whoever owns it says what
/// was heard. Not for several threads.
class InputWatch {
 public:
  explicit InputWatch(Duration patience = kPatience) : patience_(patience) {}

  struct Problem {
    std::string topic;
    std::string text;  // what is missing, where it was listened for, and the remedy
  };

  /// From now on this topic is needed. what: "colour images"; remedy: "start the camera".
  void expect(const std::string& topic, InputKind kind, const std::string& what,
              const std::string& remedy, SteadyTime now);
  void heard(const std::string& topic, SteadyTime now);
  /// How many nodes publish the topic now, as far as the subscriber is connected with them.
  void connected(const std::string& topic, std::size_t publishers, SteadyTime now);

  /// What has been missing for longer than the patience.
  std::vector<Problem> problems(SteadyTime now) const;

  static constexpr Duration kPatience = from_seconds(3.5);
  /// What was heard regularly may be silent for this long, and longer if it is slow.
  static constexpr Duration kSilence = from_seconds(3.0);

 private:
  struct Input {
    InputKind kind = InputKind::kStream;
    std::string what;
    std::string remedy;
    SteadyTime since;  // that the topic has been needed, or its number of publishers what it is
    std::size_t publishers = 0;
    bool was_heard = false;
  };

  std::string missing(const std::string& topic, const Input& input, SteadyTime now) const;

  const Duration patience_;
  std::map<std::string, Input> inputs_;
  SilenceWatch silence_{kSilence};
};

}  // namespace rprr
