// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/node_handle.h>
#include <ros/time.h>
#include <ros/wall_timer.h>

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>

namespace diagnostic_updater {
class DiagnosticStatusWrapper;
class Updater;
}  // namespace diagnostic_updater

namespace rprr {

/// What a nodelet says about itself: problems as throttled log messages and on /diagnostics,
/// counters on /diagnostics. Any thread may call it.
class Health {
 public:
  /// hardware is the robot (or station) that the nodelet serves; name is the nodelet's.
  Health(const ros::NodeHandle& nh, const ros::NodeHandle& private_nh, const std::string& name,
         const std::string& hardware);
  ~Health();

  /// Something is wrong: text names the topic, what was expected and the remedy. Logged at most
  /// once every five seconds for a key, and less often the longer it lasts; /diagnostics shows it
  /// until ten seconds after its last report, or until clear().
  void warn(const std::string& key, const std::string& text);
  void error(const std::string& key, const std::string& text);
  /// What was reported with that key is mended.
  void clear(const std::string& key);
  /// Says once and for all that the nodelet does nothing: its parameters are wrong, as text says.
  void refuse_parameters(const std::string& text);
  /// Adds to a counter shown on /diagnostics.
  void count(const std::string& counter, std::uint64_t by = 1);
  /// Shows a value on /diagnostics.
  void show(const std::string& name, const std::string& value);

 private:
  struct Problem {
    bool is_error = false;
    std::string text;
    ros::WallTime last;
    ros::WallTime logged;
    double log_period = 0.0;  // until it is logged again [s]
    std::uint64_t times = 0;
    bool lasts = false;  // shown until the node ends
  };

  void report(const std::string& key, const std::string& text, bool is_error);
  void fill(diagnostic_updater::DiagnosticStatusWrapper& status);

  std::mutex mutex_;
  std::string name_;
  std::map<std::string, Problem> problems_;
  std::map<std::string, std::uint64_t> counters_;
  std::map<std::string, std::string> values_;
  std::unique_ptr<diagnostic_updater::Updater> updater_;
  ros::WallTimer timer_;
};

}  // namespace rprr
