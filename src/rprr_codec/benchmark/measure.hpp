// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <time.h>

#include <algorithm>
#include <filesystem>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <vector>

namespace rprr::benchmark {

inline std::vector<cv::Mat> images_in(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  if (std::filesystem::is_directory(folder)) {
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
      if (entry.path().extension() == ".png" || entry.path().extension() == ".jpg") {
        files.push_back(entry.path());
      }
    }
  }
  std::sort(files.begin(), files.end());
  std::vector<cv::Mat> images;
  for (const std::filesystem::path& file : files) {
    images.push_back(cv::imread(file.string(), cv::IMREAD_UNCHANGED));
  }
  return images;
}

// Processor time of this thread, so that a busy machine does not count, or time on the wall.
enum class Clock : clockid_t { kThread = CLOCK_THREAD_CPUTIME_ID, kWall = CLOCK_MONOTONIC };

class Times {
 public:
  explicit Times(Clock clock = Clock::kThread) : clock_(clock) {}

  template <typename Work>
  auto measure(const Work& work) {
    const double start = now();
    auto result = work();
    milliseconds_.push_back(now() - start);
    return result;
  }
  double median() {
    std::sort(milliseconds_.begin(), milliseconds_.end());
    return milliseconds_.empty() ? 0.0 : milliseconds_[milliseconds_.size() / 2];
  }

 private:
  double now() const {
    timespec time = {};
    clock_gettime(static_cast<clockid_t>(clock_), &time);
    return 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
  }

  Clock clock_;
  std::vector<double> milliseconds_;
};

}  // namespace rprr::benchmark
