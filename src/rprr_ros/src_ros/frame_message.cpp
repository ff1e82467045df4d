// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_ros/frame_message.hpp"

#include <cstring>
#include <memory>

#include "rprr_ros/conversions.hpp"
#include "rprr_wire/camera_wire.hpp"

namespace rprr {
namespace {

template <typename Value>
void copy_rows(const cv::Mat& image, std::vector<Value>& values) {
  const std::size_t row = image.elemSize() * static_cast<std::size_t>(image.cols);
  values.resize(row * static_cast<std::size_t>(image.rows) / sizeof(Value));
  auto* to = reinterpret_cast<std::uint8_t*>(values.data());
  for (int v = 0; v < image.rows; ++v, to += row) std::memcpy(to, image.ptr(v), row);
}

// Empty if the values are not as many as the image has.
template <typename Value>
cv::Mat image_of(const std::vector<Value>& values, const Camera& camera, int type) {
  cv::Mat image(camera.height, camera.width, type);
  const std::size_t bytes = image.total() * image.elemSize();
  if (values.size() * sizeof(Value) != bytes) return {};
  std::memcpy(image.data, values.data(), bytes);
  return image;
}

}  // namespace

rprr_msgs::RgbdFrame to_message(const RgbdFrame& frame) {
  rprr_msgs::RgbdFrame message;
  message.header.stamp = to_time(frame.stamp);
  message.header.frame_id = frame.frame_id;
  ByteWriter writer;
  put_camera(writer, frame.camera);
  message.camera = writer.take();
  message.depth_unit = frame.depth.unit;
  copy_rows(frame.depth.counts, message.depth);
  copy_rows(frame.bgr, message.bgr);
  return message;
}

Result<RgbdFramePtr> frame_from_message(const rprr_msgs::RgbdFrame& message) {
  ByteReader reader{ByteView(message.camera)};
  const Result<Camera> camera = get_camera(reader);
  if (!camera) return Error{camera.reason()};
  if (!(message.depth_unit > 0.0)) return Error{"depth unit that is not above 0"};
  const auto frame = std::make_shared<RgbdFrame>();
  frame->stamp = to_stamp(message.header.stamp);
  frame->frame_id = message.header.frame_id;
  frame->camera = *camera;
  frame->depth.unit = message.depth_unit;
  frame->depth.counts = image_of(message.depth, *camera, CV_16UC1);
  if (frame->depth.counts.empty()) return Error{"depth is not of the camera's size"};
  if (!message.bgr.empty()) {
    frame->bgr = image_of(message.bgr, *camera, CV_8UC3);
    if (frame->bgr.empty()) return Error{"colours are not of the camera's size"};
  }
  return RgbdFramePtr(frame);
}

}  // namespace rprr
