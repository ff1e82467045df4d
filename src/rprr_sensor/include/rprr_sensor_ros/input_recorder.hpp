// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/ros.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "rprr_geometry/result.hpp"

namespace rosbag {
class Bag;
}

namespace rprr {

struct RecordingLimits {
  double seconds = 0.0;    // from the first message on; 0: none
  double megabytes = 0.0;  // of the file, 1e6 bytes; 0: none
};

/// How one topic's recording goes.
struct TopicCount {
  std::string topic;
  bool is_input = true;        // one of a robot's three; false: tf
  std::uint64_t messages = 0;  // written
  std::uint64_t lost = 0;      // that the publisher numbered but that never came here
};

/// Records RPRR's inputs of some robots into a bag: exactly the three topics of each, and tf if
/// wanted. The file is "<path>.active" until finish(). Its callbacks, and so all of it, run on the
/// node handle's queue.
class InputRecorder {
 public:
  /// `compression` is none, bz2 or lz4. Errors: a file that exists, a place that cannot be written.
  static Result<std::unique_ptr<InputRecorder>> create(const std::string& path,
                                                       const std::string& compression,
                                                       const RecordingLimits& limits);
  ~InputRecorder();
  InputRecorder(const InputRecorder&) = delete;
  InputRecorder& operator=(const InputRecorder&) = delete;

  void subscribe(ros::NodeHandle& nh, const std::vector<std::string>& robots, bool with_tf);

  /// A limit is reached, or the disk is full; nothing more is written.
  bool done() const { return done_; }
  double seconds() const;
  double megabytes() const;
  const std::vector<TopicCount>& counts() const { return counts_; }

  /// Closes the bag and gives it its name. Errors: what went wrong while writing.
  Result<std::string> finish();

 private:
  InputRecorder(const std::string& path, const RecordingLimits& limits,
                std::unique_ptr<rosbag::Bag> bag);
  template <typename Message>
  void listen(ros::NodeHandle& nh, const std::string& topic, bool is_input);
  template <typename Message>
  void write(std::size_t topic, const ros::MessageEvent<const Message>& event);
  void fail(const std::string& reason);

  std::string path_;
  RecordingLimits limits_;
  std::unique_ptr<rosbag::Bag> bag_;
  std::vector<TopicCount> counts_;
  std::vector<std::uint32_t> last_numbers_;
  std::vector<ros::Subscriber> subscribers_;
  ros::WallTime begin_;
  bool done_ = false;
  bool finished_ = false;
  std::string fault_;
};

}  // namespace rprr
