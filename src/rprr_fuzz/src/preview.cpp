// SPDX-License-Identifier: BSD-3-Clause
// Any bytes as a block preview, as they are and with the checksum made good.
#include "rprr_wire/preview.hpp"
#include "fuzz.hpp"
#include "rprr_wire/bytes.hpp"

using namespace rprr;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const ByteView view(data, size);
  Bytes sealed(view.data, view.data + view.size);
  seal(sealed);
  for (const ByteView bytes : {view, ByteView(sealed)}) {
    const Result<BlockPreview> preview = decode_preview(bytes);
    if (preview) fuzz::require(preview->well_formed());
    preview_depth_bytes(bytes);
    preview_colour_bytes(bytes);
  }
  return 0;
}
