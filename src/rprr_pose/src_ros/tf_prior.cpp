// SPDX-License-Identifier: BSD-3-Clause
#include "tf_prior.hpp"

#include <tf2/exceptions.h>

#include <algorithm>
#include <cstdlib>
#include <utility>

#include "rprr_ros/conversions.hpp"
#include "transforms.hpp"

namespace rprr {
namespace {

constexpr std::size_t kLongestChain = 100;  // frames; nothing real comes near it
// tf is often a little behind the cameras. A pose this old is still worth trying.
constexpr Duration kLate = from_seconds(0.2);

bool contains(const std::vector<std::string>& chain, const std::string& frame) {
  return std::find(chain.begin(), chain.end(), frame) != chain.end();
}

std::string for_robot(std::string pattern, const std::string& robot) {
  static const std::string kMark = "{robot}";
  const std::size_t at = pattern.find(kMark);
  if (at != std::string::npos) pattern.replace(at, kMark.size(), robot);
  return clean_frame(pattern);
}

}  // namespace

TfPrior::TfPrior(const tf2::BufferCore& buffer, TfPriorOptions options)
    : buffer_(buffer), options_(std::move(options)) {
}

std::vector<Pose> TfPrior::propose(const FrameNames& frames, const std::optional<KnownPose>& last) {
  FrameNames cleaned = frames;
  cleaned.a_frame_id = clean_frame(frames.a_frame_id);
  cleaned.b_frame_id = clean_frame(frames.b_frame_id);
  std::vector<Pose> poses;
  if (cleaned.a_frame_id.empty() || cleaned.b_frame_id.empty() ||
      cleaned.a_frame_id == cleaned.b_frame_id) {
    return poses;
  }
  const Chain a = chain_of(cleaned.a_frame_id, cleaned.a_frame_id);
  const Chain b = chain_of(cleaned.b_frame_id, cleaned.a_frame_id);
  if (last) {
    if (const auto pose = carried(cleaned, *last, a, b)) poses.push_back(*pose);
  }
  if (const auto pose = through_tree(cleaned, a, b)) poses.push_back(*pose);
  return poses;
}

std::string TfPrior::take_complaint() {
  return std::exchange(complaint_, {});
}

// Target from source, by exactly this stamp or else by the newest there is if that is near it.
std::optional<Pose> TfPrior::lookup(const std::string& target, const std::string& source,
                                    Stamp at) const {
  if (target == source) return Pose::Identity();
  try {
    return from_transform(buffer_.lookupTransform(target, source, to_time(at)).transform);
  } catch (const tf2::TransformException&) {  // perhaps not here yet
  }
  try {
    const auto newest = buffer_.lookupTransform(target, source, ros::Time(0));
    if (std::abs(to_stamp(newest.header.stamp) - at) > kLate) return std::nullopt;
    return from_transform(newest.transform);
  } catch (const tf2::TransformException&) {
    return std::nullopt;
  }
}

// Ends at the root, or below a link that we published; empty if the frame itself is ours.
TfPrior::Chain TfPrior::chain_of(const std::string& frame, const std::string& a_frame) const {
  const std::string ours = rebuilt_frame(options_.peer);
  Chain chain;
  std::string next = frame;
  while (next != ours && chain.size() < kLongestChain) {
    chain.push_back(next);
    std::string parent;
    if (!buffer_._getParent(next, ros::Time(0), parent) || parent.empty()) break;
    if (options_.publishes_root && parent == a_frame) break;
    next = parent;
  }
  return chain;
}

std::optional<Pose> TfPrior::through_tree(const FrameNames& frames, const Chain& a,
                                          const Chain& b) {
  if (a.empty() || b.empty()) return std::nullopt;
  const bool told = !options_.fixed_frame.empty();
  const std::string fixed = told ? clean_frame(options_.fixed_frame) : a.back();
  std::optional<Pose> a_to_fixed, fixed_to_b;
  if (contains(a, fixed)) a_to_fixed = lookup(fixed, frames.a_frame_id, frames.a_stamp);
  if (contains(b, fixed)) fixed_to_b = lookup(frames.b_frame_id, fixed, frames.b_stamp);
  if (a_to_fixed && fixed_to_b) return *fixed_to_b * *a_to_fixed;
  if (told) {
    complaint_ = "~tf_prior_fixed_frame is " + fixed + ", but tf knows no " +
                 (a_to_fixed ? frames.b_frame_id : frames.a_frame_id) +
                 " under it at the images' stamps; publish it here, or leave it at auto";
  }
  return std::nullopt;
}

std::optional<Pose> TfPrior::carried(const FrameNames& frames, const KnownPose& last,
                                     const Chain& a, const Chain& b) {
  const auto a_moved = moved(options_.robot, a, last.frames.a_stamp, frames.a_stamp, a_then_);
  const auto b_moved = moved(options_.peer, b, last.frames.b_stamp, frames.b_stamp, b_then_);
  if (!a_moved && !b_moved) return std::nullopt;
  const Pose stays = Pose::Identity();
  return b_moved.value_or(stays) * last.b_from_a * a_moved.value_or(stays).inverse();
}

// Maps points of the camera's frame then into its frame now.
std::optional<Pose> TfPrior::moved(const std::string& robot, const Chain& chain, Stamp then,
                                   Stamp now, Remembered& memory) {
  if (chain.empty()) return std::nullopt;
  const bool told = !options_.odom_frame.empty();
  const std::string above = told ? for_robot(options_.odom_frame, robot) : chain.back();
  const std::string& camera = chain.front();
  if (memory.stamp != then || memory.camera != camera || memory.above != above) {
    memory = {then, camera, above, std::nullopt};
  }
  std::optional<Pose> above_to_now;
  if (camera != above && contains(chain, above)) {
    if (!memory.pose) memory.pose = lookup(above, camera, then);
    above_to_now = lookup(camera, above, now);
  }
  if (above_to_now && memory.pose) return *above_to_now * *memory.pose;
  if (told && !above_to_now) {
    complaint_ = "~tf_prior_odom_frame is " + above + " for " + robot + ", but tf knows no " +
                 camera +
                 " under it at the image's stamp; publish it here, or leave the "
                 "parameter empty";
  }
  return std::nullopt;
}

}  // namespace rprr
