// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rprr_codec/dhcm.hpp"
#include "rprr_geometry/option_table.hpp"

namespace rprr {

/// How a topic's publisher sends depth by `dhcm`. Parameters of <topic>/dhcm.
struct DhcmSending {
  DhcmMode mode = DhcmMode::kDefault;
  double step = 0.0;  // [m]
};

/// How a topic's publisher sends colour by `pgf`. Parameters of <topic>/pgf.
struct PgfSending {
  int quality = 6;
};

/// What a subscriber accepts by `dhcm`. Parameters of ~dhcm/<topic>.
struct DhcmReceiving {
  double max_megapixels = 68.0;
};

/// What a subscriber accepts by `pgf`. Parameters of ~pgf/<topic>.
struct PgfReceiving {
  double max_megapixels = 68.0;
  double time_limit = 2.0;  // [s]
};

void list_options(DhcmSending& settings, OptionTable& table);
void list_options(PgfSending& settings, OptionTable& table);
void list_options(DhcmReceiving& settings, OptionTable& table);
void list_options(PgfReceiving& settings, OptionTable& table);

}  // namespace rprr
