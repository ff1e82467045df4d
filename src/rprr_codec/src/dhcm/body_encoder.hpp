// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "dhcm/container.hpp"
#include "dhcm/events.hpp"
#include "dhcm/strips.hpp"
#include "dhcm/values.hpp"
#include "rprr_geometry/block_mask.hpp"
#include "rprr_wire/bytes.hpp"

namespace rprr::dhcm {

/// Somebody's image: rows of readings, each stride numbers behind the one before.
struct CountsView {
  const std::uint16_t* first = nullptr;
  std::size_t stride = 0;
  int width = 0;
  int height = 0;

  const std::uint16_t* row(int v) const { return first + static_cast<std::size_t>(v) * stride; }
};

/// Writes what stands between a payload's header and its checksum. Knows no OpenCV.
class BodyEncoder {
 public:
  /// mask is nullptr for the whole image, or has its size.
  Body encode(const CountsView& counts, const BlockMask* mask, DhcmMode mode, Bytes& body);

 private:
  bool rank_values(const CountsView& counts, Segments& segments);
  void take_row(const std::uint16_t* in, int width, std::uint16_t* to) const;
  void collect_strips(const CountsView& counts, const BlockMask* mask);
  void collect_events(const CountsView& counts, Segments& segments, const DirectContexts& direct);
  void write_strips(bool quick, Bytes& body);
  Bytes write_events();

  bool ranked_ = false;
  std::vector<std::uint8_t> occurs_;    // by reading
  std::vector<std::uint16_t> rank_of_;  // by reading
  std::vector<std::uint16_t> rows_;
  ValueTable values_;
  EventCoder coder_;
  Histograms histograms_{};
  EncodeTables tables_;
  StripCoder strips_;
};

}  // namespace rprr::dhcm
