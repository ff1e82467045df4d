// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_ros/input_watch.hpp"

#include <cmath>

namespace rprr {

void InputWatch::expect(const std::string& topic, InputKind kind, const std::string& what,
                        const std::string& remedy, SteadyTime now) {
  inputs_[topic] = {kind, what, remedy, now, 0, false};
}

void InputWatch::heard(const std::string& topic, SteadyTime now) {
  const auto found = inputs_.find(topic);
  if (found == inputs_.end()) return;
  found->second.was_heard = true;
  const InputKind kind = found->second.kind;
  if (kind == InputKind::kStream || kind == InputKind::kRegularly) silence_.heard(topic, now);
}

void InputWatch::connected(const std::string& topic, std::size_t publishers, SteadyTime now) {
  const auto found = inputs_.find(topic);
  if (found == inputs_.end() || found->second.publishers == publishers) return;
  found->second.publishers = publishers;
  found->second.since = now;
}

std::vector<InputWatch::Problem> InputWatch::problems(SteadyTime now) const {
  std::vector<Problem> problems;
  for (const auto& [topic, input] : inputs_) {
    std::string text = missing(topic, input, now);
    if (!text.empty()) problems.push_back({topic, std::move(text)});
  }
  return problems;
}

// Empty, or what is missing.
std::string InputWatch::missing(const std::string& topic, const Input& input,
                                SteadyTime now) const {
  const std::string remedy = ": " + input.remedy;
  const bool waits = now - input.since < patience_;
  if (input.publishers == 0) {
    // What came once is enough, whoever sent it may be gone.
    if (waits || (input.kind == InputKind::kOnce && input.was_heard)) return {};
    const std::string begin = input.was_heard ? "no more " : "no ";
    return begin + input.what + ", nobody publishes " + topic + remedy;
  }
  if (input.kind == InputKind::kSometimes) return {};
  if (!input.was_heard) {
    return waits || input.kind == InputKind::kRegularly
               ? std::string()
               : "no " + input.what + " yet on " + topic + ", though somebody publishes it" +
                     remedy;
  }
  const auto silent = silence_.silent_for(topic, now);
  if (!silent) return {};
  return "no " + input.what + " on " + topic + " for " + std::to_string(std::lround(*silent)) +
         " s" + remedy;
}

}  // namespace rprr
