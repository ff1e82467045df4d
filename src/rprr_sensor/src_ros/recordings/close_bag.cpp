// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/close_bag.hpp"

#include <rosbag/bag.h>

#include <exception>
#include <filesystem>

namespace rprr {

std::string close_bag(std::unique_ptr<rosbag::Bag>& bag, const std::string& part,
                      const std::string& path) {
  try {
    bag->close();
    bag.reset();
  } catch (const std::exception& error) {
    // Its destructor would close it once more, and throw where nothing may: it is left in memory.
    static_cast<void>(bag.release());
    return part + ": cannot be written to its end: " + error.what() + "; is the disk full?";
  }
  std::error_code failed;
  std::filesystem::rename(part, path, failed);
  return failed ? path + ": cannot be put in its place: " + failed.message() : std::string();
}

}  // namespace rprr
