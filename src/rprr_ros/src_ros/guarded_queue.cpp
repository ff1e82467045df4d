// SPDX-License-Identifier: BSD-3-Clause
#include "guarded_queue.hpp"

#include <exception>
#include <utility>

namespace rprr {
namespace {

const ros::WallDuration kLook(0.1);  // for the end

}  // namespace

GuardedQueue::GuardedQueue(std::function<void(const std::string& what)> on_exception)
    : on_exception_(std::move(on_exception)), thread_([this] { run(); }) {
}

GuardedQueue::~GuardedQueue() {
  stop_ = true;
  queue_.disable();  // wakes the thread
  thread_.join();
}

void GuardedQueue::run() {
  while (!stop_) {
    try {
      queue_.callOne(kLook);  // of several at once, those behind one that throws would wait
    } catch (const std::exception& error) {
      on_exception_(error.what());
    } catch (...) {
      on_exception_("something unknown");
    }
  }
}

}  // namespace rprr
