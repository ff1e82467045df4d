// SPDX-License-Identifier: BSD-3-Clause
// Medians of processor time that a preview takes, over the frames of folders with depth/ and rgb/
// in the layout of the TUM benchmark, or over a synthetic frame without any folder:
//   rprr_geometry_benchmark [FOLDER...]
#include <time.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

#include "../test/preview_scene.hpp"
#include "rprr_wire/bytes.hpp"
#include "rprr_wire/preview.hpp"

namespace {

namespace fs = std::filesystem;

constexpr int kRepeats = 7;
constexpr double kStep = 0.003;
constexpr int kQuality = 40;

struct Frame {
  rprr::DepthFrame depth;
  cv::Mat bgr;
};

std::vector<fs::path> files_in(const fs::path& folder) {
  std::vector<fs::path> files;
  if (fs::is_directory(folder)) {
    for (const auto& entry : fs::directory_iterator(folder)) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

// The n-th depth with the n-th colour: near enough for times.
std::vector<Frame> frames_in(const fs::path& folder) {
  const std::vector<fs::path> depths = files_in(folder / "depth");
  const std::vector<fs::path> colours = files_in(folder / "rgb");
  std::vector<Frame> frames;
  for (std::size_t i = 0; i < std::min(depths.size(), colours.size()); ++i) {
    Frame frame{{cv::imread(depths[i].string(), cv::IMREAD_UNCHANGED), 0.001},
                cv::imread(colours[i].string(), cv::IMREAD_COLOR)};
    if (frame.depth.counts.type() == CV_16UC1) frames.push_back(frame);
  }
  return frames;
}

// Processor time of this thread, so that a busy machine does not count.
double now_ms() {
  timespec time = {};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
}

class Times {
 public:
  template <typename Work>
  auto measure(const Work& work) {
    const double start = now_ms();
    auto result = work();
    milliseconds_.push_back(now_ms() - start);
    return result;
  }
  double median() {
    std::sort(milliseconds_.begin(), milliseconds_.end());
    return milliseconds_.empty() ? 0.0 : milliseconds_[milliseconds_.size() / 2];
  }

 private:
  std::vector<double> milliseconds_;
};

void benchmark(const std::vector<Frame>& frames, bool exact) {
  Times making, encoding, decoding;
  double bytes = 0.0;
  for (const Frame& frame : frames) {
    for (int i = 0; i < kRepeats; ++i) {
      const rprr::BlockPreview preview = making.measure([&] {
        return exact ? rprr::make_exact_preview(frame.depth, frame.bgr)
                     : rprr::make_preview(frame.depth, frame.bgr, kStep);
      });
      const rprr::Bytes payload =
          encoding.measure([&] { return rprr::encode_preview(preview, kQuality); });
      decoding.measure([&] { return rprr::decode_preview(payload); });
      bytes += static_cast<double>(payload.size()) / kRepeats;
    }
  }
  const double count = std::max<double>(static_cast<double>(frames.size()), 1.0);
  std::printf("  %s: %zu frames, make %.3f ms, encode %.3f ms, decode %.3f ms, mean bytes %.0f\n",
              exact ? "readings     " : "steps of 0.003", frames.size(), making.median(),
              encoding.median(), decoding.median(), bytes / count);
}

void benchmark(const std::string& name, const std::vector<Frame>& frames) {
  std::printf("%s\n", name.c_str());
  for (const bool exact : {false, true}) benchmark(frames, exact);
}

}  // namespace

int main(int argc, char** argv) {
  const auto is_folder = [](const char* path) { return std::filesystem::is_directory(path); };
  if (!std::all_of(argv + 1, argv + argc, is_folder)) {
    std::fprintf(stderr,
                 "Usage: rprr_geometry_benchmark [FOLDER...]\nTimes of block previews, over "
                 "folders in the layout of the TUM benchmark or a synthetic frame.\n");
    return 2;
  }
  cv::setNumThreads(1);
  if (argc == 1) {
    rprr::PreviewScene scene;
    scene.quantise();
    benchmark("synthetic 640x480", std::vector<Frame>(20, Frame{scene.depth, scene.bgr}));
  }
  for (int i = 1; i < argc; ++i) benchmark(argv[i], frames_in(argv[i]));
  return 0;
}
