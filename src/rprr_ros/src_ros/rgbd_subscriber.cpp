// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_ros/rgbd_subscriber.hpp"

#include <cmath>
#include <exception>
#include <opencv2/core.hpp>
#include <sstream>
#include <utility>

#include "guarded_queue.hpp"
#include "image_pairing.hpp"
#include "rprr_geometry/depth_survey.hpp"
#include "rprr_ros/camera_info.hpp"
#include "rprr_ros/conversions.hpp"

namespace rprr {
namespace {

constexpr std::uint32_t kQueue = 5;
constexpr std::size_t kMostWaiting = 30;  // frames that wait for the first camera_info
constexpr double kPatience = 1.0;         // [s] that they wait
constexpr double kLeap = 10.0;            // [s] that stamps may be ahead of what has passed
constexpr unsigned kSameStamps = 3;       // images of one stamp in a row: its clock stands still
constexpr double kFarShare = 0.02;        // of the readings, beyond what a count can hold

ImageSize size_of(const sensor_msgs::Image& image) {
  return {static_cast<int>(image.width), static_cast<int>(image.height)};
}

std::string metres_text(double metres) {
  std::ostringstream text;
  text.precision(3);
  text << metres << " m";
  return text.str();
}

std::string percent_text(double share) {
  return std::to_string(std::lround(100.0 * share)) + "%";
}

}  // namespace

RgbdSubscriber::RgbdSubscriber(const ros::NodeHandle& nh, ros::NodeHandle private_nh,
                               const std::string& robot, const InputOptions& options,
                               Health& health, Callback callback)
    : robot_(robot),
      options_(options),
      health_(health),
      callback_(std::move(callback)),
      inputs_(nh, health),
      pairing_(std::make_unique<ImagePairing>(
          from_seconds(options.max_stamp_difference),
          [this](const auto& rgb, const auto& depth) { on_pair(rgb, depth); })) {
  queue_ = std::make_unique<GuardedQueue>([this](const std::string& what) {
    health_.error("transport", "an image was lost, since its transport threw: " + what +
                                   "; look at ~image_transport and ~depth_transport");
  });
  ros::NodeHandle image_nh(nh);
  image_nh.setCallbackQueue(queue_->queue());
  transport_ = std::make_unique<image_transport::ImageTransport>(image_nh);
  if (subscribe(image_nh, private_nh)) expect_inputs();
  timer_ = nh.createWallTimer(ros::WallDuration(2.0), &RgbdSubscriber::watch, this);
}

RgbdSubscriber::~RgbdSubscriber() {
  timer_.stop();
  info_subscriber_.shutdown();
  rgb_.subscriber.shutdown();
  depth_.subscriber.shutdown();
  queue_.reset();  // callbacks use all the rest
}

bool RgbdSubscriber::subscribe(ros::NodeHandle& nh, ros::NodeHandle& private_nh) {
  const std::string camera = "/" + robot_ + "/camera/";
  info_topic_ = nh.resolveName(camera + "rgb/camera_info");
  rgb_.topic = nh.resolveName(camera + "rgb/image_rect_color");
  depth_.topic = nh.resolveName(camera + "depth_registered/image_rect");
  info_subscriber_ = nh.subscribe(info_topic_, kQueue, &RgbdSubscriber::on_info, this);
  const auto listen = [&](Stream& stream, const std::string& transport, const auto& add) {
    const image_transport::TransportHints hints(transport, ros::TransportHints().tcpNoDelay(),
                                                private_nh);
    stream.heard_on = stream.topic + (transport == "raw" ? "" : "/" + transport);
    try {
      stream.subscriber = transport_->subscribe(
          stream.topic, kQueue,
          [this, &stream, add](const sensor_msgs::ImageConstPtr& image) {
            if (is_new(stream, *image)) add(image);
          },
          {}, hints);
    } catch (const std::exception& error) {  // image_transport throws where a plugin is missing
      health_.refuse_parameters("no transport '" + transport + "' for " + stream.topic +
                                "; installed: " + installed_transports() + " (" + error.what() +
                                ")");
      return false;
    }
    return true;
  };
  return listen(rgb_, options_.image_transport,
                [this](const auto& image) { pairing_->add_first(image); }) &&
         listen(depth_, options_.depth_transport,
                [this](const auto& image) { pairing_->add_second(image); });
}

std::string RgbdSubscriber::installed_transports() const {
  std::string names;
  for (const std::string& name : transport_->getLoadableTransports()) {
    names += (names.empty() ? "" : ", ") + name.substr(name.find('/') + 1);
  }
  return names;
}

void RgbdSubscriber::expect_inputs() {
  const std::string remedy = "start the camera or the bag, or remap the topic to the driver's";
  inputs_.expect(info_topic_, InputKind::kOnce, "camera_info", remedy);
  inputs_.expect(rgb_.heard_on, InputKind::kStream, "colour images", remedy);
  inputs_.expect(depth_.heard_on, InputKind::kStream, "depth images", remedy);
}

// False: the image is of no use, since its stamp says nothing.
bool RgbdSubscriber::is_new(Stream& stream, const sensor_msgs::Image& image) {
  inputs_.heard(stream.heard_on);
  const ros::Time stamp = image.header.stamp;
  const std::lock_guard<std::mutex> lock(mutex_);
  ++stream.seen;
  if (stamp.isZero()) {
    report("stamp of " + stream.topic, "stamps on " + stream.topic +
                                           " are 0, so its images are dropped: let the driver "
                                           "stamp them with the time of the exposure");
    return false;
  }
  if (stamp != stream.last) {
    stream.last = stamp;
    stream.same = 0;
    health_.clear("stamp of " + stream.topic);
    return true;
  }
  if (++stream.same >= kSameStamps) {
    report("stamp of " + stream.topic, "stamps on " + stream.topic +
                                           " do not move on, so its images are dropped: look at "
                                           "the driver's clock");
  }
  return false;
}

void RgbdSubscriber::on_info(const sensor_msgs::CameraInfoConstPtr& info) {
  inputs_.heard(info_topic_);
  std::deque<Pair> waiting;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    info_ = info;
    waiting.swap(waiting_);
  }
  for (const Pair& pair : waiting) emit(pair, *info);
}

void RgbdSubscriber::on_pair(const sensor_msgs::ImageConstPtr& rgb,
                             const sensor_msgs::ImageConstPtr& depth) {
  const Pair pair{rgb, depth, ros::SteadyTime::now()};
  sensor_msgs::CameraInfoConstPtr info;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ++pairs_seen_;
    watch_stamp(rgb->header.stamp);
    info = info_;
    if (!info) {
      waiting_.push_back(pair);
      while (waiting_.size() > kMostWaiting ||
             (pair.came - waiting_.front().came).toSec() > kPatience) {
        waiting_.pop_front();
      }
    }
  }
  if (info) emit(pair, *info);
}

void RgbdSubscriber::emit(const Pair& pair, const sensor_msgs::CameraInfo& info) {
  const ImageSize size = size_of(*pair.rgb);
  const ImageSize depth_size = size_of(*pair.depth);
  if (size.width != depth_size.width || size.height != depth_size.height) {
    return health_.error("sizes differ", rgb_.topic + " is " + text_of(size) + " but " +
                                             depth_.topic + " is " + text_of(depth_size) +
                                             "; publish depth registered to colour, of equal size");
  }
  const std::size_t pixels = std::size_t(pair.rgb->width) * pair.rgb->height;
  if (pixels > options_.largest_image) {
    return health_.error("image too large", rgb_.topic + " is " + text_of(size) +
                                                ", more than the " +
                                                std::to_string(options_.largest_image) +
                                                " pixels of ~largest_image: raise it here and at "
                                                "the station, or scale the images down");
  }
  const Result<Camera> camera = camera_from_info(info, size);
  if (!camera) {
    return health_.error("camera_info unusable",
                         info_topic_ + ", of " + rgb_.topic + ": " + camera.reason());
  }
  const Result<cv::Mat> bgr = bgr_from_image(*pair.rgb);
  if (!bgr) return health_.error("colour unusable", rgb_.topic + ": " + bgr.reason());
  const Result<DepthFrame> depth = depth_from_image(*pair.depth, options_.depth);
  if (!depth) return health_.error("depth unusable", depth_.topic + ": " + depth.reason());
  for (const char* key : {"image too large", "sizes differ", "camera_info unusable",
                          "colour unusable", "depth unusable"}) {
    health_.clear(key);
  }
  doubt(pair, info, *depth);

  const auto frame = std::make_shared<RgbdFrame>();
  frame->stamp = to_stamp(pair.rgb->header.stamp);
  frame->frame_id = clean_frame(pair.rgb->header.frame_id);
  if (frame->frame_id.empty()) frame->frame_id = optical_frame(robot_);
  frame->camera = *camera;
  frame->bgr = *bgr;
  frame->depth = *depth;
  frame->owner = std::make_shared<const Pair>(pair);
  health_.count("frames");
  callback_(frame);
}

// What can be used but is hardly meant: the frame goes on, since its colour is worth sending.
void RgbdSubscriber::doubt(const Pair& pair, const sensor_msgs::CameraInfo& info,
                           const DepthFrame& depth) {
  const std::string lens = doubt_of(info);
  report("camera_info doubtful", lens.empty() ? lens : info_topic_ + ": " + lens);

  const std::string colour_frame = clean_frame(pair.rgb->header.frame_id);
  const std::string depth_frame = clean_frame(pair.depth->header.frame_id);
  report("frames differ", colour_frame == depth_frame || depth_frame.empty() || colour_frame.empty()
                              ? std::string()
                              : depth_.topic + " is in frame '" + depth_frame + "' but " +
                                    rgb_.topic + " in '" + colour_frame +
                                    "': is that depth registered to colour?");

  const DepthSurvey survey = survey_depth(depth);
  report("depth empty", survey.share_read > 0.0 || cv::countNonZero(depth.counts) > 0
                            ? std::string()
                            : depth_.topic +
                                  " has no reading at all, so no pose can be found; "
                                  "check that the sensor runs and is within its range");
  report("depth implausible",
         survey.is_implausible()
             ? depth_.topic + " (" + pair.depth->encoding + ") has a median depth of " +
                   metres_text(survey.median) +
                   ": is the unit right? For 16UC1 set ~depth_scale, metres per count, now " +
                   metres_text(options_.depth.of_counts) + "; 32FC1 must be metres"
             : std::string());
  double far = 0.0;
  const double reach = 65535.0 * options_.depth.for_metres;
  if (pair.depth->encoding == "32FC1") {
    const cv::Mat metres(static_cast<int>(pair.depth->height), static_cast<int>(pair.depth->width),
                         CV_32FC1, const_cast<std::uint8_t*>(pair.depth->data.data()),
                         pair.depth->step);
    far = share_beyond(metres, reach);
  }
  report("depth beyond reach", far > kFarShare
                                   ? percent_text(far) + " of the readings on " + depth_.topic +
                                         " are beyond " + metres_text(reach) +
                                         " and are lost: raise ~depth_unit, now " +
                                         metres_text(options_.depth.for_metres)
                                   : std::string());
}

// Says it, or that it is over.
void RgbdSubscriber::report(const std::string& key, const std::string& text) {
  if (text.empty()) {
    health_.clear(key);
  } else {
    health_.warn(key, text);
  }
}

// With the mutex held. Two cameras whose clocks went apart pair frames of different instants.
void RgbdSubscriber::watch_stamp(const ros::Time& stamp) {
  const ros::SteadyTime now = ros::SteadyTime::now();
  const double step = (stamp - last_stamp_).toSec();
  const bool leaps = step < 0.0 || step > (now - last_arrival_).toSec() + kLeap;
  if (!last_stamp_.isZero() && leaps) {
    health_.warn("stamps leap", "stamps on " + rgb_.topic + " went " +
                                    (step < 0.0 ? "back" : "ahead") + " by " +
                                    std::to_string(std::lround(std::abs(step))) +
                                    " s: a recording that starts again, or a clock that was set");
  }
  last_stamp_ = stamp;
  last_arrival_ = now;
}

void RgbdSubscriber::watch(const ros::WallTimerEvent&) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const bool apart = rgb_.seen > 1 && depth_.seen > 1 && pairs_seen_ == 0;
  const bool stamped = rgb_.same < kSameStamps && depth_.same < kSameStamps &&
                       !rgb_.last.isZero() && !depth_.last.isZero();
  report("stamps differ",
         apart && stamped
             ? "no image of " + rgb_.topic + " and " + depth_.topic +
                   " within ~max_stamp_difference; synchronise the camera's streams or raise the "
                   "parameter"
             : std::string());
  rgb_.seen = depth_.seen = pairs_seen_ = 0;
}

}  // namespace rprr
