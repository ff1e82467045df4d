// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_ros/worker.hpp"

#include <gtest/gtest.h>

#include <future>
#include <vector>

namespace rprr {
namespace {

TEST(Worker, DoesJobsInOrder) {
  std::vector<int> done;
  std::promise<void> end;
  Worker worker(10);
  for (int i = 0; i < 5; ++i) worker.post([&done, i] { done.push_back(i); });
  worker.post([&end] { end.set_value(); });
  end.get_future().wait();
  EXPECT_EQ(done, (std::vector<int>{0, 1, 2, 3, 4}));
}

TEST(Worker, DropsTheOldestWhenFull) {
  std::vector<int> done;
  std::promise<void> begun;
  std::promise<void> release;
  std::promise<void> end;
  Worker worker(2);
  worker.post([&] {
    begun.set_value();
    release.get_future().wait();
  });
  begun.get_future().wait();
  EXPECT_TRUE(worker.post([&done] { done.push_back(1); }));
  EXPECT_TRUE(worker.post([&done] { done.push_back(2); }));
  EXPECT_FALSE(worker.post([&] {
    done.push_back(3);
    end.set_value();
  }));
  release.set_value();
  end.get_future().wait();
  EXPECT_EQ(done, (std::vector<int>{2, 3}));
}

TEST(Worker, EndsWhileJobsWait) {
  int done = 0;
  {
    Worker worker(100);
    for (int i = 0; i < 100; ++i) worker.post([&done] { ++done; });
  }
  EXPECT_LE(done, 100);
}

}  // namespace
}  // namespace rprr
