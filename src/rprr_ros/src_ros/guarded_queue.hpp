// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/callback_queue.h>

#include <atomic>
#include <functional>
#include <string>
#include <thread>

namespace rprr {

/// A callback queue with a thread of its own, in which code that we do not know may throw: plugins
/// of image_transport decode in callbacks, and what they throw would end the whole process on any
/// other queue.
class GuardedQueue {
 public:
  /// on_exception is called on the queue's thread with what a callback threw.
  explicit GuardedQueue(std::function<void(const std::string& what)> on_exception);
  /// Subscribers that use the queue must be gone.
  ~GuardedQueue();

  ros::CallbackQueueInterface* queue() { return &queue_; }

 private:
  void run();

  std::function<void(const std::string&)> on_exception_;
  ros::CallbackQueue queue_;
  std::atomic<bool> stop_{false};
  std::thread thread_;  // last: it uses what is above
};

}  // namespace rprr
