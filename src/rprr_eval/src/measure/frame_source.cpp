// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_eval/measure/frame_source.hpp"

#include <algorithm>

#include "rprr_synthetic/sensor_model.hpp"
#include "rprr_synthetic/trajectory.hpp"
#include "rprr_wire/camera_wire.hpp"

namespace rprr {
namespace {

RgbdFramePtr frame_of(const RgbdImage& image, const Camera& camera, Stamp stamp) {
  auto frame = std::make_shared<RgbdFrame>();
  frame->stamp = stamp;
  frame->camera = rounded_for_wire(camera);
  frame->depth = image.depth;
  frame->bgr = image.bgr;
  return frame;
}

}  // namespace

Result<RgbdFramePtr> FrameSource::frame(std::size_t entry) {
  const auto found = frames_.find(entry);
  if (found != frames_.end()) return found->second;
  const Result<RgbdImage> image = folder_.load(entry);
  if (!image) return Error{image.reason()};
  if (order_.size() >= kept_) {
    frames_.erase(order_.front());
    order_.erase(order_.begin());
  }
  RgbdFramePtr made = frame_of(*image, folder_.camera, folder_.entries[entry].stamp);
  frames_[entry] = made;
  order_.push_back(entry);
  return made;
}

Result<std::vector<FramePair>> folder_pairs(FrameSource& source, std::size_t step,
                                            std::size_t most) {
  std::vector<FramePair> pairs;
  const std::size_t entries = source.folder().entries.size();
  if (entries <= step) return pairs;
  const std::size_t all = entries - step;
  const std::size_t count = std::min(all, most);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t k = i * all / count;
    const Result<RgbdFramePtr> a = source.frame(k);
    if (!a) return Error{a.reason()};
    const Result<RgbdFramePtr> b = source.frame(k + step);
    if (!b) return Error{b.reason()};
    pairs.emplace_back(*a, *b);
  }
  return pairs;
}

std::vector<FramePair> synthetic_pairs(int count, std::uint32_t seed) {
  const Scene room = make_room(seed);
  const SensorModel sensor_a = example_sensor_a();
  const SensorModel sensor_b = example_sensor_b();
  std::vector<FramePair> pairs;
  std::uint32_t noise = seed * 10000;
  for (const PairPose& poses : pair_walk(count, seed)) {
    const Stamp stamp = from_seconds(1.0 + static_cast<double>(pairs.size()));
    const RgbdImage a = sense(room, sensor_a, poses.a, noise++);
    const RgbdImage b = sense(room, sensor_b, poses.b, noise++);
    pairs.emplace_back(frame_of(a, sensor_a.camera, stamp), frame_of(b, sensor_b.camera, stamp));
  }
  return pairs;
}

}  // namespace rprr
