// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_ros/worker.hpp"

#include <utility>

namespace rprr {

Worker::Worker(std::size_t capacity) : capacity_(capacity), thread_([this] { run(); }) {
}

Worker::~Worker() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stop_ = true;
  }
  wake_.notify_one();
  thread_.join();
}

bool Worker::post(std::function<void()> job) {
  bool kept_all = true;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (jobs_.size() >= capacity_) {
      jobs_.pop_front();
      kept_all = false;
    }
    jobs_.push_back(std::move(job));
  }
  wake_.notify_one();
  return kept_all;
}

void Worker::run() {
  for (;;) {
    std::unique_lock<std::mutex> lock(mutex_);
    wake_.wait(lock, [this] { return stop_ || !jobs_.empty(); });
    if (stop_) return;
    const std::function<void()> job = std::move(jobs_.front());
    jobs_.pop_front();
    lock.unlock();
    job();
  }
}

}  // namespace rprr
