// SPDX-License-Identifier: BSD-3-Clause
#include <CLI/CLI.hpp>
#include <exception>
#include <iostream>

#include "commands.hpp"

int main(int argc, char** argv) try {
  CLI::App app(
      "RPRR measured without ROS: the same state machines and codecs that the nodelets run");
  app.require_subcommand(1);
  int exit_code = 0;
  rprr::add_pairs_command(app, exit_code);
  rprr::add_curves_command(app, exit_code);
  rprr::add_codec_command(app, exit_code);
  rprr::add_preview_command(app, exit_code);
  rprr::add_decision_command(app, exit_code);
  rprr::add_turntable_command(app, exit_code);
  rprr::add_iterations_command(app, exit_code);
  rprr::add_latency_command(app, exit_code);
  rprr::add_poses_command(app, exit_code);
  rprr::add_belief_command(app, exit_code);
  rprr::add_consistency_command(app, exit_code);
  rprr::add_timing_command(app, exit_code);
  rprr::add_methods_command(app, exit_code);
  rprr::add_images_command(app, exit_code);
  CLI11_PARSE(app, argc, argv);
  return exit_code;
} catch (const std::exception& error) {  // of a library: ends with a sentence
  std::cerr << "error: " << error.what() << "\n";
  return 1;
}
