// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "dhcm/container.hpp"
#include "dhcm/event_reader.hpp"
#include "dhcm/strip_reader.hpp"
#include "dhcm/values.hpp"
#include "rprr_geometry/block_mask.hpp"
#include "rprr_wire/bytes.hpp"

namespace rprr::dhcm {

/// Somebody's image to be filled in: rows of readings, each stride numbers behind the one before.
struct CountsTarget {
  std::uint16_t* first = nullptr;
  std::size_t stride = 0;
  int width = 0;
  int height = 0;

  std::uint16_t* row(int v) const { return first + static_cast<std::size_t>(v) * stride; }
};

/// Reads what stands between a payload's header and its checksum. Knows no OpenCV.
class BodyDecoder {
 public:
  /// Fills in the pixels that are sent and leaves the others alone. mask is nullptr for the whole
  /// image, or has its size. False if the body is malformed; then the pixels mean nothing.
  bool decode(Body kind, ByteView body, const BlockMask* mask, const CountsTarget& counts);

 private:
  bool decode_events(ByteView body, const BlockMask* mask, const CountsTarget& counts);
  bool decode_strips(ByteView body, const BlockMask* mask, const CountsTarget& counts);
  bool read_values(BitReader& bits);

  bool ranked_ = false;
  std::uint16_t largest_ = 0;  // rank or reading
  ValueTable values_;
  std::vector<std::uint16_t> lookup_;  // what ranks stand for, from rank 0
  Surface surface_;
  std::vector<DecodeTable> tables_;
  std::vector<JointTable> joint_;
  StripTables strip_tables_;
};

}  // namespace rprr::dhcm
