// SPDX-License-Identifier: BSD-3-Clause
#include <CLI/CLI.hpp>
#include <array>
#include <exception>

#include "progress.hpp"
#include "rprr_sensor_ros/bag_writer.hpp"
#include "rprr_synthetic/sensor_model.hpp"
#include "rprr_synthetic/trajectory.hpp"

namespace {

struct Options {
  std::string bag;
  std::array<std::string, 2> robots = {"eyebug_a", "eyebug_b"};
  int frames = 20;
  std::uint32_t seed = 1;
  int width = 640;
  int height = 480;
  double rate = 1.0;
  std::string compression = "none";
};

int make(const Options& options) {
  const std::array<rprr::SensorModel, 2> sensors = {
      rprr::example_sensor_a(options.width, options.height),
      rprr::example_sensor_b(options.width, options.height)};
  if (!sensors[0].camera.valid()) return rprr::fail("--width and --height must be 1 to 8192");
  auto bag = rprr::BagWriter::create(options.bag, options.compression);
  if (!bag) return rprr::fail(bag.reason());
  const rprr::Scene room = rprr::make_room(options.seed);
  const auto walk = rprr::pair_walk(options.frames, options.seed);
  for (std::size_t k = 0; k < walk.size(); ++k) {
    const rprr::Stamp stamp = rprr::from_seconds(1.0 + static_cast<double>(k) / options.rate);
    const std::array<rprr::Pose, 2> poses = {walk[k].a, walk[k].b};
    for (std::size_t i = 0; i < 2; ++i) {
      const auto noise_seed = static_cast<std::uint32_t>(2 * k + i);
      const rprr::RecordedFrame frame{stamp, rprr::sense(room, sensors[i], poses[i], noise_seed),
                                      poses[i], std::nullopt};
      const auto written = bag->add(frame, sensors[i].camera, options.robots[i],
                                    rprr::BagShape::rprr, rprr::DepthEncoding::automatic);
      if (!written) return rprr::fail(written.reason());
    }
    rprr::show_progress(k + 1, walk.size());
  }
  const auto finished = bag->finish();
  return finished ? 0 : rprr::fail(finished.reason());
}

}  // namespace

int main(int argc, char** argv) try {
  CLI::App app{"Renders two robots walking through a synthetic room into a bag, poses exact."};
  Options options;
  app.add_option("bag", options.bag, "bag to write")->required();
  app.add_option("--a", options.robots[0], "first robot")->capture_default_str();
  app.add_option("--b", options.robots[1], "second robot")->capture_default_str();
  app.add_option("--frames", options.frames, "number of frames of each robot")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  app.add_option("--seed", options.seed, "seed of the room: another seed, another room")
      ->capture_default_str();
  app.add_option("--rate", options.rate, "frames per second")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--width", options.width, "width of the images, pixels")->capture_default_str();
  app.add_option("--height", options.height, "height of the images, pixels")->capture_default_str();
  app.add_option("--compress", options.compression, "none, bz2 or lz4")
      ->check(CLI::IsMember({"none", "bz2", "lz4"}))
      ->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  return make(options);
} catch (const std::exception& error) {  // of a library: ends with a sentence
  return rprr::fail(error.what());
}
