// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_eval/exchange/exchange_log.hpp"

#include <algorithm>
#include <cstdio>
#include <functional>
#include <nlohmann/json.hpp>
#include <vector>

#include "rprr_eval/measure/median.hpp"

namespace rprr {
namespace {

using Field = std::function<std::optional<double>(const LoggedExchange&)>;

struct Row {
  const char* key;    // in the summary
  const char* label;  // in the table
  const char* format;
  Field field;
};

Field plain(double LoggedExchange::*member) {
  return [member](const LoggedExchange& e) { return std::optional<double>(e.*member); };
}

std::optional<double> measured(double value) {
  return value > 0.0 ? std::optional<double>(value) : std::nullopt;
}

const std::vector<Row>& rows() {
  using E = LoggedExchange;
  static const std::vector<Row> all = {
      {"blocks_total", "blocks of the image", "%.0f", plain(&E::blocks_total)},
      {"blocks_sent", "  sent by b", "%.0f", plain(&E::blocks_sent)},
      {"blocks_sent_without_depth", "  of those without depth", "%.0f",
       plain(&E::blocks_sent_without_depth)},
      {"bytes_pose", "bytes: pose exchange, both ways", "%.0f", plain(&E::bytes_pose)},
      {"bytes_masks", "bytes: block masks, both ways", "%.0f", plain(&E::bytes_masks)},
      {"bytes_depth", "bytes: depth", "%.0f", plain(&E::bytes_depth)},
      {"bytes_colour", "bytes: colour", "%.0f", plain(&E::bytes_colour)},
      {"bytes_extras", "bytes: headers and checksums", "%.0f", plain(&E::bytes_extras)},
      {"bytes_total", "bytes: all that b causes", "%.0f", plain(&E::bytes_total)},
      {"independent_bytes", "bytes: b's whole frame, same codecs", "%.0f",
       [](const E& e) { return measured(e.independent_bytes); }},
      {"bytes_share", "  sent of that", "%.3f",
       [](const E& e) {
         return e.independent_bytes > 0 ? measured(e.bytes_total / e.independent_bytes)
                                        : std::nullopt;
       }},
      {"psnr", "PSNR of the rebuilt view, dB", "%.2f", [](const E& e) { return e.psnr; }},
      {"pose_error_m", "pose error, m", "%.4f",
       [](const E& e) {
         return e.accepted && e.pose_error ? std::optional<double>(e.pose_error->metres)
                                           : std::nullopt;
       }},
      {"pose_error_deg", "pose error, deg", "%.3f",
       [](const E& e) {
         return e.accepted && e.pose_error ? std::optional<double>(e.pose_error->degrees)
                                           : std::nullopt;
       }},
      {"ms_pose_reference", "ms: pose, on a", "%.2f", plain(&E::ms_pose_reference)},
      {"ms_pose_dependent", "ms: pose, on b", "%.2f", plain(&E::ms_pose_dependent)},
      {"ms_validate", "ms: validate, on b", "%.2f", plain(&E::ms_validate)},
      {"ms_encode", "ms: encode, on b", "%.2f", plain(&E::ms_encode)},
      {"ms_decode", "ms: decode, at the station", "%.2f", plain(&E::ms_decode)},
      {"ms_reconstruct", "ms: reconstruct, at the station", "%.2f", plain(&E::ms_reconstruct)},
  };
  return all;
}

}  // namespace

void ExchangeLog::start(std::uint32_t number) {
  if (exchanges_.size() < wanted_) exchanges_.try_emplace(number);
}

LoggedExchange* ExchangeLog::find(std::uint32_t number) {
  const auto found = exchanges_.find(number);
  return found == exchanges_.end() ? nullptr : &found->second;
}

std::size_t ExchangeLog::completed() const {
  return static_cast<std::size_t>(
      std::count_if(exchanges_.begin(), exchanges_.end(),
                    [](const auto& entry) { return entry.second.rebuilt; }));
}

nlohmann::json ExchangeLog::summary() const {
  std::size_t accepted = 0;
  for (const auto& [number, exchange] : exchanges_) accepted += exchange.accepted ? 1 : 0;
  nlohmann::json medians;
  for (const Row& row : rows()) {
    std::vector<double> values;
    for (const auto& [number, exchange] : exchanges_) {
      const std::optional<double> value = exchange.rebuilt ? row.field(exchange) : std::nullopt;
      if (value) values.push_back(*value);
    }
    medians[row.key] = values.empty() ? nlohmann::json(nullptr) : nlohmann::json(median(values));
  }
  return {{"exchanges",
           {{"started", started()},
            {"completed", completed()},
            {"lost", started() - completed()},
            {"accepted", accepted}}},
          {"medians", medians}};
}

std::string ExchangeLog::table() const {
  const nlohmann::json sum = summary();
  const auto& counts = sum["exchanges"];
  char line[160];
  std::snprintf(line, sizeof(line), "%zu exchanges: %zu completed, %zu lost, %zu poses accepted\n",
                counts["started"].get<std::size_t>(), counts["completed"].get<std::size_t>(),
                counts["lost"].get<std::size_t>(), counts["accepted"].get<std::size_t>());
  std::string out = line;
  out += "medians over the completed ones:\n";
  for (const Row& row : rows()) {
    const nlohmann::json& value = sum["medians"][row.key];
    char text[40] = "-";
    if (!value.is_null()) std::snprintf(text, sizeof(text), row.format, value.get<double>());
    std::snprintf(line, sizeof(line), "  %-38s %12s\n", row.label, text);
    out += line;
  }
  return out;
}

}  // namespace rprr
