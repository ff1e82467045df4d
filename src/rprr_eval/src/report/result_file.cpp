// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_eval/report/result_file.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

namespace rprr {

ResultFile::ResultFile(const std::string& path) : path_(path) {
  if (path.empty()) return;
  // A device or a pipe has no place to be put in.
  std::error_code ignored;
  const bool is_place =
      !std::filesystem::exists(path, ignored) || std::filesystem::is_regular_file(path, ignored);
  const std::string opened = is_place ? path + ".part" : path;
  errno = 0;
  file_.open(opened, std::ios::binary);
  if (file_) {
    if (is_place) part_ = opened;
  } else {
    problem_ = path + ": cannot be written: " + std::strerror(errno);
  }
}

ResultFile::~ResultFile() {
  file_.close();
  if (!part_.empty()) std::remove(part_.c_str());
}

bool ResultFile::finish() {
  if (!problem_.empty()) return false;
  if (path_.empty()) return true;
  errno = 0;
  file_.close();  // also flushes
  if (!file_) {
    problem_ = path_ + ": not all of it could be written: " +
               (errno != 0 ? std::strerror(errno) : "is the disk full?");
    return false;
  }
  if (part_.empty()) return true;
  if (std::rename(part_.c_str(), path_.c_str()) != 0) {
    problem_ = path_ + ": cannot be put in its place: " + std::strerror(errno);
    return false;
  }
  part_.clear();
  return true;
}

std::string stream_problem(std::ostream& stream, const std::string& name) {
  stream.flush();
  return stream ? std::string() : name + ": not all of it could be written; is the disk full?";
}

}  // namespace rprr
