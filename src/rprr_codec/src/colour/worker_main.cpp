// SPDX-License-Identifier: BSD-3-Clause
// Decodes colour images for another process, which may lose this one at any time: libpgf crashes on
// hostile bytes. Arguments: address space in bytes, CPU seconds for one image.
#include <dirent.h>
#include <malloc.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <exception>
#include <opencv2/core.hpp>
#include <vector>

#include "colour/worker_protocol.hpp"
#include "rprr_codec/colour_codec.hpp"
#include "rprr_geometry/camera.hpp"
#include "rprr_wire/bytes.hpp"

namespace {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kSanitized = true;
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
constexpr bool kSanitized = true;
#else
constexpr bool kSanitized = false;
#endif
#else
constexpr bool kSanitized = false;
#endif

void limit(__rlimit_resource resource, rlim_t value) {
  const rlimit both = {value, value};
  ::setrlimit(resource, &both);
}

// Descriptors that the parent did not mark close-on-exec are none of our business.
void close_inherited() {
  std::vector<int> open;
  DIR* list = ::opendir("/proc/self/fd");
  if (list == nullptr) return;
  while (const dirent* entry = ::readdir(list)) {
    const int fd = std::atoi(entry->d_name);
    if (fd > STDERR_FILENO) open.push_back(fd);
  }
  ::closedir(list);
  for (const int fd : open) ::close(fd);
}

// Memory for images stays with the process: mapping it anew for each would take longer than
// decoding small ones.
void keep_memory() {
  constexpr int kLargestMapped = 32 << 20;  // the most that older libraries take
  ::mallopt(M_MMAP_THRESHOLD, kLargestMapped);
  ::mallopt(M_TRIM_THRESHOLD, 256 << 20);
  ::mallopt(M_TOP_PAD, 16 << 20);
}

void enter_limits(rlim_t memory) {
  ::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_NOFILE, STDERR_FILENO + 1);  // nothing can be opened any more
  // Sanitizers map terabytes of shadow.
  if (!kSanitized) limit(RLIMIT_AS, memory);
}

// CPU time is counted over the life of a process: each image gets its share anew.
void allow_cpu(rlim_t seconds) {
  rusage used = {};
  ::getrusage(RUSAGE_SELF, &used);
  const auto so_far =
      static_cast<rlim_t>(used.ru_utime.tv_sec + used.ru_stime.tv_sec) + 1;  // rounded up
  const rlimit both = {so_far + seconds, RLIM_INFINITY};
  ::setrlimit(RLIMIT_CPU, &both);
}

bool reply(const rprr::Result<cv::Mat>& image) {
  rprr::ByteWriter head;
  head.put(static_cast<std::uint8_t>(image ? 1 : 0));
  rprr::ByteView body;
  if (image) {
    body = {image->data, image->total() * image->elemSize()};
  } else {
    const std::string& reason = image.reason();
    const std::size_t length = std::min(reason.size(), rprr::kMaxReason);
    head.put(static_cast<std::uint16_t>(length));
    body = {reinterpret_cast<const std::uint8_t*>(reason.data()), length};
  }
  return rprr::send_all(rprr::kWorkerSocket, head.bytes(), {}) == rprr::Transfer::kDone &&
         rprr::send_all(rprr::kWorkerSocket, body, {}) == rprr::Transfer::kDone;
}

// False when the parent is gone or talks nonsense.
bool serve_one(rprr::ColourDecoder& decoder, rlim_t seconds) {
  const auto receive = [](std::uint8_t* bytes, std::size_t count) {
    return rprr::receive_all(rprr::kWorkerSocket, bytes, count, {}) == rprr::Transfer::kDone;
  };
  rprr::Bytes head(rprr::kRequestHeadBytes);
  if (!receive(head.data(), head.size())) return false;
  rprr::ByteReader reader(head);
  const std::size_t length = reader.get<std::uint32_t>();
  const int width = reader.get<std::uint16_t>();
  const int height = reader.get<std::uint16_t>();
  const std::size_t name_length = reader.get<std::uint8_t>();
  if (length > rprr::kMaxColourPayload || name_length > rprr::kMaxCodecName) return false;
  std::string codec(name_length, '\0');
  rprr::Bytes payload(length);
  if (!receive(reinterpret_cast<std::uint8_t*>(codec.data()), name_length)) return false;
  if (!receive(payload.data(), payload.size())) return false;
  allow_cpu(seconds);
  return reply(decoder.decode(codec, payload, {width, height}));
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) return EXIT_FAILURE;
  // Signals to the parent's process group are the parent's affair: this process ends when its
  // socket closes, so that a shutdown does not look like a hostile payload.
  std::signal(SIGINT, SIG_IGN);
  std::signal(SIGTERM, SIG_IGN);
  try {
    close_inherited();
    keep_memory();
    cv::setNumThreads(1);
    enter_limits(static_cast<rlim_t>(std::strtoull(argv[1], nullptr, 10)));
    const auto seconds = static_cast<rlim_t>(std::strtoul(argv[2], nullptr, 10));
    const auto decoder = rprr::make_local_colour_decoder();
    while (serve_one(*decoder, seconds)) {
    }
  } catch (const std::exception&) {
    return EXIT_FAILURE;
  }
  return EXIT_SUCCESS;
}
