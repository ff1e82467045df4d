// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>
#include <ros/ros.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <functional>
#include <string>

namespace rprr {

/// The node under test as a process of its own, which ends with this object: ~command run by a
/// shell, named `name`, with private parameters "_name:=value". `environment` is put before it.
class ChildProcess {
 public:
  ChildProcess(const std::string& name, const std::string& parameters,
               const std::string& environment = "") {
    const std::string command = (environment.empty() ? "exec " : "exec env " + environment + " ") +
                                ros::param::param<std::string>("~command", "false") +
                                " __name:=" + name + " " + parameters;
    ros::param::del("/" + name);  // what the one before it was told
    process_ = fork();
    if (process_ == 0) {
      setpgid(0, 0);
      execl("/bin/sh", "sh", "-c", command.c_str(), nullptr);
      _exit(127);
    }
  }
  ~ChildProcess() {
    kill(process_, SIGINT);
    for (int i = 0; i < 300; ++i) {
      if (ended_ || waitpid(process_, nullptr, WNOHANG) != 0) return;
      ros::WallDuration(0.02).sleep();
    }
    ADD_FAILURE() << "the node does not stop";
    kill(-process_, SIGKILL);
    waitpid(process_, nullptr, 0);
  }
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  bool runs() {
    if (!ended_ && waitpid(process_, nullptr, WNOHANG) == process_) ended_ = true;
    return !ended_;
  }

 private:
  pid_t process_ = -1;
  bool ended_ = false;
};

/// Spins until `ready` or the time is over; returns what `ready` said last.
inline bool spin_until(const std::function<bool()>& ready, double seconds = 20.0) {
  const ros::WallTime end = ros::WallTime::now() + ros::WallDuration(seconds);
  while (ros::ok() && ros::WallTime::now() < end) {
    ros::spinOnce();
    if (ready()) return true;
    ros::WallDuration(0.005).sleep();
  }
  return ready();
}

}  // namespace rprr
