// SPDX-License-Identifier: BSD-3-Clause
#include <ros/callback_queue.h>
#include <ros/ros.h>

#include <CLI/CLI.hpp>
#include <array>
#include <cstdio>
#include <ctime>
#include <exception>
#include <iostream>

#include "progress.hpp"
#include "rprr_sensor_ros/input_recorder.hpp"

namespace {

struct Options {
  std::vector<std::string> robots = {"eyebug_a", "eyebug_b"};
  double minutes = 5.0;
  double megabytes = 4000.0;
  std::string output;
  std::string compression = "none";
  bool tf = false;
};

std::string name_by_time() {
  std::array<char, 64> name{};
  const std::time_t now = std::time(nullptr);
  std::strftime(name.data(), name.size(), "inputs_%Y-%m-%d-%H-%M-%S.bag", std::localtime(&now));
  return name.data();
}

/// "12 s of 300, 132 MB of 4000, messages 360 12 360 | 361 12 361", kept up to date.
void show(const rprr::InputRecorder& recorder, const Options& options) {
  std::fprintf(stderr, "\r%.0f s of %.0f, %.0f MB of %.0f, messages", recorder.seconds(),
               60.0 * options.minutes, recorder.megabytes(), options.megabytes);
  std::size_t topic = 0;
  for (const auto& count : recorder.counts()) {
    const char* mark = topic > 0 && topic % 3 == 0 ? " |" : "";
    std::fprintf(stderr, "%s %llu", mark, static_cast<unsigned long long>(count.messages));
    ++topic;
  }
  std::fprintf(stderr, "  ");
}

/// What was recorded, and what is missing; the exit status.
int summarise(const rprr::InputRecorder& recorder) {
  int status = 0;
  std::cerr << std::endl;
  for (const auto& count : recorder.counts()) {
    std::cerr << count.topic << ": " << count.messages << " messages";
    if (count.lost > 0) {
      std::cerr << ", " << count.lost << " lost on the way (a slow disk or network: --compress "
                << "none, or fewer images with the camera's max_rate)";
    }
    std::cerr << std::endl;
    if (count.messages == 0 && count.is_input) {
      std::cerr << "error: nothing came on " << count.topic
                << ": is that robot's camera up, and its name right?" << std::endl;
      status = 1;
    }
  }
  return status;
}

int record(const Options& options) {
  const std::string path = options.output.empty() ? name_by_time() : options.output;
  const rprr::RecordingLimits limits{60.0 * options.minutes, options.megabytes};
  auto recorder = rprr::InputRecorder::create(path, options.compression, limits);
  if (!recorder) return rprr::fail(recorder.reason());
  ros::NodeHandle nh;
  (*recorder)->subscribe(nh, options.robots, options.tf);
  // Silent topics must not make it wait for ever.
  const ros::WallTime end = ros::WallTime::now() + ros::WallDuration(limits.seconds + 10.0);
  ros::WallTime shown;
  while (ros::ok() && !(*recorder)->done()) {
    ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(0.1));
    const ros::WallTime now = ros::WallTime::now();
    if (limits.seconds > 0.0 && (now > end || (*recorder)->seconds() >= limits.seconds)) break;
    if ((now - shown).toSec() < 0.5) continue;
    shown = now;
    show(**recorder, options);
  }
  show(**recorder, options);
  const int status = summarise(**recorder);
  const auto written = (*recorder)->finish();
  if (!written) return rprr::fail(written.reason());
  std::cerr << *written << std::endl;
  return status;
}

}  // namespace

int main(int argc, char** argv) try {
  // Takes ROS's own arguments (__name:=..., remappings) out; Ctrl-C ends the recording in order.
  ros::init(argc, argv, "record_inputs", ros::init_options::AnonymousName);
  CLI::App app{
      "Records RPRR's inputs of some robots (colour, camera_info, depth) into a bag, until a limit "
      "is reached or Ctrl-C is pressed."};
  Options options;
  app.add_option("--robots", options.robots, "robots whose cameras are recorded")
      ->capture_default_str();
  app.add_option("--minutes", options.minutes, "end after so long; 0: no limit")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  app.add_option("--megabytes", options.megabytes, "end at that size (1e6 bytes); 0: no limit")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  app.add_option("-o,--output", options.output, "bag to write; default: inputs_<date>.bag here");
  app.add_option("--compress", options.compression, "none, bz2 or lz4")
      ->check(CLI::IsMember({"none", "bz2", "lz4"}))
      ->capture_default_str();
  app.add_flag("--tf", options.tf, "also /tf and /tf_static");
  CLI11_PARSE(app, argc, argv);
  if (!ros::master::check()) {
    return rprr::fail("no ROS master at " + ros::master::getURI() +
                      ": start the cameras first, or set ROS_MASTER_URI");
  }
  return record(options);
} catch (const std::exception& error) {  // of a library: ends with a sentence
  return rprr::fail(error.what());
}
