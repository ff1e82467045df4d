// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "dhcm/bit_io.hpp"

namespace rprr::dhcm {

/// The distinct readings of a frame, ascending: rank r (from 1) stands for values[r - 1]. Sensors
/// that measure disparity know some hundred of the 65535.
class ValueTable {
 public:
  /// From 65536 marks of the values that occur; mark 0 is not looked at.
  void collect(const std::vector<std::uint8_t>& occurs);
  /// Whether ranks instead of values save more than the table costs, for so many readings.
  bool pays(std::size_t readings) const;
  const std::vector<std::uint16_t>& values() const { return values_; }

  void write(BitWriter& bits) const;
  /// False if the bits are no table.
  bool read(BitReader& bits);

 private:
  std::vector<std::uint16_t> values_;
};

}  // namespace rprr::dhcm
