// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <random>
#include <vector>

#include "rprr_geometry/stamp.hpp"
#include "rprr_wire/bytes.hpp"

namespace rprr {

/// Makes hostile messages out of good ones; the same seed makes the same ones.
class Mutator {
 public:
  explicit Mutator(std::uint32_t seed) : random_(seed) {}

  std::size_t below(std::size_t count) { return random_() % count; }
  bool once_in(std::size_t times) { return below(times) == 0; }
  std::uint8_t byte() { return static_cast<std::uint8_t>(random_()); }
  template <typename T>
  const T& one_of(const std::vector<T>& all) {
    return all[below(all.size())];
  }

  /// Stamps that meet each other often, and the ends of what ros::Time can say.
  Stamp stamp() {
    constexpr Stamp kLast = 4294967295999999999;
    switch (below(8)) {
      case 0:
        return kLast;
      case 1:
        return 0;
      case 2:
        return static_cast<Stamp>((static_cast<std::uint64_t>(random_()) << 30) % kLast);
      default:
        return static_cast<Stamp>(1000 + below(12));
    }
  }
  std::vector<Stamp> stamps(std::size_t most) {
    std::vector<Stamp> all(below(most + 1));
    for (Stamp& one : all) one = stamp();
    return all;
  }

  /// One of: as it is, noise, cut off, grown, bits flipped; half of them with a checksum that fits.
  Bytes mutate(Bytes data) {
    const bool sealed = once_in(2);
    if (sealed && data.size() >= 4) data.resize(data.size() - 4);
    switch (below(6)) {
      case 0:
        break;
      case 1:
        data.resize(below(200));
        for (std::uint8_t& one : data) one = byte();
        break;
      case 2:
        data.resize(below(data.size() + 1));
        break;
      case 3:
        for (std::size_t i = below(64); i > 0; --i) data.push_back(byte());
        break;
      case 4:  // lengths and versions are at the beginning
        if (!data.empty()) data[below(std::min<std::size_t>(data.size(), 40))] = byte();
        break;
      default:
        for (std::size_t i = 1 + below(8); i > 0 && !data.empty(); --i) {
          data[below(data.size())] ^= static_cast<std::uint8_t>(1u << below(8));
        }
        break;
    }
    if (sealed) seal(data);
    return data;
  }

 private:
  std::mt19937 random_;
};

/// Memory of this process that is in RAM. Sanitizers keep what is freed: 0 there.
inline std::size_t resident_bytes() {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  return 0;
#else
  std::size_t total = 0;
  std::size_t resident = 0;
  std::ifstream("/proc/self/statm") >> total >> resident;
  return resident * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
#endif
}

}  // namespace rprr
