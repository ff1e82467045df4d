// SPDX-License-Identifier: BSD-3-Clause
#include <nodelet/nodelet.h>
#include <rprr_msgs/EncodedFrame.h>
#include <rprr_msgs/PairStatistics.h>
#include <rprr_msgs/Receipt.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/PointCloud2.h>
#include <sensor_msgs/image_encodings.h>
#include <visualization_msgs/MarkerArray.h>

#include <algorithm>
#include <boost/make_shared.hpp>
#include <cmath>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <pluginlib/class_list_macros.hpp>
#include <string>
#include <vector>

#include "rprr_radio_ros/radio_links.hpp"
#include "rprr_ros/camera_info.hpp"
#include "rprr_ros/conversions.hpp"
#include "rprr_ros/health.hpp"
#include "rprr_ros/input_report.hpp"
#include "rprr_ros/sender_watch.hpp"
#include "rprr_ros/steady_now.hpp"
#include "rprr_ros/worker.hpp"
#include "rprr_station/scene_cloud.hpp"
#include "rprr_station/station.hpp"
#include "rprr_wire/bytes.hpp"
#include "station_messages.hpp"
#include "station_parameters.hpp"

namespace rprr {
namespace {

constexpr std::size_t kLongestChunk = 16384;  // [bytes] a longer message is a frame in one piece
constexpr std::size_t kChunksOfAFrame = 32;   // that may wait, of each frame that may
constexpr unsigned kTicksOfReceipts = 5;      // between receipts that nothing else causes
constexpr double kClocksApart = 20.0;         // milliseconds; the pairing of frames suffers

// Makes a message only where somebody listens; as a shared pointer nodelets get it without a copy.
template <typename Make>
void offer(const ros::Publisher& publisher, const Make& make) {
  using Message = decltype(make());
  if (publisher.getNumSubscribers() > 0) publisher.publish(boost::make_shared<Message>(make()));
}

}  // namespace

/// The remote monitoring station over topics: encoded frames of all robots in, views, statistics
/// and receipts out.
class StationNodelet : public nodelet::Nodelet {
 private:
  struct Robot {
    std::size_t number = 0;  // in ~robots
    std::string topic;
    ros::Subscriber encoded;
    ros::Publisher rgb;
    ros::Publisher info;
    ros::Publisher depth;
    ros::Publisher points;
    ros::Publisher provenance;
    std::deque<rprr_msgs::EncodedFrameConstPtr> queue;  // guarded by mutex_
  };

  void onInit() override {
    ros::NodeHandle& nh = getNodeHandle();
    health_ = std::make_unique<Health>(nh, getPrivateNodeHandle(), "station", "station");
    const std::string wrong = read_station_parameters(getPrivateNodeHandle(), parameters_);
    if (!wrong.empty()) return health_->refuse_parameters(wrong);
    inputs_ = std::make_unique<InputReport>(nh, *health_);
    const std::vector<std::string>& names = parameters_.station.robots;
    statistics_ = nh.advertise<rprr_msgs::PairStatistics>("/station/statistics", 20);
    points_ = nh.advertise<sensor_msgs::PointCloud2>("/station/points", 2);
    receipts_ = nh.advertise<rprr_msgs::Receipt>("/station/receipts", 20);
    frusta_ = nh.advertise<visualization_msgs::MarkerArray>("/station/frusta", 20);
    cloud_ = std::make_unique<SceneCloud>(cloud_options(parameters_));
    station_ = std::make_unique<Station>(parameters_.station, make_isolated_colour_decoder());
    // One job for every message that waits, one for the tick: no job is ever dropped.
    worker_ =
        std::make_unique<Worker>(names.size() * parameters_.output.queue * kChunksOfAFrame + 1);
    for (const std::string& name : names) advertise(nh, name);
    for (const std::string& name : names) {
      using Event = ros::MessageEvent<rprr_msgs::EncodedFrame const>;
      ros::SubscribeOptions options;
      options.initByFullCallbackType<const Event&>(
          "/" + name + "/rprr/encoded", 32,
          [this, name](const Event& event) { on_encoded(name, event); });
      options.transport_hints = ros::TransportHints().tcpNoDelay();
      robots_[name].encoded = nh.subscribe(options);
      inputs_->expect(robots_[name].topic, InputKind::kStream, "frame of '" + name + "'",
                      "look at its nodes, its camera and its radio");
      if (parameters_.link_recovery) {
        links_ = RadioLinks::look_after({robots_[name].encoded.getTopic()});
      }
    }
    timer_ = nh.createWallTimer(ros::WallDuration(0.2), &StationNodelet::on_timer, this);
  }

  void advertise(ros::NodeHandle& nh, const std::string& name) {
    const std::string prefix = "/station/" + name + "/";
    Robot& robot = robots_[name];
    robot.number = robots_.size() - 1;
    robot.topic = nh.resolveName("/" + name + "/rprr/encoded");
    robot.rgb = nh.advertise<sensor_msgs::Image>(prefix + "rgb/image_rect_color", 4);
    robot.info = nh.advertise<sensor_msgs::CameraInfo>(prefix + "rgb/camera_info", 4);
    robot.depth = nh.advertise<sensor_msgs::Image>(prefix + "depth_registered/image_rect", 4);
    robot.points = nh.advertise<sensor_msgs::PointCloud2>(prefix + "points", 2);
    robot.provenance = nh.advertise<sensor_msgs::Image>(prefix + "provenance", 4);
  }

  void on_encoded(const std::string& name,
                  const ros::MessageEvent<rprr_msgs::EncodedFrame const>& event) {
    const std::string stranger = senders_.note(name, event.getPublisherName(), steady_now());
    if (!stranger.empty())
      health_->warn("two senders " + name, "/" + name + "/rprr/encoded: " + stranger);
    enqueue(name, event.getConstMessage());
  }

  // Every robot has a queue of its own: who floods the station loses his own frames only.
  void enqueue(const std::string& name, const rprr_msgs::EncodedFrameConstPtr& message) {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      auto& queue = robots_[name].queue;
      queue.push_back(message);
      if (is_too_long(queue)) {
        queue.pop_front();
        health_->warn("too slow " + name, "/" + name +
                                              "/rprr/encoded comes faster than it is decoded; the "
                                              "oldest frames are dropped: lower its rate");
        return;
      }
    }
    worker_->post([this, name] { decode_next(name); });
  }

  // A frame that comes in chunks takes many messages, none of them long.
  bool is_too_long(const std::deque<rprr_msgs::EncodedFrameConstPtr>& queue) const {
    const auto is_long = [](const rprr_msgs::EncodedFrameConstPtr& message) {
      return message->data.size() > kLongestChunk;
    };
    const auto frames = std::count_if(queue.begin(), queue.end(), is_long);
    return queue.size() > parameters_.output.queue * kChunksOfAFrame ||
           static_cast<std::size_t>(frames) > parameters_.output.queue;
  }

  void on_timer(const ros::WallTimerEvent&) {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      if (tick_posted_) return;
      tick_posted_ = true;
    }
    worker_->post([this] {
      {
        const std::lock_guard<std::mutex> lock(mutex_);
        tick_posted_ = false;
      }
      publish(station_->tick(steady_now()));
      if (++ticks_ % kTicksOfReceipts == 0) {
        for (const auto& [name, robot] : robots_) publish_receipt(name, {});
        if (links_) show(links_->state(), *health_);
      }
    });
  }

  // From here on: the worker's thread.
  void decode_next(const std::string& name) {
    rprr_msgs::EncodedFrameConstPtr message;
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      auto& queue = robots_[name].queue;
      if (queue.empty()) return;
      message = queue.front();
      queue.pop_front();
    }
    ReceivedMessage received;
    received.robot = name;
    received.stamp = to_stamp(message->header.stamp);
    received.frame_id = message->header.frame_id;
    received.exchange = message->exchange;
    received.data = ByteView(message->data);
    const Stamp last = station_->last(name);
    const StationOutput output = station_->receive(received, steady_now());
    if (station_->last(name) != last) {
      inputs_->heard(robots_[name].topic);
      publish_receipt(name, {});
    }
    publish(output);
  }

  void publish(const StationOutput& output) {
    for (const RebuiltFrame& frame : output.frames) publish(frame);
    for (const StationError& error : output.errors) {
      health_->error("frame of " + error.robot,
                     "/" + error.robot + "/rprr/encoded: " + error.reason + "; it is dropped");
    }
    std::map<std::string, std::vector<Stamp>> repeats;
    for (const RepeatRequest& repeat : output.repeats) {
      repeats[repeat.robot].push_back(repeat.stamp);
    }
    for (const auto& [robot, stamps] : repeats) publish_receipt(robot, stamps);
  }

  void publish(const RebuiltFrame& frame) {
    namespace encodings = sensor_msgs::image_encodings;
    const Robot& robot = robots_.at(frame.robot);
    const std_msgs::Header header = header_of(frame);
    robot.info.publish(info_from_camera(frame.camera, header));
    offer(robot.rgb, [&] { return to_image(header, encodings::BGR8, frame.bgr); });
    offer(robot.depth,
          [&] { return depth_message(frame, header, parameters_.output.depth_encoding); });
    offer(robot.points, [&] { return cloud_message(frame, header); });
    offer(robot.provenance, [&] { return to_image(header, encodings::MONO8, frame.provenance); });
    offer(frusta_, [&] {
      visualization_msgs::MarkerArray frusta;
      frusta.markers.push_back(
          frustum_message(frame, header, robot.number, parameters_.output.frustum_length));
      return frusta;
    });
    publish_scene(frame);
    publish_statistics(frame, header);
    health_->count(frame.robot + (frame.sparse ? ": sparse frames" : ": whole frames"));
  }

  void publish_statistics(const RebuiltFrame& frame, const std_msgs::Header& header) {
    rprr_msgs::PairStatistics statistics = statistics_message(frame, header);
    statistics.latency_ms = latency_of(frame.robot, header.stamp);
    statistics_.publish(statistics);
  }

  // Milliseconds. A clock that is behind cannot be told from a slow radio here, one that is ahead
  // can.
  float latency_of(const std::string& robot, const ros::Time& stamp) {
    const ros::Time now = ros::Time::now();
    const double ms = (now - stamp).toSec() * 1e3;
    if (ms < -kClocksApart && !now.isZero()) {  // zero: simulated time has not begun
      health_->warn("clock of " + robot,
                    "frames of '" + robot + "' come " + std::to_string(std::lround(-ms)) +
                        " ms before their stamps: its clock is ahead of the station's by more than "
                        "that, and latency_ms is off by as much; keep both together with chrony");
    }
    return static_cast<float>(ms);
  }

  // Frames are kept only while somebody listens: the first scene is that of the next reference.
  void publish_scene(const RebuiltFrame& frame) {
    if (points_.getNumSubscribers() == 0) {
      cloud_->clear();
      return;
    }
    if (!cloud_->add(frame) || steady_now() < next_scene_) return;
    next_scene_ = steady_now() + parameters_.output.cloud_period;
    cloud_->make(scene_);
    points_.publish(boost::make_shared<sensor_msgs::PointCloud2>(scene_message(scene_)));
  }

  void publish_receipt(const std::string& robot, const std::vector<Stamp>& repeats) {
    rprr_msgs::Receipt receipt;
    receipt.header.stamp = ros::Time::now();
    receipt.robot = robot;
    receipt.last = to_time(station_->last(robot));
    for (const Stamp stamp : station_->held(robot)) receipt.held.push_back(to_time(stamp));
    for (const Stamp stamp : repeats) receipt.repeat.push_back(to_time(stamp));
    receipts_.publish(receipt);
  }

  // In the order in which they need each other: what is below is destroyed first.
  StationParameters parameters_;
  std::unique_ptr<Health> health_;
  std::unique_ptr<InputReport> inputs_;
  ros::Publisher statistics_;
  ros::Publisher receipts_;
  ros::Publisher points_;
  ros::Publisher frusta_;
  std::shared_ptr<RadioLinks> links_;  // null: links are not recovered
  SenderWatch senders_;
  std::mutex mutex_;  // of the robots' queues and the next
  bool tick_posted_ = false;
  std::unique_ptr<Station> station_;  // the worker's, as are the next four
  unsigned ticks_ = 0;
  std::unique_ptr<SceneCloud> cloud_;
  Scene scene_;
  SteadyTime next_scene_;
  std::map<std::string, Robot> robots_;
  std::unique_ptr<Worker> worker_;
  ros::WallTimer timer_;

 public:
  ~StationNodelet() override {
    // Subscribers live beside the queues that the worker reads: silence them first.
    timer_.stop();
    for (auto& [name, robot] : robots_) robot.encoded.shutdown();
  }
};

}  // namespace rprr

PLUGINLIB_EXPORT_CLASS(rprr::StationNodelet, nodelet::Nodelet)
