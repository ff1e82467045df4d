// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rprr_codec/dhcm.hpp"
#include "rprr_eval/codec/depth_codec.hpp"
#include "rprr_eval/codec/whole_colour.hpp"

namespace rprr {

/// Our own.
DepthCodecResult make_dhcm(DhcmMode mode);
/// RVL of Wilson, "Fast lossless depth image compression" (2017), written from the paper.
DepthCodecResult make_rvl();
/// PNG of OpenCV, zlib's level 1 to 9.
DepthCodecResult make_png(int level);
/// JPEG-LS of CharLS, lossless.
DepthCodecResult make_jpeg_ls();
/// JPEG XL of libjxl, lossless, its effort 1 (fastest) to 9.
DepthCodecResult make_jpeg_xl(int effort);
/// JPEG XL's lossy colour; null where the library was not built in.
std::unique_ptr<WholeColour> make_jpeg_xl_colour(int effort);
/// Zstandard over byte-split row deltas (row_deltas.hpp).
DepthCodecResult make_zstd(int level);
/// LZ4's fast mode over byte-split row deltas.
DepthCodecResult make_lz4();
/// FFV1 version 3 of libavcodec, every frame by itself.
DepthCodecResult make_ffv1();

}  // namespace rprr
