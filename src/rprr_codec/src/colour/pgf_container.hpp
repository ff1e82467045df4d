// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core/types.hpp>
#include <vector>

#include "rprr_geometry/result.hpp"
#include "rprr_wire/bytes.hpp"

namespace rprr {

/// A pgf payload taken apart (doc/encoded_frame.md): of libpgf's own header it keeps what is not
/// the same in every image of ours.
struct PgfParts {
  std::uint8_t format = 0;  // libpgf's version flags
  std::uint8_t quality = 0;
  int levels = 0;  // of the whole image
  int coarse = 0;  // finest levels that are left out
  cv::Size size;   // of the picture; the PGF image is widened to 16 pixels a side
  std::vector<std::uint32_t> lengths;  // of levels - coarse levels, the coarsest first
  ByteView data;                       // of these levels; somebody else's bytes
};

/// libpgf leaks where an image is too small for a wavelet level: smaller images are widened.
cv::Size pgf_coded_size(cv::Size size);

/// Any bytes: lengths add up, sizes are possible, 0 <= coarse < levels.
Result<PgfParts> parse_pgf_payload(ByteView payload);
Bytes pgf_payload(const PgfParts& parts);

/// A file of libpgf's: its header and all level lengths (0 for those left out), then the data.
Bytes pgf_file(const PgfParts& parts);
/// The other way. The data stay the file's. Errors: a file that our encoder does not write.
Result<PgfParts> parse_pgf_file(ByteView file, cv::Size size);

}  // namespace rprr
