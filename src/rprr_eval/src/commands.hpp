// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/App.hpp>

namespace rprr {

/// Each adds a subcommand; what it runs sets exit_code.
void add_pairs_command(CLI::App& app, int& exit_code);
void add_curves_command(CLI::App& app, int& exit_code);
void add_codec_command(CLI::App& app, int& exit_code);
void add_preview_command(CLI::App& app, int& exit_code);
void add_decision_command(CLI::App& app, int& exit_code);
void add_turntable_command(CLI::App& app, int& exit_code);
void add_iterations_command(CLI::App& app, int& exit_code);
void add_latency_command(CLI::App& app, int& exit_code);
void add_poses_command(CLI::App& app, int& exit_code);
void add_belief_command(CLI::App& app, int& exit_code);
void add_consistency_command(CLI::App& app, int& exit_code);
void add_timing_command(CLI::App& app, int& exit_code);
void add_methods_command(CLI::App& app, int& exit_code);
void add_images_command(CLI::App& app, int& exit_code);

}  // namespace rprr
