// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <iostream>
#include <nlohmann/json.hpp>
#include <string>

#include "rprr_eval/report/result_file.hpp"

namespace rprr {

/// JSON lines into a file, or to standard output where no file is named.
class JsonOutput {
 public:
  explicit JsonOutput(const std::string& path) : to_file_(!path.empty()), file_(path) {
    if (to_file_ && !file_.problem().empty()) std::cerr << file_.problem() << "\n";
  }
  bool good() const { return !to_file_ || file_.problem().empty(); }
  void write(const nlohmann::json& object) {
    (to_file_ ? file_.stream() : std::cout) << object << std::endl;
  }
  /// The exit code of a command that ends with this one otherwise: 1 where not all was written.
  int finish(int code = 0) {
    const std::string problem = !to_file_        ? stream_problem(std::cout, "standard output")
                                : file_.finish() ? std::string()
                                                 : file_.problem();
    if (problem.empty()) return code;
    std::cerr << problem << "\n";
    return 1;
  }

 private:
  bool to_file_;
  ResultFile file_;
};

}  // namespace rprr
