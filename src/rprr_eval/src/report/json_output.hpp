// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>
#include <string>

namespace rprr {

/// JSON lines into a file, or to standard output where no file is named.
class JsonOutput {
 public:
  explicit JsonOutput(const std::string& path) : to_file_(!path.empty()) {
    if (to_file_) file_.open(path);
    if (!good()) std::cerr << "cannot write " << path << "\n";
  }
  bool good() const { return !to_file_ || file_.good(); }
  void write(const nlohmann::json& object) {
    (to_file_ ? static_cast<std::ostream&>(file_) : std::cout) << object << std::endl;
  }

 private:
  bool to_file_;
  std::ofstream file_;
};

}  // namespace rprr
