// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_eval/measure/binomial.hpp"

#include <boost/math/distributions/binomial.hpp>

namespace rprr {

double clopper_pearson_upper(int events, int trials, double confidence) {
  using Binomial = boost::math::binomial_distribution<double>;
  if (trials <= 0 || events >= trials) return 1.0;
  return Binomial::find_upper_bound_on_p(trials, events, 1.0 - confidence);
}

}  // namespace rprr
