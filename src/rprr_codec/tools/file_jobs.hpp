// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "rprr_geometry/result.hpp"

namespace rprr {

struct FileJob {
  std::filesystem::path in;
  std::filesystem::path out;
  bool named = false;  // the user named this output file, ending and all
};

/// The files of the inputs, in order of their names, and where each goes. A folder stands for the
/// wanted files in it and below. Without an output each goes beside its input; else into that
/// folder, where a tree keeps its shape; a single input file may name its output file. `ending` is
/// that of the outputs. Errors: an input that is not there, none at all, two with one output.
Result<std::vector<FileJob>> plan_jobs(
    const std::vector<std::string>& inputs, const std::string& output, const std::string& ending,
    const std::function<bool(const std::filesystem::path&)>& wanted);

struct JobSizes {
  std::size_t raw = 0;    // bytes of pixels
  std::size_t coded = 0;  // bytes of payload
};

/// Runs all, shows how far it is where that takes long, names each file that fails and goes on.
/// Exit code: 0 if all went well.
int run_jobs(const std::vector<FileJob>& jobs, const std::string& verb,
             const std::function<Result<JobSizes>(const FileJob&)>& run);

/// Makes the folder of an output; refuses to replace a file unless `force`.
Result<bool> prepare_output(const std::filesystem::path& out, bool force);

}  // namespace rprr
