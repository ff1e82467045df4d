// SPDX-License-Identifier: BSD-3-Clause
// Any bytes as an encoded frame, as they are and with the checksum made good, and the depth inside.
// Colour payloads are left to the worker process that is there for them.
#include "fuzz.hpp"
#include "rprr_codec/compact_layout.hpp"
#include "rprr_codec/dhcm.hpp"
#include "rprr_codec/encoded_frame.hpp"
#include "rprr_wire/bytes.hpp"

using namespace rprr;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static DhcmDecoder decoder(fuzz::kMaxPixels);
  const ByteView view(data, size);
  Bytes sealed(view.data, view.data + view.size);
  seal(sealed);
  for (const ByteView bytes : {view, ByteView(sealed)}) {
    const Result<EncodedFrame> frame = parse_encoded_frame(bytes);
    if (!frame) continue;
    fuzz::require(frame->camera.valid());
    fuzz::require(frame->base_reduction == 0 ? frame->base.empty()
                                             : frame->sparse && !frame->base.empty());
    if (frame->sparse) {
      const cv::Size compact = CompactLayout(frame->mask).size();
      fuzz::require(compact.area() <= frame->mask.grid().count() * kBlockSide * kBlockSide);
      decoder.decode(frame->depth, frame->depth_blocks());
    } else {
      decoder.decode(frame->depth, cv::Size(frame->camera.width, frame->camera.height));
    }
    fuzz::require(static_cast<bool>(parse_encoded_frame(serialise(*frame))));
  }
  return 0;
}
