// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_codec/outgoing_frame.hpp"

namespace rprr {

EncodedFrame frame_to_encode(const OutgoingFrame& outgoing, bool whole) {
  EncodedFrame frame;
  frame.camera = outgoing.frame->camera;
  frame.report = outgoing.report;
  frame.sparse = outgoing.sparse && !whole;
  if (!frame.sparse) return frame;
  frame.reference = outgoing.reference;
  frame.reference_stamp = outgoing.reference_stamp;
  frame.b_from_a = outgoing.b_from_a;
  frame.mask = outgoing.mask;
  frame.depth_mask = outgoing.depth_mask;
  return frame;
}

}  // namespace rprr
