// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_pose/pose_verdict.hpp"

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>

namespace rprr {
namespace {

struct StatusEntry {
  PoseStatus status;
  const char* name;
  const char* cause;
};

constexpr std::array<StatusEntry, 13> kStatuses = {{
    {PoseStatus::kAccepted, "accepted", "accepted"},
    {PoseStatus::kTimedOut, "timed_out", "the peer fell silent"},
    {PoseStatus::kTooFewPoints, "too_few_points", "too few points"},
    {PoseStatus::kNotConverged, "not_converged", "not converged"},
    {PoseStatus::kFreeDirection, "free_direction", "the geometry leaves a direction free"},
    {PoseStatus::kLittleOverlap, "little_overlap", "too little overlap"},
    {PoseStatus::kDepthDisagrees, "depth_disagrees", "depths disagree"},
    {PoseStatus::kFreeSpaceViolated, "free_space_violated", "points lie in free space"},
    {PoseStatus::kMalformed, "malformed", "the peer's message could not be read"},
    {PoseStatus::kNoFrame, "no_frame",
     "no frame of the reference is near in time (clocks differ, or its camera is stuck)"},
    {PoseStatus::kAmbiguous, "ambiguous", "two poses fit"},
    {PoseStatus::kColourDisagrees, "colour_disagrees", "colours disagree"},
    {PoseStatus::kUnknown, "unknown", "unknown status (do all robots run the same version?)"},
}};

struct QuantityEntry {
  PoseQuantity quantity;
  const char* name;
  const char* words;
  const char* unit;  // begins with a space
  int digits;        // least number of digits after the point
  bool is_lower_limit;
};

constexpr std::array<QuantityEntry, 16> kQuantities = {{
    {PoseQuantity::kNone, "none", "", "", 0, true},
    {PoseQuantity::kLogOdds, "log_odds", "log odds", "", 1, true},
    {PoseQuantity::kMargin, "margin", "margin", "", 2, true},
    {PoseQuantity::kOverlap, "overlap", "share of the view", "", 2, true},
    {PoseQuantity::kFreeSpace, "free_space", "share of points", "", 2, false},
    {PoseQuantity::kConsistent, "consistent", "share that agrees", "", 2, true},
    {PoseQuantity::kResidual, "residual", "residual over noise", "", 1, false},
    {PoseQuantity::kMatchedPoints, "matched_points", "matched points", "", 0, true},
    {PoseQuantity::kValidPoints, "valid_points", "points with depth", "", 0, true},
    {PoseQuantity::kTranslationSigma, "translation_sigma", "translation sigma", " m", 3, false},
    {PoseQuantity::kRotationSigma, "rotation_sigma", "rotation sigma", " rad", 3, false},
    {PoseQuantity::kTranslationStep, "translation_step", "last step", " m", 4, false},
    {PoseQuantity::kRotationStep, "rotation_step", "last step", " rad", 4, false},
    {PoseQuantity::kSilence, "silence", "silence", " s", 2, false},
    {PoseQuantity::kTimeApart, "time_apart", "time apart", " s", 2, false},
    {PoseQuantity::kUnknown, "unknown", "unknown quantity", "", 2, true},
}};

// The last entry stands for all values that are not in the table.
const StatusEntry& entry_of(PoseStatus status) {
  for (const StatusEntry& entry : kStatuses) {
    if (entry.status == status) return entry;
  }
  return kStatuses.back();
}

const QuantityEntry& entry_of(PoseQuantity quantity) {
  for (const QuantityEntry& entry : kQuantities) {
    if (entry.quantity == quantity) return entry;
  }
  return kQuantities.back();
}

// A number that is too large for a float gets infinite.
float as_float(double value) {
  constexpr double kLargest = std::numeric_limits<float>::max();
  if (std::abs(value) > kLargest) value = std::copysign(HUGE_VAL, value);
  return static_cast<float>(value);
}

std::string number(float value, int digits) {
  if (std::isnan(value)) return "not a number";
  if (std::isinf(value)) return value > 0.0f ? "infinite" : "minus infinite";
  constexpr float kLong = 1e6f;  // beyond it all digits before the point would be tedious
  char text[32];
  std::snprintf(text, sizeof(text), std::abs(value) < kLong ? "%.*f" : "%.*e", digits,
                static_cast<double>(value));
  return text;
}

// Finds the fewest digits, from `least` on, that show `needed` to 1% and tell `measured` from it.
int digits_for(float measured, float needed, int least) {
  constexpr int kMost = 7;  // floats have no more
  for (int digits = least; digits < kMost; ++digits) {
    char text[64];
    std::snprintf(text, sizeof(text), "%.*f", digits, static_cast<double>(needed));
    const double error = std::abs(std::atof(text) - static_cast<double>(needed));
    const bool is_exact = !(error > 0.01 * std::abs(static_cast<double>(needed)));
    const bool is_told = measured == needed || number(measured, digits) != number(needed, digits);
    if (is_exact && is_told) return digits;
  }
  return kMost;
}

}  // namespace

PoseVerdict make_verdict(PoseStatus status, PoseQuantity quantity, double measured, double needed) {
  return {status, quantity, as_float(measured), as_float(needed)};
}

bool is_lower_limit(PoseQuantity quantity) {
  return entry_of(quantity).is_lower_limit;
}

PoseStatus pose_status_from(std::uint8_t value) {
  return entry_of(static_cast<PoseStatus>(value)).status;
}

PoseQuantity pose_quantity_from(std::uint8_t value) {
  return entry_of(static_cast<PoseQuantity>(value)).quantity;
}

const char* name_of(PoseStatus status) {
  return entry_of(status).name;
}

const char* name_of(PoseQuantity quantity) {
  return entry_of(quantity).name;
}

const char* cause_of(PoseStatus status) {
  return entry_of(status).cause;
}

std::string describe(const PoseVerdict& verdict) {
  const std::string cause = cause_of(verdict.status);
  if (verdict.quantity == PoseQuantity::kNone) return cause;
  const QuantityEntry& entry = entry_of(verdict.quantity);
  const int digits = digits_for(verdict.measured, verdict.needed, entry.digits);
  return cause + ": " + entry.words + " " + number(verdict.measured, digits) + entry.unit +
         (entry.is_lower_limit ? ", needs " : ", needs at most ") + number(verdict.needed, digits) +
         entry.unit;
}

}  // namespace rprr
