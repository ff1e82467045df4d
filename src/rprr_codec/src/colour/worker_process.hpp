// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sys/types.h>

#include <string>

#include "rprr_codec/colour_codec.hpp"

namespace rprr {

/// Path of the worker executable: RPRR_COLOUR_WORKER, else beside this library (the same relative
/// place in a devel and an install space).
std::string colour_worker_path();

/// A child process and our end of the socket to it. It leaves when that end is closed, thus also
/// when this process dies.
class WorkerProcess {
 public:
  WorkerProcess() = default;
  ~WorkerProcess() { stop(); }
  WorkerProcess(const WorkerProcess&) = delete;
  WorkerProcess& operator=(const WorkerProcess&) = delete;

  Result<bool> start(const std::string& executable, const WorkerLimits& limits);
  /// Kills the child if there is one, and waits for its end.
  void stop();

  bool running() const { return pid_ > 0; }
  int socket() const { return socket_; }

 private:
  pid_t pid_ = -1;
  int socket_ = -1;
};

}  // namespace rprr
