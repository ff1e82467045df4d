// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_eval/measure/median.hpp"

#include <algorithm>

namespace rprr {

double percentile(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  const double place = share * static_cast<double>(values.size() - 1);
  const auto it = values.begin() + static_cast<std::ptrdiff_t>(place);
  std::nth_element(values.begin(), it, values.end());
  return *it;
}

double median(std::vector<double> values) {
  return percentile(std::move(values), 0.5);
}

}  // namespace rprr
