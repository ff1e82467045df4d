// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <opencv2/core/mat.hpp>
#include <optional>

#include "rprr_geometry/result.hpp"
#include "rprr_wire/bytes.hpp"

namespace rprr {

/// What a raw file holds: rows of little-endian pixels without a header.
struct RawLayout {
  cv::Size size;
  bool metres = false;  // float32; else uint16 counts
};

/// True for PNG, TIFF and PGM by the name's ending, false for raw files.
bool is_image_name(const std::filesystem::path& path);

/// CV_16UC1 counts or CV_32FC1 metres. Errors: not there, not of those types, a raw file of another
/// length than its layout says, or without a layout.
Result<cv::Mat> read_depth(const std::filesystem::path& path,
                           const std::optional<RawLayout>& layout);

/// An image by the name's ending, else raw. Errors: a type that the format cannot hold, no room.
Result<bool> write_depth(const std::filesystem::path& path, const cv::Mat& pixels);

/// A whole file of at most `limit` bytes.
Result<Bytes> read_file(const std::filesystem::path& path, std::size_t limit);
/// Through a file beside it, so that nobody sees half of it.
Result<bool> write_file(const std::filesystem::path& path, ByteView bytes);

}  // namespace rprr
