// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "rprr_eval/measure/metrics.hpp"

namespace rprr {

/// What became of one exchange, as far as topics tell.
struct LoggedExchange {
  bool accepted = false;
  bool rebuilt = false;  // the station published b's view
  std::optional<PoseError> pose_error;
  std::optional<double> psnr;
  double blocks_total = 0, blocks_sent = 0, blocks_sent_without_depth = 0;
  double bytes_pose = 0, bytes_masks = 0, bytes_depth = 0, bytes_colour = 0, bytes_extras = 0;
  double bytes_total = 0, independent_bytes = 0;  // independent: 0 if not measured
  double ms_pose_reference = 0, ms_pose_dependent = 0, ms_validate = 0, ms_encode = 0;
  double ms_decode = 0, ms_reconstruct = 0;
};

/// Collects exchanges by their number and sums them up, for people and for scripts. Only the first
/// `wanted` exchanges count.
class ExchangeLog {
 public:
  explicit ExchangeLog(std::size_t wanted) : wanted_(wanted) {}

  /// A new exchange; ignored once there are enough.
  void start(std::uint32_t number);
  /// The record of an exchange, or null if it does not count.
  LoggedExchange* find(std::uint32_t number);

  std::size_t started() const { return exchanges_.size(); }
  std::size_t completed() const;
  bool finished() const { return started() >= wanted_ && completed() == started(); }

  /// {"exchanges": {started, completed, lost, accepted}, "medians": {...}}; medians over the
  /// completed ones, null where nothing was measured.
  nlohmann::json summary() const;
  std::string table() const;

 private:
  std::size_t wanted_;
  std::map<std::uint32_t, LoggedExchange> exchanges_;
};

}  // namespace rprr
