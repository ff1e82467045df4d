// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>

namespace rprr {

/// One thread that does jobs in order, so that callbacks return at once. The queue is bounded: when
/// it is full the oldest job is dropped, since new data are worth more than old.
class Worker {
 public:
  explicit Worker(std::size_t capacity);
  /// Finishes the job under way, drops the rest.
  ~Worker();
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  /// False if an older job was dropped to make room.
  bool post(std::function<void()> job);

 private:
  void run();

  const std::size_t capacity_;
  std::mutex mutex_;
  std::condition_variable wake_;
  std::deque<std::function<void()>> jobs_;
  bool stop_ = false;
  std::thread thread_;  // last: starts when everything else is ready
};

}  // namespace rprr
