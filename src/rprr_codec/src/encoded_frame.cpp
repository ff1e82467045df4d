// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_codec/encoded_frame.hpp"

#include <algorithm>
#include <cmath>

#include "rprr_geometry/block_mask_pair.hpp"

namespace rprr {
namespace {

constexpr std::uint8_t kVersion = 2;
constexpr std::uint8_t kSparse = 0x01;
constexpr std::size_t kMaxName = 64;

void put_text(ByteWriter& writer, const std::string& text) {
  const std::size_t length = std::min(text.size(), kMaxName);
  writer.put(static_cast<std::uint8_t>(length));
  writer.append({reinterpret_cast<const std::uint8_t*>(text.data()), length});
}

// False where the text is too long or holds what no name holds.
bool get_text(ByteReader& reader, std::string& text) {
  const std::size_t length = reader.get<std::uint8_t>();
  if (length > kMaxName) return false;
  const ByteView view = reader.get_view(length);
  if (!reader.ok()) return false;
  text.assign(reinterpret_cast<const char*>(view.data), view.size);
  return std::all_of(text.begin(), text.end(), [](char c) { return c > ' ' && c <= '~'; });
}

void put_pose(ByteWriter& writer, const Pose& pose) {
  const Eigen::Quaterniond rotation(pose.rotation());
  for (int i = 0; i < 3; ++i) writer.put(pose.translation()[i]);
  for (int i = 0; i < 4; ++i) writer.put(rotation.coeffs()[i]);
}

bool get_pose(ByteReader& reader, Pose& pose) {
  Eigen::Vector3d translation;
  Eigen::Vector4d xyzw;
  for (int i = 0; i < 3; ++i) translation[i] = reader.get<double>();
  for (int i = 0; i < 4; ++i) xyzw[i] = reader.get<double>();
  // No comparison holds for NaN.
  if (!(std::abs(xyzw.norm() - 1.0) < 1e-6) || !(translation.norm() < 1e6)) return false;
  pose = make_pose(translation, xyzw);
  return is_rigid(pose);
}

void put_report(ByteWriter& writer, const FrameReport& report) {
  writer.put(report.blocks_predicted);
  writer.put(report.blocks_validated);
  for (const std::uint32_t bytes :
       {report.bytes_pose, report.bytes_masks, report.independent_bytes_depth,
        report.independent_bytes_colour}) {
    writer.put(bytes);
  }
  for (const float ms : {report.ms_pose, report.ms_predict, report.ms_validate, report.ms_encode}) {
    writer.put(ms);
  }
}

bool get_report(ByteReader& reader, FrameReport& report) {
  report.blocks_predicted = reader.get<std::uint16_t>();
  report.blocks_validated = reader.get<std::uint16_t>();
  for (std::uint32_t* bytes : {&report.bytes_pose, &report.bytes_masks,
                               &report.independent_bytes_depth, &report.independent_bytes_colour}) {
    *bytes = reader.get<std::uint32_t>();
  }
  bool good = true;
  for (float* ms : {&report.ms_pose, &report.ms_predict, &report.ms_validate, &report.ms_encode}) {
    *ms = reader.get<float>();
    good = good && std::isfinite(*ms) && *ms >= 0.0f;
  }
  return good;
}

// What only a sparse frame has, without the mask.
bool get_reference(ByteReader& reader, EncodedFrame& frame) {
  if (!get_text(reader, frame.reference) || frame.reference.empty()) return false;
  frame.reference_stamp = reader.get<Stamp>();
  return get_pose(reader, frame.motion);
}

Bytes copy_of(ByteView view) {
  return Bytes(view.data, view.data + view.size);
}

}  // namespace

Bytes serialise(const EncodedFrame& frame, EncodedSizes* sizes) {
  const Bytes mask = frame.sparse ? encode_mask_pair({frame.mask, frame.depth_blocks()}) : Bytes{};
  ByteWriter writer;
  writer.bytes().reserve(256 + mask.size() + frame.depth.size() + frame.colour.size());
  writer.put(kVersion);
  writer.put(static_cast<std::uint8_t>(frame.sparse ? kSparse : 0));
  put_camera(writer, frame.camera);
  if (frame.sparse) {
    put_text(writer, frame.reference);
    writer.put(frame.reference_stamp);
    put_pose(writer, frame.motion);
  }
  put_text(writer, frame.colour_codec);
  put_report(writer, frame.report);
  writer.put(static_cast<std::uint32_t>(mask.size()));
  writer.put(static_cast<std::uint32_t>(frame.depth.size()));
  writer.put(static_cast<std::uint32_t>(frame.colour.size()));
  writer.append(mask);
  writer.append(frame.depth);
  writer.append(frame.colour);
  Bytes bytes = writer.take();
  seal(bytes);
  if (sizes != nullptr) {
    sizes->mask = mask.size();
    sizes->depth = frame.depth.size();
    sizes->colour = frame.colour.size();
    sizes->total = bytes.size();
    sizes->extras = bytes.size() - mask.size() - frame.depth.size() - frame.colour.size();
  }
  return bytes;
}

Result<EncodedFrame> parse_encoded_frame(ByteView bytes, EncodedSizes* sizes) {
  ByteReader reader(unseal(bytes));
  const auto version = reader.get<std::uint8_t>();
  const auto flags = reader.get<std::uint8_t>();
  if (!reader.ok()) return Error{"encoded frame damaged or cut short"};
  if (version != kVersion) return Error{"encoded frame of an unknown version"};
  if ((flags & ~kSparse) != 0) return Error{"encoded frame of an unknown kind"};

  EncodedFrame frame;
  frame.sparse = (flags & kSparse) != 0;
  Result<Camera> camera = get_camera(reader);
  if (!camera) return Error{"encoded frame: " + camera.reason()};
  frame.camera = *camera;
  if (frame.sparse && !get_reference(reader, frame)) {
    return Error{"encoded frame with an impossible reference or motion"};
  }
  if (!get_text(reader, frame.colour_codec)) return Error{"encoded frame names no colour codec"};
  if (!get_report(reader, frame.report)) return Error{"encoded frame with an impossible report"};

  const std::size_t mask_bytes = reader.get<std::uint32_t>();
  const std::size_t depth_bytes = reader.get<std::uint32_t>();
  const std::size_t colour_bytes = reader.get<std::uint32_t>();
  const ByteView mask = reader.get_view(mask_bytes);
  const ByteView depth = reader.get_view(depth_bytes);
  const ByteView colour = reader.get_view(colour_bytes);
  if (!reader.ok() || reader.left() != 0) return Error{"encoded frame whose lengths do not add up"};
  if (frame.sparse) {
    Result<BlockMaskPair> blocks =
        decode_mask_pair(mask, BlockGrid(frame.camera.width, frame.camera.height));
    if (!blocks) return Error{"encoded frame: " + blocks.reason()};
    frame.mask = std::move(blocks->colour);
    frame.depth_mask = std::move(blocks->depth);
  } else if (mask_bytes != 0) {
    return Error{"encoded frame is whole and has a mask"};
  }
  frame.depth = copy_of(depth);
  frame.colour = copy_of(colour);
  if (sizes != nullptr) {
    *sizes = {mask_bytes, depth_bytes, colour_bytes,
              bytes.size - mask_bytes - depth_bytes - colour_bytes, bytes.size};
  }
  return frame;
}

}  // namespace rprr
