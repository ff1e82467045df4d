// SPDX-License-Identifier: BSD-3-Clause
#include <CLI/CLI.hpp>
#include <cmath>
#include <exception>

#include "progress.hpp"
#include "rprr_sensor/recordings/tum_writer.hpp"
#include "rprr_synthetic/sensor_model.hpp"
#include "rprr_synthetic/trajectory.hpp"

namespace {

struct Options {
  std::string folder;
  int frames = 40;
  std::uint32_t seed = 1;
  int width = 640;
  int height = 480;
  double rate = 5.0;
  double exposure_swing = 0.08;
};

int make(const Options& options) {
  rprr::SensorModel sensor = rprr::example_sensor_a(options.width, options.height);
  if (!sensor.camera.valid()) return rprr::fail("--width and --height must be 1 to 8192");
  const double exposure = sensor.colour.exposure;
  auto writer = rprr::TumWriter::create(
      options.folder, sensor.camera, 0.001, true,
      "Synthetic room, rprr_sensor synthetic_to_folder --seed " + std::to_string(options.seed));
  if (!writer) return rprr::fail(writer.reason());
  const rprr::Scene room = rprr::make_room(options.seed);
  const auto walk = rprr::single_walk(options.frames, options.seed);
  for (std::size_t k = 0; k < walk.size(); ++k) {
    // As automatic exposure wanders.
    sensor.colour.exposure =
        exposure * (1.0 + options.exposure_swing * std::sin(0.7 * static_cast<double>(k)));
    const auto image = rprr::sense(room, sensor, walk[k], static_cast<std::uint32_t>(k));
    const rprr::Stamp stamp = rprr::from_seconds(1.0 + static_cast<double>(k) / options.rate);
    const auto added = writer->add(stamp, image, walk[k]);
    if (!added) return rprr::fail(added.reason());
    rprr::show_progress(k + 1, walk.size());
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) try {
  CLI::App app{
      "Renders a walk through a synthetic room into a folder in the TUM layout, poses exact."};
  Options options;
  app.add_option("folder", options.folder, "folder to make")->required();
  app.add_option("--frames", options.frames, "number of frames of the walk")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  app.add_option("--seed", options.seed, "seed of the room: another seed, another room")
      ->capture_default_str();
  app.add_option("--width", options.width, "width of the images, pixels")->capture_default_str();
  app.add_option("--height", options.height, "height of the images, pixels")->capture_default_str();
  app.add_option("--rate", options.rate, "frames per second")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--exposure-swing", options.exposure_swing,
                 "share by which the exposure wanders up and down, in 9 frames once round: 0.25 "
                 "makes neighbours as different as two cameras that meter for themselves")
      ->check(CLI::Range(0.0, 0.9))
      ->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  return make(options);
} catch (const std::exception& error) {  // of a library: ends with a sentence
  return rprr::fail(error.what());
}
