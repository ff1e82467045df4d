// SPDX-License-Identifier: BSD-3-Clause
// Any bytes as a colour payload, as they are and with the checksum made good: what is read of it
// outside of the worker process, and the codecs that do without one. PGF's pixels are left to the
// worker.
#include <algorithm>
#include <opencv2/core.hpp>

#include "fuzz.hpp"
#include "rprr_codec/colour_codec.hpp"
#include "rprr_geometry/camera.hpp"
#include "rprr_wire/bytes.hpp"

using namespace rprr;

namespace {

void look_at(ByteView payload) {
  static const std::unique_ptr<ColourDecoder> decoder = make_local_colour_decoder();
  for (const std::string& codec : colour_codecs()) {
    const Result<cv::Size> size = colour_payload_size(codec, payload);
    if (!size) continue;
    fuzz::require(std::min(size->width, size->height) >= 1);
    fuzz::require(std::max(size->width, size->height) <= kMaxImageSide);
    if (codec == "pgf") {
      const Result<Bytes> cut = pgf_cut(payload, *pgf_levels(payload) - 1);
      fuzz::require(cut && colour_payload_size(codec, *cut));
    } else if (static_cast<std::size_t>(size->area()) <= fuzz::kMaxPixels) {
      const Result<cv::Mat> image = decoder->decode(codec, payload, *size);
      fuzz::require(!image || image->size() == *size);
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const ByteView view(data, size);
  Bytes sealed(view.data, view.data + view.size);
  seal(sealed);
  look_at(view);
  look_at(sealed);
  return 0;
}
