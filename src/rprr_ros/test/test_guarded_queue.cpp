// SPDX-License-Identifier: BSD-3-Clause
#include "guarded_queue.hpp"

#include <gtest/gtest.h>

#include <boost/make_shared.hpp>
#include <chrono>
#include <stdexcept>
#include <vector>

namespace rprr {
namespace {

class Job : public ros::CallbackInterface {
 public:
  explicit Job(std::function<void()> work) : work_(std::move(work)) {}
  CallResult call() override {
    work_();
    return Success;
  }

 private:
  std::function<void()> work_;
};

TEST(GuardedQueue, WhatACallbackThrowsIsToldAndTheRestGoesOn) {
  std::atomic<int> done{0};
  std::atomic<int> thrown{0};
  {
    GuardedQueue queue([&](const std::string& what) {
      EXPECT_TRUE(what == "no decoder" || what == "something unknown") << what;
      ++thrown;
    });
    for (int i = 0; i < 30; ++i) {
      queue.queue()->addCallback(boost::make_shared<Job>([&done, i] {
        if (i % 3 == 0) throw std::runtime_error("no decoder");
        if (i % 3 == 1) throw i;
        ++done;
      }));
    }
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(10);
    while (done + thrown < 30 && std::chrono::steady_clock::now() < end) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }
  EXPECT_EQ(done, 10);
  EXPECT_EQ(thrown, 20);
}

TEST(GuardedQueue, EndsWhileNothingComes) {
  GuardedQueue([](const std::string&) {});
}

}  // namespace
}  // namespace rprr
