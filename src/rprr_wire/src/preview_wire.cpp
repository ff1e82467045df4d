// SPDX-License-Identifier: BSD-3-Clause
#include "preview_colour.hpp"
#include "preview_depth.hpp"
#include "rprr_geometry/camera.hpp"
#include "rprr_wire/bytes.hpp"
#include "rprr_wire/preview.hpp"

namespace rprr {
namespace {

constexpr std::uint8_t kVersion = 2;
constexpr unsigned kCountsFlag = 1;
constexpr unsigned kRanksFlag = 2;

bool possible_step(PreviewDepth coding, double step) {
  return coding == PreviewDepth::kInverse ? step > 1e-6 && step < 1.0 : step > 1e-6 && step < 0.1;
}

struct Parts {
  std::uint8_t version = 0;
  int width = 0;
  int height = 0;
  unsigned flags = 0;
  double step = 0.0;
  ByteView depth;
  ByteView colour;
};

// The layout alone: what the parts hold is not looked at.
Result<Parts> take_apart(ByteView bytes) {
  ByteReader reader(unseal(bytes));
  Parts parts;
  parts.version = reader.get<std::uint8_t>();
  parts.width = reader.get<std::uint16_t>();
  parts.height = reader.get<std::uint16_t>();
  parts.flags = reader.get<std::uint8_t>();
  parts.step = static_cast<double>(reader.get<float>());
  const std::size_t length = reader.get<std::uint32_t>();
  if (!reader.ok()) return Error{"preview damaged or cut short"};
  if (parts.version != kVersion) return Error{"preview of an unknown version"};
  parts.depth = reader.get_view(length);
  if (!reader.ok()) return Error{"preview with a length that does not fit"};
  parts.colour = reader.get_view(reader.left());
  return parts;
}

}  // namespace

Bytes encode_preview(const BlockPreview& preview, int colour_quality) {
  const bool counts = preview.coding == PreviewDepth::kCounts;
  const bool ranks = counts && ranks_pay(preview.depth);
  const Bytes depth = encode_preview_depth(preview.depth, ranks);
  ByteWriter writer;
  writer.put(kVersion);
  writer.put(static_cast<std::uint16_t>(preview.grid.width));
  writer.put(static_cast<std::uint16_t>(preview.grid.height));
  writer.put(static_cast<std::uint8_t>((counts ? kCountsFlag : 0u) | (ranks ? kRanksFlag : 0u)));
  writer.put(static_cast<float>(preview.step));
  writer.put(static_cast<std::uint32_t>(depth.size()));
  writer.append(depth);
  writer.append(encode_preview_colour(preview.bgr, colour_quality));
  Bytes bytes = writer.take();
  seal(bytes);
  return bytes;
}

Result<BlockPreview> decode_preview(ByteView bytes) {
  const Result<Parts> parts = take_apart(bytes);
  if (!parts) return Error{parts.reason()};
  if (parts->width < 1 || parts->height < 1 || parts->width > kMaxImageSide ||
      parts->height > kMaxImageSide) {
    return Error{"preview of an image of impossible size"};
  }
  if (parts->flags > (kCountsFlag | kRanksFlag)) {
    return Error{"preview with depths of an unknown kind"};
  }
  BlockPreview preview;
  preview.grid = BlockGrid(parts->width, parts->height);
  const bool counts = (parts->flags & kCountsFlag) != 0;
  preview.coding = counts ? PreviewDepth::kCounts : PreviewDepth::kInverse;
  preview.step = parts->step;
  if (!possible_step(preview.coding, preview.step)) {
    return Error{"preview with an impossible depth step"};
  }
  preview.depth = cv::Mat(preview.grid.rows, preview.grid.columns, CV_16UC1, cv::Scalar(0));
  preview.bgr.create(preview.grid.rows, preview.grid.columns, CV_8UC3);
  if (!decode_preview_depth(parts->depth, (parts->flags & kRanksFlag) != 0, preview.depth)) {
    return Error{"preview with impossible depths"};
  }
  if (!decode_preview_colour(parts->colour, preview.bgr)) {
    return Error{"preview with colours that cannot be read"};
  }
  return preview;
}

std::size_t preview_depth_bytes(ByteView bytes) {
  const Result<Parts> parts = take_apart(bytes);
  return parts ? parts->depth.size : 0;
}

std::size_t preview_colour_bytes(ByteView bytes) {
  const Result<Parts> parts = take_apart(bytes);
  return parts ? parts->colour.size : 0;
}

}  // namespace rprr
