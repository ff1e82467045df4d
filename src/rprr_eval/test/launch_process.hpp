// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>
#include <ros/ros.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <string>

namespace rprr {

/// roslaunch as a process of its own.
class Launch {
 public:
  explicit Launch(const std::string& arguments) {
    const std::string command = "exec roslaunch " + arguments;
    process_ = fork();
    if (process_ == 0) {
      setpgid(0, 0);
      execl("/bin/sh", "sh", "-c", command.c_str(), nullptr);
      _exit(127);
    }
  }
  ~Launch() {
    kill(process_, SIGINT);
    for (int i = 0; i < 1500; ++i) {
      if (waitpid(process_, nullptr, WNOHANG) != 0) return;
      ros::WallDuration(0.02).sleep();
    }
    ADD_FAILURE() << "roslaunch does not end";
    kill(-process_, SIGKILL);
    waitpid(process_, nullptr, 0);
  }
  Launch(const Launch&) = delete;
  Launch& operator=(const Launch&) = delete;

 private:
  pid_t process_ = -1;
};

}  // namespace rprr
