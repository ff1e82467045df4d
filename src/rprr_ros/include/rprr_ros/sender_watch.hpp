// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <mutex>
#include <string>

#include "rprr_geometry/stamp.hpp"
#include "rprr_geometry/steady_time.hpp"

namespace rprr {

/// Notices when two nodes publish on a topic that should have one: two robots of one name, or
/// somebody who pretends. Any thread may call it; memory is bounded.
class SenderWatch {
 public:
  /// topic: any name for it; publisher: the node that sent a message now. Returns a text for people
  /// if another node did so within the last seconds.
  std::string note(const std::string& topic, const std::string& publisher, SteadyTime now);

 private:
  std::mutex mutex_;
  std::map<std::string, std::map<std::string, SteadyTime>>
      seen_;  // publishers of a topic, and when
};

}  // namespace rprr
