// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_station/station.hpp"

#include <algorithm>
#include <chrono>
#include <opencv2/core.hpp>
#include <utility>

#include "rprr_geometry/block_mask.hpp"
#include "rprr_radio/frame_chunk.hpp"
#include "rprr_view/block_pixels.hpp"

namespace rprr {
namespace {

class Stopwatch {
 public:
  double milliseconds() const {
    return std::chrono::duration<double, std::milli>(Clock::now() - start_).count();
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now();
};

int blocks_without_depth(const DepthFrame& depth, const BlockGrid& grid, const BlockMask& sent) {
  int count = 0;
  for (int block = 0; block < grid.count(); ++block) {
    if (!sent.empty() && !sent[block]) continue;
    count += any_pixel(depth.counts, grid.rect(block)) ? 0 : 1;
  }
  return count;
}

void forget_blocks(const BlockMask& blocks, cv::Mat& provenance) {
  for (int block = 0; block < blocks.grid().count(); ++block) {
    if (blocks[block]) set_pixels(provenance, blocks.grid().rect(block), kNothing);
  }
}

// The sender's own figures are for display: nonsense becomes 0.
FrameReport cleaned(FrameReport report) {
  for (float* ms : {&report.ms_pose, &report.ms_predict, &report.ms_validate, &report.ms_encode}) {
    if (!(*ms >= 0.0f && *ms < 1e9f)) *ms = 0.0f;
  }
  return report;
}

}  // namespace

Station::Station(StationOptions options, std::unique_ptr<ColourDecoder> colour)
    : options_(std::move(options)),
      decoder_(std::move(colour)),
      synthesizer_(options_.synthesis),
      stitcher_(options_.stitch) {
  for (const std::string& robot : options_.robots) {
    robots_[robot].chunks = FrameAssembler(options_.largest_message);
  }
}

StationOutput Station::receive(const ReceivedMessage& message, SteadyTime now) {
  StationOutput output = tick(now);
  if (is_chunk(message.data)) {
    receive_chunk(message, now, output);
  } else {
    receive_frame(message, now, output);
  }
  return output;
}

void Station::receive_chunk(const ReceivedMessage& message, SteadyTime now, StationOutput& output) {
  const auto robot = robots_.find(message.robot);
  const Result<FrameChunk> chunk =
      robot == robots_.end()
          ? Result<FrameChunk>(Error{"robot '" + message.robot + "' is not configured"})
          : parse_chunk(message.data);
  if (!chunk) {
    output.errors.push_back({message.robot, message.stamp, chunk.reason()});
    return;
  }
  FrameAssembler& chunks = robot->second.chunks;
  const std::size_t bytes = encoded_message_bytes(message.frame_id.size(), message.data.size);
  const auto frame = chunks.add(message.stamp, message.frame_id, *chunk, bytes, now);
  report_incomplete(message.robot, robot->second, output);
  if (!frame) return;
  ReceivedMessage whole = message;
  whole.frame_id = frame->frame_id;
  whole.data = frame->data;
  whole.message_bytes = frame->message_bytes;
  receive_frame(whole, now, output);
}

void Station::report_incomplete(const std::string& name, Robot& robot, StationOutput& output) {
  if (robot.chunks.incomplete() == robot.incomplete) return;
  robot.incomplete = robot.chunks.incomplete();
  output.errors.push_back({name, robot.last, "parts of a frame did not come"});
}

void Station::receive_frame(const ReceivedMessage& message, SteadyTime now, StationOutput& output) {
  RebuiltFrame frame;
  Result<EncodedFrame> encoded = parse(message, frame);
  if (!encoded) {
    output.errors.push_back({message.robot, message.stamp, encoded.reason()});
    return;
  }
  robots_[message.robot].last = message.stamp;
  account(message, *encoded, frame);
  if (!encoded->sparse) {
    rebuild_whole(std::move(frame), *encoded, output);
    serve_waiting(message.robot, message.stamp, output);
  } else if (const Reference* reference =
                 find_reference(encoded->reference, encoded->reference_stamp)) {
    rebuild_sparse(std::move(frame), *encoded, *reference, output);
  } else {
    wait(std::move(frame), std::move(*encoded), now, output);
  }
}

StationOutput Station::tick(SteadyTime now) {
  StationOutput output;
  for (auto& [name, robot] : robots_) {
    robot.chunks.expire(now);
    report_incomplete(name, robot, output);
    auto& waiting = robot.waiting;
    while (!waiting.empty() && waiting.front().deadline <= now) {
      give_up(waiting.front(), "its reference did not come in time", output);
      waiting.pop_front();
    }
    for (Waiting& frame : waiting) {
      if (!frame.ask_at || now < *frame.ask_at) continue;
      frame.ask_at.reset();
      output.repeats.push_back({frame.encoded.reference, frame.encoded.reference_stamp});
    }
  }
  return output;
}

Stamp Station::last(const std::string& robot) const {
  const auto found = robots_.find(robot);
  return found == robots_.end() ? 0 : found->second.last;
}

std::vector<Stamp> Station::held(const std::string& robot) const {
  std::vector<Stamp> stamps;
  const auto found = robots_.find(robot);
  if (found == robots_.end()) return stamps;
  for (const Reference& reference : found->second.references) stamps.push_back(reference.stamp);
  return stamps;
}

std::size_t Station::waiting() const {
  std::size_t count = 0;
  for (const auto& [name, robot] : robots_) count += robot.waiting.size();
  return count;
}

Result<EncodedFrame> Station::parse(const ReceivedMessage& message, RebuiltFrame& frame) const {
  if (robots_.count(message.robot) == 0) {
    return Error{"robot '" + message.robot + "' is not configured"};
  }
  if (message.data.size > options_.largest_message) return Error{"encoded frame too long"};
  Result<EncodedFrame> encoded = parse_encoded_frame(message.data, &frame.sizes);
  if (!encoded) return encoded;
  const Camera& camera = encoded->camera;
  if (!camera.valid() ||
      static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height) >
          options_.largest_image) {
    return Error{"an image of " + std::to_string(camera.width) + "x" +
                 std::to_string(camera.height) + " is unusable or larger than ~largest_image = " +
                 std::to_string(options_.largest_image) + " pixels"};
  }
  if (!encoded->sparse) return encoded;
  if (robots_.count(encoded->reference) == 0) {
    return Error{"reference robot '" + encoded->reference + "' is not configured"};
  }
  const BlockGrid& grid = encoded->mask.grid();
  if (grid.width != camera.width || grid.height != camera.height || !is_rigid(encoded->b_from_a)) {
    return Error{"sparse frame without a usable block mask or pose"};
  }
  return encoded;
}

void Station::account(const ReceivedMessage& message, const EncodedFrame& encoded,
                      RebuiltFrame& frame) const {
  frame.robot = message.robot;
  frame.stamp = message.stamp;
  frame.frame_id = message.frame_id;
  frame.exchange = message.exchange;
  frame.sparse = encoded.sparse;
  frame.camera = encoded.camera;
  frame.reference = encoded.reference;
  frame.reference_stamp = encoded.reference_stamp;
  frame.b_from_a = encoded.b_from_a;
  frame.depth_rounded = encoded.depth_rounded;
  frame.report = cleaned(encoded.report);
  frame.blocks_total = BlockGrid(encoded.camera.width, encoded.camera.height).count();
  frame.blocks_sent = encoded.sparse ? encoded.mask.count() : frame.blocks_total;
  if (encoded.sparse) {
    frame.received_depth = encoded.depth_blocks();
    frame.blocks_colour_only = frame.blocks_sent - frame.received_depth.count();
  }

  const std::size_t own = message.message_bytes > 0
                              ? message.message_bytes
                              : encoded_message_bytes(message.frame_id.size(), message.data.size);
  const EncodedSizes& sizes = frame.sizes;
  frame.bytes_masks = sizes.mask + encoded.report.bytes_masks;
  frame.bytes_extras = own - std::min(own, sizes.mask + sizes.depth + sizes.colour + sizes.base);
  frame.bytes_total = own + encoded.report.bytes_pose + encoded.report.bytes_masks;

  const FrameReport& report = frame.report;
  frame.energy_mj = energy_millijoules(
      options_.energy, static_cast<double>(report.ms_pose) + report.ms_predict + report.ms_validate,
      report.ms_encode, frame.bytes_total);
  // The paper does not give the independent scheme's encoding time: the same is assumed.
  const std::size_t independent =
      static_cast<std::size_t>(report.independent_bytes_depth) + report.independent_bytes_colour;
  if (independent > 0) {
    frame.energy_independent_mj =
        energy_millijoules(options_.energy, 0.0, report.ms_encode, independent);
  }
}

void Station::rebuild_whole(RebuiltFrame frame, const EncodedFrame& encoded,
                            StationOutput& output) {
  const Stopwatch stopwatch;
  Result<DecodedFrame> decoded = decoder_.decode(encoded);
  frame.ms_decode = stopwatch.milliseconds();
  if (!decoded) {
    output.errors.push_back({frame.robot, frame.stamp, decoded.reason()});
    output.repeats.push_back({frame.robot, frame.stamp});
    return;
  }
  frame.bgr = decoded->bgr;
  frame.depth = decoded->depth;
  frame.provenance = cv::Mat(frame.bgr.size(), CV_8UC1, cv::Scalar(kReceived));
  frame.blocks_sent_without_depth =
      blocks_without_depth(frame.depth, BlockGrid(encoded.camera.width, encoded.camera.height), {});

  auto& references = robots_[frame.robot].references;
  const auto same = [&](const Reference& held) { return held.stamp == frame.stamp; };
  references.erase(std::remove_if(references.begin(), references.end(), same), references.end());
  if (references.size() >= std::max<std::size_t>(options_.references_held, 1)) {
    references.pop_front();
  }
  references.push_back({frame.stamp, frame.camera, frame.depth, frame.bgr});
  output.frames.push_back(std::move(frame));
}

void Station::rebuild_sparse(RebuiltFrame frame, const EncodedFrame& encoded,
                             const Reference& reference, StationOutput& output) {
  const Stopwatch decoding;
  const Result<DecodedFrame> decoded = decoder_.decode(encoded);
  frame.ms_decode = decoding.milliseconds();
  if (!decoded) {
    output.errors.push_back({frame.robot, frame.stamp, decoded.reason()});
    return;
  }
  const Stopwatch rebuilding;
  const BaseImage base{decoded->base, encoded.base_reduction, encoded.base_noise};
  const bool has_base = base.fits({encoded.camera.width, encoded.camera.height});
  synthesizer_.synthesize(reference.depth, reference.bgr, reference.camera, encoded.camera,
                          encoded.b_from_a, predicted_, has_base ? &base : nullptr);
  if (has_base) {
    // The base is not right where there is detail, and need not be.
    if (decoded->has_detail) forget_blocks(encoded.mask, predicted_.provenance);
    fusion_.fuse(base, predicted_);
  }
  Result<StitchedView> view =
      stitcher_.stitch(predicted_, decoded->has_detail ? decoded->bgr : cv::Mat(), decoded->depth,
                       encoded.mask, encoded.depth_blocks());
  frame.ms_reconstruct = rebuilding.milliseconds();
  if (!view) {
    output.errors.push_back({frame.robot, frame.stamp, view.reason()});
    return;
  }
  frame.bgr = view->bgr;
  frame.depth = view->depth;
  frame.provenance = view->provenance;
  frame.share_received = view->share_received;
  frame.share_predicted = view->share_predicted;
  frame.share_base = view->share_base;
  frame.blocks_sent_without_depth =
      blocks_without_depth(decoded->depth, encoded.mask.grid(), encoded.mask);
  output.frames.push_back(std::move(frame));
}

void Station::wait(RebuiltFrame frame, EncodedFrame encoded, SteadyTime now,
                   StationOutput& output) {
  if (options_.waiting == 0) {
    return give_up({std::move(frame), std::move(encoded), now, {}}, "its reference is not held",
                   output);
  }
  auto& waiting = robots_[frame.robot].waiting;
  const auto same = [&](const Waiting& other) { return other.frame.stamp == frame.stamp; };
  if (std::any_of(waiting.begin(), waiting.end(), same)) return;  // repeated
  if (waiting.size() >= options_.waiting) {
    give_up(waiting.front(), "too many frames wait for references", output);
    waiting.pop_front();
  }
  // It may be under way: a while later it is lost.
  waiting.push_back({std::move(frame), std::move(encoded), now + options_.wait_for_reference,
                     now + options_.wait_for_reference / 4});
}

void Station::serve_waiting(const std::string& reference, Stamp stamp, StationOutput& output) {
  const Reference* held = find_reference(reference, stamp);
  if (held == nullptr) return;
  for (auto& [name, robot] : robots_) {
    for (auto waiting = robot.waiting.begin(); waiting != robot.waiting.end();) {
      const EncodedFrame& encoded = waiting->encoded;
      if (encoded.reference != reference || encoded.reference_stamp != stamp) {
        ++waiting;
        continue;
      }
      rebuild_sparse(std::move(waiting->frame), encoded, *held, output);
      waiting = robot.waiting.erase(waiting);
    }
  }
}

void Station::give_up(const Waiting& waiting, const std::string& reason,
                      StationOutput& output) const {
  output.errors.push_back({waiting.frame.robot, waiting.frame.stamp,
                           reason + " (a whole frame of '" + waiting.encoded.reference + "')"});
  output.repeats.push_back({waiting.encoded.reference, waiting.encoded.reference_stamp});
}

const Station::Reference* Station::find_reference(const std::string& robot, Stamp stamp) const {
  const auto found = robots_.find(robot);
  if (found == robots_.end()) return nullptr;
  for (const Reference& reference : found->second.references) {
    if (reference.stamp == stamp) return &reference;
  }
  return nullptr;
}

}  // namespace rprr
