// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_station/energy.hpp"

namespace rprr {

double energy_millijoules(const EnergyModel& model, double ms_processing, double ms_encoding,
                          std::size_t bytes) {
  const double ms_sending =
      model.bytes_per_second > 0 ? 1e3 * static_cast<double>(bytes) / model.bytes_per_second : 0;
  return model.volts * (model.processing_amps * ms_processing + model.encoding_amps * ms_encoding +
                        model.sending_amps * ms_sending);
}

}  // namespace rprr
