// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <fstream>
#include <ostream>
#include <string>

namespace rprr {

/// A file of results that is whole or not there: it is written beside its place, as PATH.part, and
/// renamed at the end. Without finish() the part is removed and what was at PATH stays.
class ResultFile {
 public:
  /// An empty path: nothing is opened, and everything that is written is lost.
  explicit ResultFile(const std::string& path);
  ~ResultFile();
  ResultFile(const ResultFile&) = delete;
  ResultFile& operator=(const ResultFile&) = delete;

  std::ostream& stream() { return file_; }
  /// Puts the file in its place. False: see problem().
  bool finish();
  /// One sentence for people; empty: all is well so far.
  const std::string& problem() const { return problem_; }

 private:
  std::string path_;
  std::string part_;  // empty: nothing to be removed
  std::ofstream file_;
  std::string problem_;
};

/// Empty, or why not all that was written to the stream arrived. name: of the stream, for people.
std::string stream_problem(std::ostream& stream, const std::string& name);

}  // namespace rprr
