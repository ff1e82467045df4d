// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

namespace rprr {

/// A status says how an exchange ended, one status for one cause. Values are those of
/// rprr_msgs/RelativePose.
enum class PoseStatus : std::uint8_t {
  kAccepted = 0,
  kTimedOut = 1,           // the peer fell silent
  kTooFewPoints = 2,       // too few points have depth, or find a counterpart
  kNotConverged = 3,       // the iteration did not come to rest
  kFreeDirection = 4,      // the geometry does not say where along some direction the pose is
  kLittleOverlap = 5,      // too little of one view falls into the other
  kDepthDisagrees = 6,     // the surfaces differ beyond the sensor's noise
  kFreeSpaceViolated = 7,  // points lie where the other camera saw through
  kMalformed = 8,          // the peer sent what could not be read
  kNoFrame = 9,            // the reference has no frame near the dependent's in time
  kAmbiguous = 10,         // another pose fits about as well
  kColourDisagrees = 11,   // the colours of surfaces that meet do not go together
  kUnknown = 255,          // a status that this version does not know came over the radio
};

/// A quantity says what was measured; its unit stands in brackets. Values are those of
/// rprr_msgs/RelativePose.
enum class PoseQuantity : std::uint8_t {
  kNone = 0,              // nothing was measured
  kLogOdds = 1,           // logarithm of the odds that the pose is right [1] (pose_evidence.hpp)
  kMargin = 2,            // how far the best distinct other pose scores below it [share of score]
  kOverlap = 3,           // points of one view that fall into the other [share]
  kFreeSpace = 4,         // points in seen free space [share of those in view]
  kConsistent = 5,        // points whose depths agree [share of those in view]
  kResidual = 6,          // RMS of the residuals in units of what the sensor's noise makes [1]
  kMatchedPoints = 7,     // correspondences [count]
  kValidPoints = 8,       // points that have depth [count]
  kTranslationSigma = 9,  // standard deviation in the worst direction [m]
  kRotationSigma = 10,    // standard deviation about the worst axis [rad]
  kTranslationStep = 11,  // last step of the iteration [m]
  kRotationStep = 12,     // last step of the iteration [rad]
  kSilence = 13,          // time without an answer [s]
  kTimeApart = 14,        // time between the frames of the two robots [s]
  kUnknown = 255,         // a quantity that this version does not know came over the radio
};

/// A verdict is a status with the figures behind it: what was measured and what was needed. An
/// accepted pose carries them too, so that people see by how much it was accepted.
struct PoseVerdict {
  PoseStatus status = PoseStatus::kTimedOut;
  PoseQuantity quantity = PoseQuantity::kNone;
  float measured = 0.0f;  // in the quantity's unit; from the radio it may be any float
  float needed = 0.0f;    // the least or the most allowed, is_lower_limit() says which

  bool accepted() const { return status == PoseStatus::kAccepted; }
};

/// Makes a verdict of figures as they were measured. What is too large for a float gets infinite.
PoseVerdict make_verdict(PoseStatus status, PoseQuantity quantity, double measured, double needed);

/// Tells whether a pose needs at least so much of the quantity (true) or at most so much (false).
bool is_lower_limit(PoseQuantity quantity);

/// These read a byte from the radio. A byte that is no value of the enum gives kUnknown.
PoseStatus pose_status_from(std::uint8_t value);
PoseQuantity pose_quantity_from(std::uint8_t value);

/// These give names for programs, the constants of rprr_msgs/RelativePose in lower case:
/// "free_direction", "translation_sigma". Values out of range are "unknown".
const char* name_of(PoseStatus status);
const char* name_of(PoseQuantity quantity);

/// Says the cause in words, without figures. A value out of range is called unknown.
const char* cause_of(PoseStatus status);

/// Says cause and figures in words: "two poses fit: margin 0.02, needs 0.06". The figures have as
/// many digits as tell them apart. Any values are allowed: the text calls those out of range
/// unknown and a NaN not a number.
std::string describe(const PoseVerdict& verdict);

}  // namespace rprr
