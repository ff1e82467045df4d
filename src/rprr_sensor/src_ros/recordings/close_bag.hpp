// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>

namespace rosbag {
class Bag;
}

namespace rprr {

/// Closes a bag that was written to PATH.part and puts it at PATH. Empty, or one sentence that says
/// why not: then what there is stays at PATH.part. The bag is gone afterwards in any case.
std::string close_bag(std::unique_ptr<rosbag::Bag>& bag, const std::string& part,
                      const std::string& path);

}  // namespace rprr
