// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_pose/update_wire.hpp"
#include "rprr_wire/bytes.hpp"
#include "rprr_wire/camera_wire.hpp"

#include <algorithm>
#include <cmath>

namespace rprr {
namespace {

constexpr std::uint8_t kVersion = 1;
constexpr std::uint8_t kRequest = 0;
constexpr std::uint8_t kHalf = 1;
constexpr double kFarthest = 1e3;  // [m] no two cameras of an exchange are further apart

void put_start(ByteWriter& writer, std::uint8_t kind, std::uint8_t iteration) {
  writer.put(kVersion);
  writer.put(kind);
  writer.put(iteration);
}

// Empty, or why the start of an update is not of the kind.
std::string check_start(ByteReader& reader, std::uint8_t kind, std::uint8_t& iteration) {
  const auto version = reader.get<std::uint8_t>();
  const auto found = reader.get<std::uint8_t>();
  iteration = reader.get<std::uint8_t>();
  if (!reader.ok()) return "pose update damaged or cut short";
  if (version != kVersion) return "pose update of an unknown version";
  if (found != kind) return "pose update of the other kind";
  return {};
}

std::uint16_t small(std::uint32_t count) {
  return static_cast<std::uint16_t>(std::min<std::uint32_t>(count, 65535));
}

Pose get_pose(ByteReader& reader, double& quaternion_length) {
  Eigen::Vector3d translation;
  Eigen::Vector4d rotation;
  for (int i = 0; i < 3; ++i) translation[i] = static_cast<double>(reader.get<float>());
  for (int i = 0; i < 4; ++i) rotation[i] = static_cast<double>(reader.get<float>());
  quaternion_length = rotation.norm();
  return make_pose(translation, rotation);
}

void put_pose(ByteWriter& writer, const Pose& pose) {
  const Eigen::Quaterniond q(pose.linear());
  for (int i = 0; i < 3; ++i) writer.put(static_cast<float>(pose.translation()[i]));
  for (const double value : {q.x(), q.y(), q.z(), q.w()}) writer.put(static_cast<float>(value));
}

bool possible(const NormalEquations& e) {
  const bool counts = e.in_view <= e.points && e.matched <= e.in_view &&
                      e.consistent <= e.in_view && e.violating <= e.in_view;
  const bool numbers = e.ktwk.allFinite() && e.ktwy.allFinite() && std::isfinite(e.sum_residual2) &&
                       std::isfinite(e.sum_weight) && std::isfinite(e.sum_normalised2) &&
                       std::isfinite(e.sum_abs_dz);
  return counts && numbers && e.sum_residual2 >= 0.0 && e.sum_weight >= 0.0 &&
         e.sum_normalised2 >= 0.0 && e.sum_abs_dz >= 0.0 && e.ktwk.diagonal().minCoeff() >= 0.0;
}

}  // namespace

Bytes encode_request(const PoseRequest& request) {
  ByteWriter writer;
  put_start(writer, kRequest, request.iteration);
  put_pose(writer, request.b_from_a);
  writer.put(static_cast<float>(request.c));
  writer.put(static_cast<std::uint8_t>(request.by_noise ? 1 : 0));
  writer.put(request.points_iteration);
  Bytes bytes = writer.take();
  seal(bytes);
  return bytes;
}

Bytes encode_half(const PoseHalf& half) {
  const NormalEquations& e = half.equations;
  ByteWriter writer;
  put_start(writer, kHalf, half.iteration);
  for (int i = 0; i < 6; ++i) {
    for (int j = i; j < 6; ++j) writer.put(static_cast<float>(e.ktwk(i, j)));
  }
  for (int i = 0; i < 6; ++i) writer.put(static_cast<float>(e.ktwy[i]));
  for (const double sum : {e.sum_residual2, e.sum_weight, e.sum_normalised2, e.sum_abs_dz}) {
    writer.put(static_cast<float>(sum));
  }
  for (const std::uint32_t n : {e.points, e.in_view, e.matched, e.consistent, e.violating}) {
    writer.put(small(n));
  }
  Bytes bytes = writer.take();
  seal(bytes);
  return bytes;
}

Pose rounded_for_wire(const Pose& pose) {
  ByteWriter writer;
  put_pose(writer, pose);
  ByteReader reader(writer.bytes());
  double length = 0.0;
  return get_pose(reader, length);
}

bool is_of_dependent(ByteView bytes) {
  return bytes.size > 1 && bytes.data[1] == kHalf;
}

Result<PoseRequest> decode_request(ByteView bytes) {
  ByteReader reader(unseal(bytes));
  PoseRequest request;
  const std::string wrong = check_start(reader, kRequest, request.iteration);
  if (!wrong.empty()) return Error{wrong};
  double length = 0.0;
  request.b_from_a = get_pose(reader, length);
  request.c = static_cast<double>(reader.get<float>());
  request.by_noise = (reader.get<std::uint8_t>() & 1) != 0;
  request.points_iteration = reader.get<std::uint8_t>();
  if (!reader.ok() || reader.left() != 0) return Error{"pose request of a wrong length"};
  if (!(std::abs(length - 1.0) < 1e-3) || !is_rigid(request.b_from_a) ||
      !(request.b_from_a.translation().norm() < kFarthest) || !(request.c >= 0.0) ||
      !(request.c < kFarthest)) {
    return Error{"pose request with impossible numbers"};
  }
  return request;
}

Result<PoseHalf> decode_half(ByteView bytes) {
  ByteReader reader(unseal(bytes));
  PoseHalf half;
  const std::string wrong = check_start(reader, kHalf, half.iteration);
  if (!wrong.empty()) return Error{wrong};
  NormalEquations& e = half.equations;
  for (int i = 0; i < 6; ++i) {
    for (int j = i; j < 6; ++j) {
      e.ktwk(i, j) = e.ktwk(j, i) = static_cast<double>(reader.get<float>());
    }
  }
  for (int i = 0; i < 6; ++i) e.ktwy[i] = static_cast<double>(reader.get<float>());
  for (double* sum : {&e.sum_residual2, &e.sum_weight, &e.sum_normalised2, &e.sum_abs_dz}) {
    *sum = static_cast<double>(reader.get<float>());
  }
  for (std::uint32_t* n : {&e.points, &e.in_view, &e.matched, &e.consistent, &e.violating}) {
    *n = reader.get<std::uint16_t>();
  }
  if (!reader.ok() || reader.left() != 0) return Error{"half of the equations of a wrong length"};
  if (!possible(e)) return Error{"half of the equations with impossible numbers"};
  return half;
}

}  // namespace rprr
