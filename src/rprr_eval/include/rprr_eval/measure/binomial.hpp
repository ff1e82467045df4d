// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace rprr {

/// Exact (Clopper and Pearson 1934) one-sided upper bound on a rate of which `events` were seen in
/// `trials`: the rate at which so few events are as unlikely as 1 - confidence. 1 without trials.
/// With no event in n trials it is about 3/n.
double clopper_pearson_upper(int events, int trials, double confidence = 0.95);

}  // namespace rprr
