// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/bag_recording.hpp"

#include <geometry_msgs/PoseStamped.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <tf2/buffer_core.h>
#include <tf2/exceptions.h>
#include <tf2_msgs/TFMessage.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <utility>
#include <vector>

#include "rprr_ros/camera_info.hpp"
#include "rprr_ros/conversions.hpp"
#include "rprr_sensor/recordings/association.hpp"
#include "rprr_sensor/recordings/tum_folder.hpp"

namespace rprr {
namespace {

bool ends_with(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

/// Topics of a message type in the bag.
std::vector<std::string> topics_of_type(const rosbag::Bag& bag, const std::string& type) {
  rosbag::View view(bag, rosbag::TypeQuery(type));
  std::set<std::string> topics;
  for (const rosbag::ConnectionInfo* connection : view.getConnections()) {
    topics.insert(connection->topic);
  }
  return {topics.begin(), topics.end()};
}

std::string list_of(const std::vector<std::string>& topics) {
  std::string list;
  for (const auto& topic : topics) list += (list.empty() ? "" : ", ") + topic;
  return list.empty() ? "none" : list;
}

/// The one topic with the first of the endings that any topic has.
Result<std::string> choose_topic(const std::vector<std::string>& topics,
                                 const std::string& requested,
                                 const std::vector<std::string>& endings, const std::string& what) {
  if (!requested.empty()) {
    if (std::find(topics.begin(), topics.end(), requested) != topics.end()) return requested;
    return Error{"has no images on the " + what + " topic " + requested +
                 "; its image topics: " + list_of(topics)};
  }
  for (const auto& ending : endings) {
    std::vector<std::string> found;
    for (const auto& topic : topics) {
      if (ends_with(topic, ending)) found.push_back(topic);
    }
    if (found.size() == 1) return found.front();
    if (found.size() > 1) {
      return Error{"has more than one " + what + " topic (" + list_of(found) +
                   "): play a bag of two robots with pair.launch bag:=, or name one camera's with "
                   "colour_topic:= and depth_topic:="};
    }
  }
  return Error{
      "has no " + what + " images on a topic that ends with " + endings.front() + " or " +
      endings.back() +
      "; name it with colour_topic:= and depth_topic:=. Its image topics: " + list_of(topics)};
}

std::string before_ending(const std::string& topic, const std::string& ending) {
  const auto position = topic.rfind(ending);
  return position == std::string::npos ? std::string() : topic.substr(0, position);
}

struct ImageStream {
  std::vector<rosbag::MessageInstance> messages;
  std::vector<Stamp> stamps;
  std::string frame;  // of the first image, cleaned
};

class BagRecording : public Recording {
 public:
  explicit BagRecording(const RecordingOptions& options) : options_(options) {}

  /// The error, if there is one. Throws what rosbag throws.
  std::optional<Error> open(const std::string& path);

  const Camera& camera() const override { return camera_; }
  std::size_t size() const override { return pairs_.size(); }
  Result<RecordedFrame> load(std::size_t index) override;
  std::string remark() const override { return remark_; }

 private:
  ImageStream read_stream(const std::string& topic) const;
  std::optional<Error> find_camera(const std::string& colour_topic, const std::string& path);
  void read_poses(const std::string& colour_topic);
  void read_transforms();
  std::optional<Pose> pose_at(Stamp stamp) const;

  RecordingOptions options_;
  rosbag::Bag bag_;
  ImageStream colour_;
  ImageStream depth_;
  std::vector<std::pair<std::size_t, std::size_t>> pairs_;
  Camera camera_;
  std::string remark_;
  std::vector<Stamp> pose_stamps_;
  std::vector<Pose> poses_;
  tf2::BufferCore transforms_{ros::Duration(24.0 * 3600.0)};
};

std::optional<Error> BagRecording::open(const std::string& path) {
  bag_.open(path, rosbag::bagmode::Read);
  const auto topics = topics_of_type(bag_, "sensor_msgs/Image");
  const auto colour =
      choose_topic(topics, options_.colour_topic,
                   {"camera/rgb/image_rect_color", "camera/rgb/image_color"}, "colour");
  if (!colour) return Error{path + ": " + colour.reason()};
  const auto depth =
      choose_topic(topics, options_.depth_topic,
                   {"camera/depth_registered/image_rect", "camera/depth/image"}, "depth");
  if (!depth) return Error{path + ": " + depth.reason()};
  colour_ = read_stream(*colour);
  depth_ = read_stream(*depth);
  pairs_ = associate(colour_.stamps, depth_.stamps, from_seconds(options_.association_window_s));
  if (pairs_.empty()) {
    return Error{path + ": no image on " + *colour + " has one on " + *depth + " within " +
                 std::to_string(options_.association_window_s) + " s"};
  }
  read_poses(*colour);
  if (poses_.empty()) read_transforms();
  return find_camera(*colour, path);
}

ImageStream BagRecording::read_stream(const std::string& topic) const {
  ImageStream stream;
  rosbag::View view(bag_, rosbag::TopicQuery(topic));
  for (const rosbag::MessageInstance& message : view) {
    const auto image = message.instantiate<sensor_msgs::Image>();
    if (!image) continue;
    if (stream.messages.empty()) stream.frame = clean_frame(image->header.frame_id);
    stream.messages.push_back(message);
    stream.stamps.push_back(to_stamp(image->header.stamp));
  }
  return stream;
}

std::optional<Error> BagRecording::find_camera(const std::string& colour_topic,
                                               const std::string& path) {
  if (options_.camera) {
    camera_ = *options_.camera;
    return std::nullopt;
  }
  const std::string topic = colour_topic.substr(0, colour_topic.rfind('/')) + "/camera_info";
  const auto image = colour_.messages.front().instantiate<sensor_msgs::Image>();
  const ImageSize size =
      image ? ImageSize{static_cast<int>(image->width), static_cast<int>(image->height)}
            : ImageSize{};
  // A driver may say nothing useful at first: the first message that can be used counts.
  std::string reason;
  rosbag::View view(bag_, rosbag::TopicQuery(topic));
  for (const rosbag::MessageInstance& message : view) {
    const auto info = message.instantiate<sensor_msgs::CameraInfo>();
    if (!info) continue;
    const auto camera = camera_from_info(*info, size);
    if (camera) {
      camera_ = *camera;
      return std::nullopt;
    }
    reason = camera.reason();
  }
  if (!reason.empty()) return Error{path + ": " + topic + ": " + reason};
  camera_ = tum_default_camera(path);
  remark_ = path + ": nothing on " + topic + "; taking fx=" + std::to_string(camera_.fx) +
            " fy=" + std::to_string(camera_.fy) + " cx=" + std::to_string(camera_.cx) +
            " cy=" + std::to_string(camera_.cy) +
            " (set the intrinsics as parameters if that is wrong)";
  return std::nullopt;
}

void BagRecording::read_poses(const std::string& colour_topic) {
  const std::string topic = before_ending(colour_topic, "camera/rgb/") + "ground_truth/pose";
  rosbag::View view(bag_, rosbag::TopicQuery(topic));
  for (const rosbag::MessageInstance& message : view) {
    const auto pose = message.instantiate<geometry_msgs::PoseStamped>();
    if (!pose) continue;
    const Stamp stamp = to_stamp(pose->header.stamp);
    if (!pose_stamps_.empty() && stamp <= pose_stamps_.back()) continue;
    const auto& p = pose->pose.position;
    const auto& q = pose->pose.orientation;
    const Pose world_from_camera = make_pose({p.x, p.y, p.z}, {q.x, q.y, q.z, q.w});
    if (!is_rigid(world_from_camera)) continue;
    pose_stamps_.push_back(stamp);
    poses_.push_back(world_from_camera);
  }
}

void BagRecording::read_transforms() {
  rosbag::View view(bag_, rosbag::TopicQuery(std::vector<std::string>{"/tf", "/tf_static"}));
  for (const rosbag::MessageInstance& message : view) {
    const auto transforms = message.instantiate<tf2_msgs::TFMessage>();
    if (!transforms) continue;
    const bool fixed = message.getTopic() == "/tf_static";
    for (auto transform : transforms->transforms) {
      transform.header.frame_id = clean_frame(transform.header.frame_id);
      transform.child_frame_id = clean_frame(transform.child_frame_id);
      transforms_.setTransform(transform, "bag", fixed);  // false for a bad one, which is skipped
    }
  }
}

std::optional<Pose> BagRecording::pose_at(Stamp stamp) const {
  const auto index = nearest_stamp(pose_stamps_, stamp, from_seconds(0.02));
  if (index) return poses_[*index];
  const ros::Time time = to_time(stamp);
  if (colour_.frame.empty() || !transforms_.canTransform("world", colour_.frame, time)) {
    return std::nullopt;
  }
  try {
    const auto transform = transforms_.lookupTransform("world", colour_.frame, time).transform;
    const auto& t = transform.translation;
    const auto& q = transform.rotation;
    const Pose pose = make_pose({t.x, t.y, t.z}, {q.x, q.y, q.z, q.w});
    return is_rigid(pose) ? std::optional<Pose>(pose) : std::nullopt;
  } catch (const tf2::TransformException&) {
    return std::nullopt;
  }
}

Result<RecordedFrame> BagRecording::load(std::size_t index) {
  if (index >= pairs_.size()) {
    return Error{"the bag has " + std::to_string(pairs_.size()) + " entries, none has number " +
                 std::to_string(index)};
  }
  const auto [c, d] = pairs_[index];
  const rosbag::MessageInstance& colour_message = colour_.messages[c];
  const rosbag::MessageInstance& depth_message = depth_.messages[d];
  try {
    const auto colour = colour_message.instantiate<sensor_msgs::Image>();
    const auto depth = depth_message.instantiate<sensor_msgs::Image>();
    if (!colour || !depth) return Error{"the bag's image messages have another definition"};
    const auto bgr = bgr_from_image(*colour);
    if (!bgr) return Error{colour_message.getTopic() + ": " + bgr.reason()};
    const auto counts = depth_from_image(*depth, options_.depth);
    if (!counts) return Error{depth_message.getTopic() + ": " + counts.reason()};
    const cv::Size size(camera_.width, camera_.height);
    if (bgr->size() != size || counts->counts.size() != size) {
      return Error{colour_message.getTopic() + " and " + depth_message.getTopic() +
                   ": images have another size than the camera (" + std::to_string(size.width) +
                   "x" + std::to_string(size.height) + "); depth must be registered to colour"};
    }
    // The messages die here: keep pixels of our own.
    const RgbdImage image{bgr->clone(), {counts->counts.clone(), counts->unit}};
    return RecordedFrame{colour_.stamps[c], image, pose_at(colour_.stamps[c]), depth_.stamps[d]};
  } catch (const rosbag::BagException& error) {
    return Error{std::string("the bag cannot be read: ") + error.what()};
  }
}

}  // namespace

Result<std::unique_ptr<Recording>> open_bag_recording(const std::string& path,
                                                      const RecordingOptions& options) {
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) {
    return Error{path + ": does not exist; give a folder in the TUM layout or a bag"};
  }
  try {
    auto recording = std::make_unique<BagRecording>(options);
    const auto error = recording->open(path);
    if (error) return *error;
    return std::unique_ptr<Recording>(std::move(recording));
  } catch (const std::exception& error) {  // rosbag and message deserialisation throw
    return Error{path + ": cannot be read as a bag: " + error.what() +
                 " (try rosbag reindex; unpack a .tgz first)"};
  }
}

}  // namespace rprr
