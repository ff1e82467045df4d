// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "rprr_geometry/stamp.hpp"

namespace rprr {

/// Pairs (index into first, index into second) of stamps at most `window` apart. Each stamp is used
/// once, closest pairs first, as in associate.py of the TUM RGB-D benchmark. The result is ordered
/// by the first stream's stamps; the inputs need no order.
std::vector<std::pair<std::size_t, std::size_t>> associate(const std::vector<Stamp>& first,
                                                           const std::vector<Stamp>& second,
                                                           Duration window);

/// Index of the stamp nearest to `stamp` in an ascending list, if one is at most `window` away.
std::optional<std::size_t> nearest_stamp(const std::vector<Stamp>& ascending, Stamp stamp,
                                         Duration window);

}  // namespace rprr
