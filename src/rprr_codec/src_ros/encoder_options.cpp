// SPDX-License-Identifier: BSD-3-Clause
#include "encoder_options.hpp"

namespace rprr {

void list_options(EncoderOptions& o, OptionTable& table) {
  table.group("The robot");
  table.robot("robot", o.robot, "This robot: /ROBOT/rprr/outgoing to /ROBOT/rprr/encoded")
      .as_wiring();
  table.flag("link_recovery", o.link_recovery,
             "Make the subscription to the station's receipts anew when its host answers again "
             "after a silence; false: left to TCP, which may take as long again as the silence "
             "was");
  list_options(o.codec, table);
  list_options(o.sending, table);
}

OptionTable table_of(EncoderOptions& options) {
  return options_of(options);
}

}  // namespace rprr
