// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_eval/exchange/fault_channel.hpp"
#include "rprr_wire/bytes.hpp"

#include <algorithm>

namespace rprr {

void FaultChannel::set(const Faults& faults) {
  faults_ = faults;
  if (!faults_.down) return;
  counts_.lost += under_way_.size();
  under_way_.clear();
}

void FaultChannel::add(ChannelMessage message, SteadyTime now) {
  ++counts_.came;
  // All are drawn for every message, so that one fault does not shift the others' sequence.
  const bool lost = happens(faults_.lose);
  const bool twice = happens(faults_.duplicate);
  const bool late = happens(faults_.reorder);
  const bool spoilt = happens(faults_.corrupt);
  if (faults_.down || lost || under_way_.size() >= capacity_) {
    ++counts_.lost;
    return;
  }
  const SteadyTime arrival = now + faults_.delay;
  if (twice) {
    ++counts_.duplicated;
    under_way_.emplace(arrival + faults_.late, message.bytes);
  }
  if (spoilt && message.flip_count > 0) {
    ++counts_.corrupted;
    corrupt(message);
  }
  if (late) ++counts_.reordered;
  under_way_.emplace(late ? arrival + faults_.late : arrival, std::move(message.bytes));
}

std::vector<Bytes> FaultChannel::due(SteadyTime now) {
  std::vector<Bytes> messages;
  const auto end = under_way_.upper_bound(now);
  for (auto message = under_way_.begin(); message != end; ++message) {
    messages.push_back(std::move(message->second));
  }
  under_way_.erase(under_way_.begin(), end);
  return messages;
}

bool FaultChannel::happens(double probability) {
  return static_cast<double>(random_()) < probability * 4294967296.0;
}

void FaultChannel::corrupt(ChannelMessage& message) {
  const std::size_t end = std::min(message.bytes.size(), message.flip_from + message.flip_count);
  if (end <= message.flip_from) return;
  for (int i = 0; i < kFlips; ++i) {
    const std::size_t at = message.flip_from + random_() % (end - message.flip_from);
    message.bytes[at] ^= static_cast<std::uint8_t>(1u << (random_() % 8));
  }
}

}  // namespace rprr
