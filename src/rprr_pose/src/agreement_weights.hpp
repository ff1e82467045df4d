// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace rprr {

// How a cell counts when two views are compared: as 1 where their depths agree, as -2 where one
// view looked through the other's surface, and as -0.5 where it hides behind that surface, which
// may be right.
constexpr double kViolatingWeight = 2.0;
constexpr double kHiddenWeight = 0.5;

}  // namespace rprr
