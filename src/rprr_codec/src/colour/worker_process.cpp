// SPDX-License-Identifier: BSD-3-Clause
#include "colour/worker_process.hpp"

#include <dlfcn.h>
#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <cstring>

#include "colour/worker_protocol.hpp"

namespace rprr {
namespace {

constexpr const char* kRelativePath = "/rprr_codec/rprr_colour_worker";

// posix_spawn's two objects, released whatever happens.
struct SpawnSetup {
  posix_spawn_file_actions_t actions;
  posix_spawnattr_t attributes;

  SpawnSetup() {
    posix_spawn_file_actions_init(&actions);
    posix_spawnattr_init(&attributes);
  }
  ~SpawnSetup() {
    posix_spawn_file_actions_destroy(&actions);
    posix_spawnattr_destroy(&attributes);
  }
  SpawnSetup(const SpawnSetup&) = delete;
  SpawnSetup& operator=(const SpawnSetup&) = delete;
};

// The child starts with default signal handling, whatever this process has blocked or ignored.
void reset_signals(posix_spawnattr_t& attributes) {
  sigset_t none;
  sigemptyset(&none);
  sigset_t all;
  sigfillset(&all);
  posix_spawnattr_setsigmask(&attributes, &none);
  posix_spawnattr_setsigdefault(&attributes, &all);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
}

}  // namespace

std::string colour_worker_path() {
  const char* named = std::getenv("RPRR_COLOUR_WORKER");
  if (named != nullptr && *named != '\0') return named;
  Dl_info info;
  if (dladdr(reinterpret_cast<void*>(&colour_worker_path), &info) == 0) return {};
  const std::string library = info.dli_fname;
  const std::size_t slash = library.rfind('/');
  return (slash == std::string::npos ? std::string(".") : library.substr(0, slash)) + kRelativePath;
}

Result<bool> WorkerProcess::start(const std::string& executable, const WorkerLimits& limits) {
  stop();
  int ends[2];
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) {
    return Error{std::string("no socket for the colour worker: ") + std::strerror(errno)};
  }
  SpawnSetup setup;
  posix_spawn_file_actions_adddup2(&setup.actions, ends[1], kWorkerSocket);
  posix_spawn_file_actions_addopen(&setup.actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  reset_signals(setup.attributes);
  std::string name = executable;
  std::string memory = std::to_string(limits.memory);
  std::string seconds = std::to_string(static_cast<long>(std::ceil(limits.seconds)));
  char* const arguments[] = {name.data(), memory.data(), seconds.data(), nullptr};
  const int failure = ::posix_spawn(&pid_, executable.c_str(), &setup.actions, &setup.attributes,
                                    arguments, environ);
  ::close(ends[1]);
  if (failure != 0) {
    ::close(ends[0]);
    pid_ = -1;
    return Error{"cannot start the colour worker '" + executable + "': " + std::strerror(failure) +
                 "; install rprr_codec whole or name the executable in RPRR_COLOUR_WORKER"};
  }
  socket_ = ends[0];
  return true;
}

void WorkerProcess::stop() {
  if (socket_ >= 0) ::close(socket_);
  socket_ = -1;
  if (pid_ <= 0) return;
  ::kill(pid_, SIGKILL);
  while (::waitpid(pid_, nullptr, 0) < 0 && errno == EINTR) {
  }
  pid_ = -1;
}

}  // namespace rprr
