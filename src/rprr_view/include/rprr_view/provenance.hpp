// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace rprr {

/// Where a pixel of a rebuilt view comes from. The values are grey levels, so that an image of them
/// (CV_8UC1, mono8) can be looked at: the brighter, the better founded.
enum Provenance : std::uint8_t {
  kNothing = 0,           // nobody saw it: black, no depth
  kFilled = 64,           // colour spread smoothly from the neighbourhood; no depth
  kBase = 96,             // colour of the robot's own whole image alone; depth, if any, predicted
  kMended = 128,          // predicted, depth from the neighbours (crack or ghost)
  kPredicted = 192,       // warped from the reference frame
  kReceivedDepth = 208,   // depth sent by the robot itself; colour estimated
  kReceivedColour = 224,  // colour sent by the robot itself; depth, if any, predicted
  kReceived = 255,        // sent by the robot itself, colour and depth
};

}  // namespace rprr
