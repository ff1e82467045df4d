// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "rprr_codec/encoded_frame.hpp"
#include "rprr_codec/frame_codec.hpp"
#include "rprr_geometry/block_mask.hpp"
#include "rprr_geometry/camera.hpp"
#include "rprr_geometry/depth_frame.hpp"
#include "rprr_geometry/se3.hpp"
#include "rprr_geometry/stamp.hpp"
#include "rprr_geometry/steady_time.hpp"
#include "rprr_radio/frame_chunk.hpp"
#include "rprr_station/energy.hpp"
#include "rprr_view/base_fusion.hpp"
#include "rprr_view/stitch.hpp"
#include "rprr_view/view_synthesis.hpp"
#include "rprr_wire/bytes.hpp"

namespace rprr {

struct StationOptions {
  std::vector<std::string> robots;  // whom the station listens to; what others send is refused
  SynthesisOptions synthesis;
  StitchOptions stitch;
  EnergyModel energy;
  std::size_t references_held = 4;  // whole frames kept per robot
  std::size_t waiting = 4;          // sparse frames per robot that may wait for their reference
  Duration wait_for_reference = from_seconds(2.0);
  std::size_t largest_message = std::size_t{8} << 20;  // bytes of an encoded frame
  std::size_t largest_image = kLargestImage;           // [px]
};

/// An rprr_msgs/EncodedFrame as it came over the radio. Everything in it is untrusted.
struct ReceivedMessage {
  std::string robot;  // by the topic
  Stamp stamp = 0;    // of the sender's frame
  std::string frame_id;
  std::uint32_t exchange = 0;
  ByteView data;                  // a frame's container, or a chunk of one (frame_chunk.hpp)
  std::size_t message_bytes = 0;  // of all messages that carried it, serialised; 0: of this one
};

/// A robot's view as the station knows it. Images may be shared with the station: nobody writes to
/// them.
struct RebuiltFrame {
  std::string robot;
  Stamp stamp = 0;
  std::string frame_id;  // as the sender wrote it
  std::uint32_t exchange = 0;
  bool sparse = false;
  Camera camera;
  cv::Mat bgr;                       // CV_8UC3
  DepthFrame depth;                  // counts of the sender's own unit
  cv::Mat provenance;                // CV_8UC1, see Provenance
  std::string reference;             // sparse: whom it was predicted from
  Stamp reference_stamp = 0;         // sparse
  Pose b_from_a = Pose::Identity();  // sparse: from the reference's optical frame to this one's

  int blocks_total = 0;
  int blocks_sent = 0;
  int blocks_sent_without_depth = 0;
  int blocks_colour_only = 0;
  BlockMask received_depth;    // sparse: blocks whose depth is the sender's, exactly unless rounded
  bool depth_rounded = false;  // by the sender, to steps of inverse depth
  EncodedSizes sizes;          // of the container
  FrameReport report;          // what the sender said of itself: untrusted
  std::size_t bytes_masks = 0;   // both ways: the sender's report and the mask in the container
  std::size_t bytes_extras = 0;  // of the message: all but mask, depth and colour
  std::size_t bytes_total = 0;   // everything that this frame caused to be sent
  double ms_decode = 0.0;
  double ms_reconstruct = 0.0;
  double share_received = 1.0;  // of all pixels
  double share_predicted = 0.0;
  double share_base = 0.0;  // neither: the sender's own, at low quality
  double energy_mj = 0.0;
  double energy_independent_mj = 0.0;  // 0: the sender did not measure it
};

/// Why a message came to nothing.
struct StationError {
  std::string robot;
  Stamp stamp = 0;
  std::string reason;
};

/// A whole frame that the station needs and has not.
struct RepeatRequest {
  std::string robot;
  Stamp stamp = 0;
};

struct StationOutput {
  std::vector<RebuiltFrame> frames;
  std::vector<StationError> errors;
  std::vector<RepeatRequest> repeats;
};

/// The remote monitoring station: encoded frames in, views out. Holds each robot's last whole
/// frames as references; sparse frames may come before their reference and then wait, for a
/// bounded time and in bounded number. A state machine without a clock of its own: `now` is any
/// steady time in nanoseconds. One object serves one thread.
///
/// Hostile senders: only configured robots are heard, message and image sizes are capped before
/// anything is decoded, and nothing grows with the number of messages.
class Station {
 public:
  /// colour decodes colour payloads: isolated in its own process where they come over a radio.
  Station(StationOptions options, std::unique_ptr<ColourDecoder> colour);

  StationOutput receive(const ReceivedMessage& message, SteadyTime now);
  /// Asks for references that do not come and gives up sparse frames whose reference does not come.
  StationOutput tick(SteadyTime now);

  /// Stamps of the whole frames held of a robot, oldest first.
  std::vector<Stamp> held(const std::string& robot) const;
  /// Stamp of the last frame that came of a robot, whole or not and whatever became of it; 0: none.
  Stamp last(const std::string& robot) const;
  /// Sparse frames of all robots that wait for their reference.
  std::size_t waiting() const;

 private:
  struct Reference {
    Stamp stamp;
    Camera camera;
    DepthFrame depth;
    cv::Mat bgr;
  };
  struct Waiting {
    RebuiltFrame frame;
    EncodedFrame encoded;
    SteadyTime deadline;
    std::optional<SteadyTime> ask_at;  // when its reference is asked for; none: it was
  };
  struct Robot {
    std::deque<Reference> references;
    std::deque<Waiting> waiting;
    FrameAssembler chunks;
    std::size_t incomplete = 0;  // frames of chunks that were reported as such
    Stamp last = 0;
  };

  void receive_chunk(const ReceivedMessage& message, SteadyTime now, StationOutput& output);
  void report_incomplete(const std::string& name, Robot& robot, StationOutput& output);
  void receive_frame(const ReceivedMessage& message, SteadyTime now, StationOutput& output);
  Result<EncodedFrame> parse(const ReceivedMessage& message, RebuiltFrame& frame) const;
  void account(const ReceivedMessage& message, const EncodedFrame& encoded,
               RebuiltFrame& frame) const;
  void rebuild_whole(RebuiltFrame frame, const EncodedFrame& encoded, StationOutput& output);
  void rebuild_sparse(RebuiltFrame frame, const EncodedFrame& encoded, const Reference& reference,
                      StationOutput& output);
  void wait(RebuiltFrame frame, EncodedFrame encoded, SteadyTime now, StationOutput& output);
  void serve_waiting(const std::string& reference, Stamp stamp, StationOutput& output);
  void give_up(const Waiting& waiting, const std::string& reason, StationOutput& output) const;
  const Reference* find_reference(const std::string& robot, Stamp stamp) const;

  StationOptions options_;
  FrameDecoder decoder_;
  ViewSynthesizer synthesizer_;
  BaseFusion fusion_;
  Stitcher stitcher_;
  PredictedView predicted_;
  std::map<std::string, Robot> robots_;
};

}  // namespace rprr
