// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "dhcm/bit_io.hpp"
#include "dhcm/scan.hpp"
#include "dhcm/tables.hpp"

namespace rprr::dhcm {

/// An event by the next kMaxCodeLength bits, where residual and run are both found there.
struct JointEntry {
  std::int16_t residual;
  std::uint8_t run;
  std::uint8_t bits;  // low 4: bits taken; 0x40 no reading; 0x80 not found: look both up
};
constexpr std::uint8_t kBitsMask = 0x0F;
constexpr std::uint8_t kJointHole = 0x40;
constexpr std::uint8_t kJointNone = 0x80;
using JointTable = std::array<JointEntry, 1u << kMaxCodeLength>;

void join_tables(const DecodeTable& residuals, const DecodeTable& runs, JointTable& joint);

struct DecodedEvent {
  std::int16_t residual;
  bool hole;
  std::uint32_t run;
};

/// Reads pixels in the order and contexts in which EventCoder wrote them.
class EventReader {
 public:
  EventReader(BitReader& bits, const std::vector<DecodeTable>& tables,
              const std::vector<JointTable>& joint, std::uint16_t largest, int width)
      : bits_(bits),
        tables_(tables),
        joint_(joint),
        largest_(largest),
        north_(static_cast<std::size_t>(width + kLanes)),
        step_(static_cast<std::size_t>(width + kLanes)) {}

  /// False once a rank was not in the value table.
  bool good() const { return good_; }

  void row(const std::vector<Segment>& segments, Surface& surface) {
    for (const Segment& segment : segments) {
      if (segment.north) {
        below_known(segment, surface);
      } else {
        first_row(segment, surface);
      }
    }
  }

 private:
  void below_known(const Segment& segment, Surface& surface);
  void first_row(const Segment& segment, Surface& surface);
  DecodedEvent event(std::size_t context, BitReader& bits);
  DecodedEvent long_event(std::size_t context, BitReader& bits);
  std::uint32_t number(std::size_t table, BitReader& bits);
  void check(std::int16_t rank) { good_ = good_ && static_cast<std::uint16_t>(rank) <= largest_; }

  BitReader& bits_;
  const std::vector<DecodeTable>& tables_;
  const std::vector<JointTable>& joint_;
  std::uint16_t largest_;
  bool good_ = true;
  std::array<std::uint32_t, kContexts> left_{};  // right guesses to come
  std::vector<std::uint8_t> north_;
  std::vector<std::int16_t> step_;
};

}  // namespace rprr::dhcm
