// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_sensor/recordings/association.hpp"

#include <algorithm>
#include <cstdlib>
#include <numeric>
#include <tuple>

namespace rprr {
namespace {

std::vector<std::size_t> ascending_order(const std::vector<Stamp>& stamps) {
  std::vector<std::size_t> order(stamps.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t i, std::size_t k) { return stamps[i] < stamps[k]; });
  return order;
}

struct Candidate {
  Duration difference;
  std::size_t first;
  std::size_t second;
};

std::vector<Candidate> candidates_within(const std::vector<Stamp>& first,
                                         const std::vector<Stamp>& second, Duration window) {
  std::vector<Candidate> candidates;
  const auto second_order = ascending_order(second);
  std::size_t begin = 0;
  for (const std::size_t i : ascending_order(first)) {
    while (begin < second.size() && second[second_order[begin]] < first[i] - window) ++begin;
    for (std::size_t k = begin; k < second.size(); ++k) {
      const Stamp other = second[second_order[k]];
      if (other > first[i] + window) break;
      candidates.push_back({std::abs(other - first[i]), i, second_order[k]});
    }
  }
  return candidates;
}

}  // namespace

std::vector<std::pair<std::size_t, std::size_t>> associate(const std::vector<Stamp>& first,
                                                           const std::vector<Stamp>& second,
                                                           Duration window) {
  auto candidates = candidates_within(first, second, window);
  std::stable_sort(
      candidates.begin(), candidates.end(),
      [](const Candidate& a, const Candidate& b) { return a.difference < b.difference; });
  std::vector<bool> first_used(first.size(), false);
  std::vector<bool> second_used(second.size(), false);
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (const auto& candidate : candidates) {
    if (first_used[candidate.first] || second_used[candidate.second]) continue;
    first_used[candidate.first] = second_used[candidate.second] = true;
    pairs.emplace_back(candidate.first, candidate.second);
  }
  std::sort(pairs.begin(), pairs.end(), [&](const auto& a, const auto& b) {
    return std::tie(first[a.first], a.first) < std::tie(first[b.first], b.first);
  });
  return pairs;
}

std::optional<std::size_t> nearest_stamp(const std::vector<Stamp>& ascending, Stamp stamp,
                                         Duration window) {
  if (ascending.empty()) return std::nullopt;
  const auto after = std::lower_bound(ascending.begin(), ascending.end(), stamp);
  auto best = after == ascending.end() ? after - 1 : after;
  if (after != ascending.begin() && stamp - *(after - 1) <= std::abs(*best - stamp)) {
    best = after - 1;
  }
  if (std::abs(*best - stamp) > window) return std::nullopt;
  return static_cast<std::size_t>(best - ascending.begin());
}

}  // namespace rprr
