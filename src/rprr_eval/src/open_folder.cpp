// SPDX-License-Identifier: BSD-3-Clause
#include "open_folder.hpp"

#include <iostream>

namespace rprr {

Result<TumFolder> open_folder(const std::string& path) {
  Result<TumFolder> folder = open_tum_folder(path);
  if (folder && !folder->remark.empty()) std::cerr << "note: " << folder->remark << "\n";
  return folder;
}

}  // namespace rprr
