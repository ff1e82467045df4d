// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_sensor_ros/input_recorder.hpp"

#include <rosbag/bag.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <tf2_msgs/TFMessage.h>

#include <boost/function.hpp>
#include <exception>
#include <filesystem>
#include <type_traits>
#include <utility>

#include "recordings/close_bag.hpp"
#include "rprr_sensor_ros/frame_messages.hpp"

namespace rprr {
namespace {

constexpr std::uint32_t kQueue = 60;  // messages of a topic that wait for the disk: 2 s of a camera

}  // namespace

InputRecorder::InputRecorder(const std::string& path, const RecordingLimits& limits,
                             std::unique_ptr<rosbag::Bag> bag)
    : path_(path), limits_(limits), bag_(std::move(bag)) {
}

InputRecorder::~InputRecorder() {
  if (!finished_) finish();
}

Result<std::unique_ptr<InputRecorder>> InputRecorder::create(const std::string& path,
                                                             const std::string& compression,
                                                             const RecordingLimits& limits) {
  std::error_code ignored;
  for (const std::string& file : {path, path + ".active"}) {
    if (std::filesystem::exists(file, ignored)) {
      return Error{file + " exists already: give another name, or remove it"};
    }
  }
  try {
    auto bag = std::make_unique<rosbag::Bag>(path + ".active", rosbag::bagmode::Write);
    if (compression == "bz2") bag->setCompression(rosbag::compression::BZ2);
    if (compression == "lz4") bag->setCompression(rosbag::compression::LZ4);
    return std::unique_ptr<InputRecorder>(new InputRecorder(path, limits, std::move(bag)));
  } catch (const std::exception& error) {
    return Error{path + ": cannot be written: " + error.what()};
  }
}

void InputRecorder::subscribe(ros::NodeHandle& nh, const std::vector<std::string>& robots,
                              bool with_tf) {
  for (const std::string& robot : robots) {
    const InputTopics topics = input_topics(robot);
    listen<sensor_msgs::Image>(nh, topics.colour, true);
    listen<sensor_msgs::CameraInfo>(nh, topics.camera_info, true);
    listen<sensor_msgs::Image>(nh, topics.depth, true);
  }
  if (!with_tf) return;
  listen<tf2_msgs::TFMessage>(nh, "/tf", false);
  listen<tf2_msgs::TFMessage>(nh, "/tf_static", false);
}

template <typename Message>
void InputRecorder::listen(ros::NodeHandle& nh, const std::string& topic, bool is_input) {
  const std::size_t index = counts_.size();
  counts_.push_back({topic, is_input, 0, 0});
  last_numbers_.push_back(0);
  // The event has the connection's header, without which a latched topic is played back unlatched.
  const boost::function<void(const ros::MessageEvent<const Message>&)> callback =
      [this, index](const ros::MessageEvent<const Message>& event) { write(index, event); };
  subscribers_.push_back(nh.subscribe<Message>(topic, kQueue, callback));
}

template <typename Message>
void InputRecorder::write(std::size_t topic, const ros::MessageEvent<const Message>& event) {
  if (done_) return;
  if (begin_.isZero()) begin_ = ros::WallTime::now();
  if (limits_.seconds > 0.0 && seconds() >= limits_.seconds) {
    done_ = true;
    return;
  }
  if (event.getReceiptTime() < ros::TIME_MIN) {
    return fail(
        "there is no time to record by: /use_sim_time is true but nothing comes on /clock. "
        "Play with --clock, or set the parameter to false");
  }
  try {
    bag_->write(counts_[topic].topic, event);
  } catch (const std::exception& error) {
    return fail(path_ + ".active: " + error.what() + "; is the disk full?");
  }
  TopicCount& count = counts_[topic];
  if constexpr (!std::is_same_v<Message, tf2_msgs::TFMessage>) {
    const std::uint32_t number = event.getMessage()->header.seq;
    const std::uint32_t missed = number - last_numbers_[topic] - 1;
    // A publisher that starts again numbers from the beginning.
    if (count.messages > 0 && missed < 10000) count.lost += missed;
    last_numbers_[topic] = number;
  }
  ++count.messages;
  if (limits_.megabytes > 0.0 && megabytes() >= limits_.megabytes) done_ = true;
}

void InputRecorder::fail(const std::string& reason) {
  fault_ = reason;
  done_ = true;
}

double InputRecorder::seconds() const {
  return begin_.isZero() ? 0.0 : (ros::WallTime::now() - begin_).toSec();
}

double InputRecorder::megabytes() const {
  return 1e-6 * static_cast<double>(bag_->getSize());
}

Result<std::string> InputRecorder::finish() {
  finished_ = true;
  done_ = true;
  subscribers_.clear();
  const std::string part = path_ + ".active";
  // What was recorded until a fault keeps its preliminary name.
  const std::string problem = close_bag(bag_, part, fault_.empty() ? path_ : part);
  if (!fault_.empty()) return Error{fault_};
  if (!problem.empty()) return Error{problem};
  return path_;
}

}  // namespace rprr
