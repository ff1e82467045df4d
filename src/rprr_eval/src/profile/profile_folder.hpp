// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <dlfcn.h>

#include <filesystem>
#include <string>

namespace rprr {

/// Where the profiles are: package rprr_bringup has them in the share folder of the space, devel or
/// install, whose lib folder this library lies in. Empty if the library cannot be found.
inline std::string profile_folder() {
  Dl_info info;
  if (dladdr(reinterpret_cast<const void*>(&profile_folder), &info) == 0 || !info.dli_fname) {
    return {};
  }
  return (std::filesystem::absolute(info.dli_fname).parent_path().parent_path() /
          "share/rprr_bringup/config/profiles")
      .string();
}

}  // namespace rprr
