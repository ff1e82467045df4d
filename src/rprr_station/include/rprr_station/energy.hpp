// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

namespace rprr {

/// The paper's section "Energy Consumption": E = V_o (I_p t_p + I_e t_e + I_s t_s), with the
/// currents that it measured on an eyeBug.
struct EnergyModel {
  double volts = 15.0;            // V_o
  double processing_amps = 0.06;  // I_p
  double encoding_amps = 0.06;    // I_e
  double sending_amps = 0.12;     // I_s
  double bytes_per_second = 1e6;  // of the radio; turns bytes into t_s
};

/// Estimated energy in millijoules. Times in milliseconds; bytes that cross the radio.
double energy_millijoules(const EnergyModel& model, double ms_processing, double ms_encoding,
                          std::size_t bytes);

}  // namespace rprr
