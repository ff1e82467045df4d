// SPDX-License-Identifier: BSD-3-Clause
#include "file_jobs.hpp"

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <iostream>
#include <set>

namespace fs = std::filesystem;

namespace rprr {
namespace {

using Wanted = std::function<bool(const fs::path&)>;

// A line on standard error, from the second second on: rewritten on a terminal, else now and then.
class Progress {
 public:
  Progress(std::string verb, std::size_t total)
      : verb_(std::move(verb)), total_(total), live_(::isatty(STDERR_FILENO) != 0) {}

  void show(std::size_t done) {
    const auto now = std::chrono::steady_clock::now();
    const double seconds = std::chrono::duration<double>(now - start_).count();
    if (seconds < next_ || done == 0 || done == total_) return;
    next_ = seconds + (live_ ? 0.2 : 10.0);
    const double left = seconds / static_cast<double>(done) * static_cast<double>(total_ - done);
    std::fprintf(stderr, "%s%zu of %zu files %s, about %.0f s left%s", live_ ? "\r" : "", done,
                 total_, verb_.c_str(), left, live_ ? "   " : "\n");
    shown_ = live_;
    std::fflush(stderr);
  }
  void clear() {
    if (shown_) std::fprintf(stderr, "\r%60s\r", "");
    shown_ = false;
  }

 private:
  std::string verb_;
  std::size_t total_;
  bool live_;
  bool shown_ = false;
  double next_ = 1.0;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

Result<std::vector<fs::path>> files_below(const fs::path& folder, const Wanted& wanted) {
  std::vector<fs::path> files;
  std::error_code error;
  for (fs::recursive_directory_iterator at(folder, error), end; !error && at != end;
       at.increment(error)) {
    std::error_code dangling;
    if (at->is_regular_file(dangling) && wanted(at->path())) files.push_back(at->path());
  }
  if (error) return Error{folder.string() + ": " + error.message()};
  if (files.empty()) return Error{folder.string() + ": no such files in it"};
  std::sort(files.begin(), files.end());
  return files;
}

FileJob job_of(const fs::path& file, const fs::path& root, const std::string& output,
               const std::string& ending) {
  FileJob job;
  job.in = file;
  job.out = output.empty() ? file : fs::path(output) / file.lexically_relative(root);
  job.out.replace_extension(ending);
  return job;
}

std::string megabytes(std::size_t bytes) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.2f MB", static_cast<double>(bytes) * 1e-6);
  return text;
}

}  // namespace

Result<std::vector<FileJob>> plan_jobs(const std::vector<std::string>& inputs,
                                       const std::string& output, const std::string& ending,
                                       const Wanted& wanted) {
  std::vector<FileJob> jobs;
  std::error_code error;
  for (const std::string& name : inputs) {
    const fs::path input(name);
    if (fs::is_directory(input, error)) {
      const Result<std::vector<fs::path>> files = files_below(input, wanted);
      if (!files) return Error{files.reason()};
      for (const fs::path& file : *files) jobs.push_back(job_of(file, input, output, ending));
    } else if (fs::exists(input, error)) {
      jobs.push_back(job_of(input, input.parent_path(), output, ending));
    } else {
      return Error{name + ": no such file or folder"};
    }
  }
  const bool names_a_file = jobs.size() == 1 && inputs.size() == 1 && !output.empty() &&
                            !fs::is_directory(inputs[0], error) &&
                            !fs::is_directory(output, error) && output.back() != '/';
  if (names_a_file) {
    jobs[0].out = output;
    jobs[0].named = true;
  }
  std::set<fs::path> outputs;
  for (const FileJob& job : jobs) {
    if (!outputs.insert(job.out.lexically_normal()).second) {
      return Error{"two inputs would be written to " + job.out.string()};
    }
  }
  return jobs;
}

int run_jobs(const std::vector<FileJob>& jobs, const std::string& verb,
             const std::function<Result<JobSizes>(const FileJob&)>& run) {
  Progress progress(verb, jobs.size());
  JobSizes sum;
  std::size_t failed = 0;
  for (std::size_t i = 0; i < jobs.size(); ++i) {
    progress.show(i);
    const Result<JobSizes> sizes = run(jobs[i]);
    if (sizes) {
      sum.raw += sizes->raw;
      sum.coded += sizes->coded;
    } else {
      ++failed;
      progress.clear();
      std::cerr << "error: " << jobs[i].in.string() << ": " << sizes.reason() << "\n";
    }
  }
  progress.clear();
  const std::size_t good = jobs.size() - failed;
  std::cerr << good << (good == 1 ? " file " : " files ") << verb;
  if (sum.coded > 0) {
    char ratio[32];
    std::snprintf(ratio, sizeof(ratio), "%.2f",
                  static_cast<double>(sum.raw) / static_cast<double>(sum.coded));
    std::cerr << ", " << megabytes(sum.raw) << " of pixels in " << megabytes(sum.coded)
              << ", ratio " << ratio;
  }
  if (failed > 0) std::cerr << ", " << failed << " failed";
  std::cerr << "\n";
  return failed == 0 ? 0 : 1;
}

Result<bool> prepare_output(const fs::path& out, bool force) {
  std::error_code error;
  if (!force && fs::exists(out, error)) {
    return Error{out.string() + " is there already; --force replaces it"};
  }
  if (out.has_parent_path()) fs::create_directories(out.parent_path(), error);
  if (error) return Error{out.parent_path().string() + ": " + error.message()};
  return true;
}

}  // namespace rprr
