// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_codec/encoded_frame.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "rprr_wire/bytes.hpp"
#include "rprr_wire/camera_wire.hpp"
#include "rprr_wire/mask_wire.hpp"
#include "wire_numbers.hpp"

namespace rprr {
namespace {

constexpr std::uint8_t kVersion = 3;
constexpr std::size_t kFlagsAt = 1;
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

// The pose in fixed point: 7 nm and 5e-15 of a unit quaternion, of which the largest component
// follows from the others. Numbers that do not fit come out as another pose or none at all; the
// parser refuses what is not rigid.
constexpr double kTranslationSteps = static_cast<double>(std::int64_t{1} << 27);
constexpr double kRotationSteps = static_cast<double>(std::int64_t{1} << 47);
constexpr double kMaxTranslation = 1e6;  // [m]

std::int64_t steps_of(double value, double steps) {
  const double scaled = value * steps;
  constexpr double limit = kRotationSteps - 1.0;
  // No comparison holds for NaN.
  return scaled >= -limit && scaled <= limit ? std::llround(scaled)
                                             : -static_cast<std::int64_t>(kRotationSteps);
}

// Returns which component is the largest.
int put_pose(ByteWriter& writer, const Pose& pose) {
  const Eigen::Vector4d xyzw = Eigen::Quaterniond(pose.rotation()).coeffs();
  int largest = 0;
  xyzw.cwiseAbs().maxCoeff(&largest);
  const double sign = xyzw[largest] < 0.0 ? -1.0 : 1.0;
  for (int i = 0; i < 3; ++i) {
    put_int48(writer, steps_of(pose.translation()[i], kTranslationSteps));
  }
  for (int i = 0; i < 4; ++i) {
    if (i != largest) put_int48(writer, steps_of(sign * xyzw[i], kRotationSteps));
  }
  return largest;
}

bool get_pose(ByteReader& reader, int largest, Pose& pose) {
  Eigen::Vector3d translation;
  Eigen::Vector4d xyzw = Eigen::Vector4d::Zero();
  for (int i = 0; i < 3; ++i) {
    translation[i] = static_cast<double>(get_int48(reader)) / kTranslationSteps;
  }
  for (int i = 0; i < 4; ++i) {
    if (i != largest) xyzw[i] = static_cast<double>(get_int48(reader)) / kRotationSteps;
  }
  const double rest = 1.0 - xyzw.squaredNorm();
  // The largest of four is at least a half.
  if (!(rest > 0.2499) || !(translation.norm() < kMaxTranslation)) return false;
  xyzw[largest] = std::sqrt(rest);
  pose = make_pose(translation, xyzw);
  return is_rigid(pose);
}

// Milliseconds as whole microseconds.
std::uint32_t microseconds_of(float ms) {
  constexpr double limit = 4e9;
  const double us = 1e3 * static_cast<double>(ms);
  return us > 0.0 ? static_cast<std::uint32_t>(std::llround(std::min(us, limit))) : 0;
}

void put_report(ByteWriter& writer, const FrameReport& report) {
  for (const std::uint32_t number :
       {std::uint32_t{report.blocks_predicted}, std::uint32_t{report.blocks_validated},
        report.bytes_pose, report.bytes_masks, report.independent_bytes_depth,
        report.independent_bytes_colour, microseconds_of(report.ms_pose),
        microseconds_of(report.ms_predict), microseconds_of(report.ms_validate),
        microseconds_of(report.ms_encode)}) {
    put_varint(writer, number);
  }
}

bool get_report(ByteReader& reader, FrameReport& report) {
  std::array<std::uint32_t, 10> numbers = {};
  for (std::uint32_t& number : numbers) {
    if (!get_varint(reader, number)) return false;
  }
  if (std::max(numbers[0], numbers[1]) > std::numeric_limits<std::uint16_t>::max()) return false;
  const auto ms = [&](std::size_t i) { return static_cast<float>(numbers[i] / 1e3); };
  report = {static_cast<std::uint16_t>(numbers[0]),
            static_cast<std::uint16_t>(numbers[1]),
            numbers[2],
            numbers[3],
            numbers[4],
            numbers[5],
            ms(6),
            ms(7),
            ms(8),
            ms(9)};
  return true;
}

// The flags: bit 7 depth is rounded; the others of a sparse frame alone:
//   bit 0 sparse, bit 1 compact layout, bits 2-4 how often the base is halved, and 1 (0: no base),
//   bits 5-6 largest component of the quaternion
constexpr std::uint8_t kSparse = 0x01;
constexpr std::uint8_t kCompact = 0x02;
constexpr int kBaseShift = 2;
constexpr int kLargestShift = 5;
constexpr std::uint8_t kRounded = 0x80;

constexpr float kNoiseSteps = 8.0f;  // of a grey level

std::uint8_t flags_of(const EncodedFrame& frame, int largest) {
  const int rounded = frame.depth_rounded ? kRounded : 0;
  if (!frame.sparse) return static_cast<std::uint8_t>(rounded);
  int base = 0;
  while (base < 5 && 1 << base <= frame.base_reduction) ++base;
  return static_cast<std::uint8_t>(rounded | kSparse |
                                   (frame.colour_layout == ColourLayout::kCompact ? kCompact : 0) |
                                   base << kBaseShift | largest << kLargestShift);
}

// False where no frame has these.
bool read_flags(std::uint8_t flags, EncodedFrame& frame) {
  const int base = flags >> kBaseShift & 7;
  frame.sparse = (flags & kSparse) != 0;
  frame.colour_layout = (flags & kCompact) != 0 ? ColourLayout::kCompact : ColourLayout::kInPlace;
  frame.base_reduction = base == 0 ? 0 : 1 << (base - 1);
  frame.depth_rounded = (flags & kRounded) != 0;
  return (base == 0 || is_base_reduction(frame.base_reduction)) &&
         (frame.sparse || (flags & ~kRounded) == 0);
}

// Name of the base's codec, none standing for that of the detail, and its noise.
void put_base(ByteWriter& writer, const EncodedFrame& frame) {
  const long eighths = std::lround(kNoiseSteps * frame.base_noise);
  writer.put(static_cast<std::uint8_t>(std::clamp(eighths, 1L, 255L)));
  put_text(writer, frame.base_codec == frame.colour_codec ? std::string() : frame.base_codec);
}

bool get_base(ByteReader& reader, EncodedFrame& frame) {
  frame.base_noise = static_cast<float>(reader.get<std::uint8_t>()) / kNoiseSteps;
  if (!(frame.base_noise > 0.0f)) return false;
  if (!get_text(reader, frame.base_codec)) return false;
  if (frame.base_codec.empty()) frame.base_codec = frame.colour_codec;
  return true;
}

// The payloads' lengths.
struct Lengths {
  std::uint32_t mask = 0;
  std::uint32_t depth = 0;
  std::uint32_t colour = 0;
  std::uint32_t base = 0;

  std::uint64_t sum() const { return std::uint64_t{mask} + depth + colour + base; }
  EncodedSizes sizes(std::size_t total) const {
    return {mask, depth, colour, base, total - static_cast<std::size_t>(sum()), total};
  }
};

void put_lengths(ByteWriter& writer, const EncodedFrame& frame, const Lengths& lengths) {
  if (frame.sparse) put_varint(writer, lengths.mask);
  put_varint(writer, lengths.depth);
  if (frame.sparse && frame.base_reduction != 0) put_varint(writer, lengths.base);
}

// Colour takes what is left.
bool get_lengths(ByteReader& reader, const EncodedFrame& frame, Lengths& lengths) {
  if (frame.sparse && !get_varint(reader, lengths.mask)) return false;
  if (!get_varint(reader, lengths.depth)) return false;
  if (frame.base_reduction != 0 && !get_varint(reader, lengths.base)) return false;
  if (!reader.ok() || lengths.sum() > reader.left()) return false;
  lengths.colour = static_cast<std::uint32_t>(reader.left() - lengths.sum());
  return true;
}

// What only a sparse frame has, without the mask.
bool get_reference(ByteReader& reader, int largest, EncodedFrame& frame) {
  if (!get_text(reader, frame.reference) || frame.reference.empty()) return false;
  frame.reference_stamp = reader.get<Stamp>();
  return get_pose(reader, largest, frame.b_from_a);
}

Bytes copy_of(ByteView view) {
  return Bytes(view.data, view.data + view.size);
}

}  // namespace

Bytes serialise(const EncodedFrame& frame, EncodedSizes* sizes) {
  const Bytes mask = frame.sparse ? encode_mask_pair({frame.mask, frame.depth_blocks()}) : Bytes{};
  const auto size = [](const Bytes& bytes) { return static_cast<std::uint32_t>(bytes.size()); };
  const bool has_base = frame.sparse && frame.base_reduction != 0;
  const Lengths lengths = {size(mask), size(frame.depth), size(frame.colour),
                           has_base ? size(frame.base) : 0};
  ByteWriter writer;
  writer.bytes().reserve(256 + static_cast<std::size_t>(lengths.sum()));
  writer.put(kVersion);
  writer.put(std::uint8_t{0});  // flags: when all is known
  put_camera(writer, frame.camera);
  int largest = 0;
  if (frame.sparse) {
    put_text(writer, frame.reference);
    writer.put(frame.reference_stamp);
    largest = put_pose(writer, frame.b_from_a);
  }
  writer.bytes()[kFlagsAt] = flags_of(frame, largest);
  put_text(writer, frame.colour_codec);
  if (has_base) put_base(writer, frame);
  put_report(writer, frame.report);
  put_lengths(writer, frame, lengths);
  writer.append(mask);
  writer.append(frame.depth);
  if (has_base) writer.append(frame.base);
  writer.append(frame.colour);
  Bytes bytes = writer.take();
  seal(bytes);
  if (sizes != nullptr) *sizes = lengths.sizes(bytes.size());
  return bytes;
}

Result<EncodedFrame> parse_encoded_frame(ByteView bytes, EncodedSizes* sizes) {
  ByteReader reader(unseal(bytes));
  const auto version = reader.get<std::uint8_t>();
  const auto flags = reader.get<std::uint8_t>();
  if (!reader.ok()) return Error{"encoded frame damaged or cut short"};
  if (version != kVersion) return Error{"encoded frame of an unknown version"};
  EncodedFrame frame;
  if (!read_flags(flags, frame)) return Error{"encoded frame of an unknown kind"};

  Result<Camera> camera = get_camera(reader);
  if (!camera) return Error{"encoded frame: " + camera.reason()};
  frame.camera = *camera;
  if (frame.sparse && !get_reference(reader, flags >> kLargestShift & 3, frame)) {
    return Error{"encoded frame with an impossible reference or motion"};
  }
  if (!get_text(reader, frame.colour_codec)) return Error{"encoded frame names no colour codec"};
  if (frame.base_reduction != 0 && !get_base(reader, frame)) {
    return Error{"encoded frame names no codec or noise of its base"};
  }
  if (!get_report(reader, frame.report)) return Error{"encoded frame with an impossible report"};

  Lengths lengths;
  if (!get_lengths(reader, frame, lengths)) {
    return Error{"encoded frame whose lengths do not add up"};
  }
  if ((frame.base_reduction != 0) != (lengths.base != 0)) {
    return Error{"encoded frame whose base is empty"};
  }
  const ByteView mask = reader.get_view(lengths.mask);
  frame.depth = copy_of(reader.get_view(lengths.depth));
  frame.base = copy_of(reader.get_view(lengths.base));
  frame.colour = copy_of(reader.get_view(lengths.colour));
  if (frame.sparse) {
    Result<BlockMaskPair> blocks =
        decode_mask_pair(mask, BlockGrid(frame.camera.width, frame.camera.height));
    if (!blocks) return Error{"encoded frame: " + blocks.reason()};
    frame.mask = std::move(blocks->colour);
    frame.depth_mask = std::move(blocks->depth);
  }
  if (sizes != nullptr) *sizes = lengths.sizes(bytes.size);
  return frame;
}

}  // namespace rprr
