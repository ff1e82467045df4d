// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <dlfcn.h>

#include <filesystem>
#include <string>

namespace rprr {

/// Where the profiles are: beside the installed library (lib/../share), else in the source tree
/// that this was built from.
inline std::string profile_folder() {
  Dl_info info;
  if (dladdr(reinterpret_cast<const void*>(&profile_folder), &info) != 0 && info.dli_fname) {
    const auto installed = std::filesystem::absolute(info.dli_fname).parent_path().parent_path() /
                           "share/rprr_eval/config/profiles";
    if (std::filesystem::exists(installed)) return installed.string();
  }
  return RPRR_EVAL_SOURCE_DIR "/config/profiles";
}

}  // namespace rprr
