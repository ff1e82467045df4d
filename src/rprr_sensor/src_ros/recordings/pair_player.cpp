// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/pair_player.hpp"

#include <geometry_msgs/PoseStamped.h>
#include <sensor_msgs/image_encodings.h>
#include <std_msgs/Bool.h>

#include <algorithm>
#include <boost/make_shared.hpp>
#include <chrono>
#include <cmath>
#include <pluginlib/class_list_macros.hpp>

#include "rprr_ros/camera_info.hpp"
#include "rprr_ros/conversions.hpp"
#include "rprr_ros/parameters.hpp"
#include "rprr_sensor_ros/frame_messages.hpp"

namespace rprr {
namespace {

constexpr double kGroundTruthPatience = 1.0;  // [s]
constexpr int kQueue = 4;
constexpr auto kPoll = std::chrono::milliseconds(5);

}  // namespace

PairPlayer::~PairPlayer() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stop_ = true;
  }
  wake_.notify_all();
  worker_.reset();
}

void PairPlayer::onInit() {
  ros::NodeHandle& nh = getNodeHandle();
  ros::NodeHandle& private_nh = getPrivateNodeHandle();
  std::string wrong = read_parameters(private_nh, options_of(settings_));
  if (wrong.empty()) wrong = complete(settings_);
  health_ = std::make_unique<Health>(nh, private_nh, getName(), settings_.a + "+" + settings_.b);
  inputs_ = std::make_unique<InputReport>(nh, *health_);  // of /clock
  if (!wrong.empty()) {
    health_->refuse_parameters(wrong);
    if (settings_.required) ros::requestShutdown();
    return;
  }
  a_ = advertise(settings_.a);
  b_ = advertise(settings_.b);
  done_ = private_nh.advertise<std_msgs::Bool>("done", 1, true);
  next_ = private_nh.advertiseService("next", &PairPlayer::on_next, this);
  if (settings_.handshake) {
    statistics_ = nh.subscribe("/station/statistics", 20, &PairPlayer::on_statistics, this);
    inputs_->expect(statistics_.getTopic(), InputKind::kSometimes, "answers",
                    "start the station, or set ~handshake to false");
  }
  worker_ = std::make_unique<Worker>(1);
  worker_->post([this] { play(); });
}

PairPlayer::Outputs PairPlayer::advertise(const std::string& robot) {
  ros::NodeHandle& nh = getNodeHandle();
  const InputTopics topics = input_topics(robot);
  Outputs outputs;
  outputs.robot = robot;
  outputs.colour = nh.advertise<sensor_msgs::Image>(topics.colour, kQueue);
  outputs.camera_info = nh.advertise<sensor_msgs::CameraInfo>(topics.camera_info, kQueue);
  outputs.depth = nh.advertise<sensor_msgs::Image>(topics.depth, kQueue);
  outputs.pose = nh.advertise<geometry_msgs::PoseStamped>(topics.pose, kQueue);
  return outputs;
}

void PairPlayer::on_statistics(const rprr_msgs::PairStatisticsConstPtr& statistics) {
  if (statistics->robot != settings_.b) return;
  const std::lock_guard<std::mutex> lock(mutex_);
  answered_ = statistics->header.stamp;
  wake_.notify_all();
}

bool PairPlayer::on_next(std_srvs::Trigger::Request& /*request*/,
                         std_srvs::Trigger::Response& response) {
  const std::lock_guard<std::mutex> lock(mutex_);
  response.success = !settings_.handshake && settings_.rate <= 0.0;
  response.message = response.success
                         ? "the next pair will be played"
                         : "the pace is set by ~rate or ~handshake; set ~rate to 0, ~handshake "
                           "to false to play by hand";
  if (response.success) ++requested_;
  wake_.notify_all();
  return true;
}

void PairPlayer::play() {
  auto recording = open_recording(settings_.source, settings_.recording);
  if (!recording) {
    return fail("~source: " + recording.reason());
  }
  if (!(*recording)->remark().empty()) health_->warn("remark", (*recording)->remark());
  PairSchedule schedule((*recording)->size(), settings_.schedule);
  if (schedule.pairs() == 0) {
    return fail(settings_.source + " has " + std::to_string((*recording)->size()) +
                " entries: no pair with ~step and ~start as they are");
  }
  await_subscribers();
  bool all_played = true;
  std::size_t played = 0;
  while (running()) {
    const auto pair = schedule.next();
    if (!pair) return finish(all_played);
    await_turn();
    if (!running()) return;
    all_played = play_pair(**recording, pair->first, pair->second) && all_played;
    health_->show("pairs", std::to_string(++played) + " played, " +
                               std::to_string(schedule.pairs()) + " in a round");
  }
}

// There is nothing to play.
void PairPlayer::fail(const std::string& reason) {
  health_->error("source", reason);
  finish(false);
  if (settings_.required) ros::requestShutdown();
}

bool PairPlayer::play_pair(Recording& recording, std::size_t a, std::size_t b) {
  const auto frame_a = recording.load(a);
  const auto frame_b = recording.load(b);
  if (!frame_a || !frame_b) {
    health_->error("load", "a pair is left out: " + frame_a.reason() + " " + frame_b.reason());
    health_->count("pairs left out");
    // A recording of nothing but faults, looped, must not spin.
    wait_until([] { return false; }, 0.05);
    return false;
  }
  const ros::Time stamp = fresh_stamp();
  publish(a_, *frame_a, recording.camera(), stamp);
  publish(b_, *frame_b, recording.camera(), stamp);
  health_->count("pairs played");
  if (settings_.handshake) await_answer(stamp);
  return true;
}

void PairPlayer::publish(const Outputs& outputs, const RecordedFrame& frame, const Camera& camera,
                         const ros::Time& stamp) {
  std_msgs::Header header;
  header.stamp = stamp;
  header.frame_id = optical_frame(outputs.robot);
  // Shared pointers: subscribers in the same nodelet manager get them without a copy.
  outputs.camera_info.publish(
      boost::make_shared<sensor_msgs::CameraInfo>(info_from_camera(camera, header)));
  outputs.colour.publish(boost::make_shared<sensor_msgs::Image>(
      to_image(header, sensor_msgs::image_encodings::BGR8, frame.image.bgr)));
  outputs.depth.publish(
      boost::make_shared<sensor_msgs::Image>(to_depth_image(header, frame.image.depth)));
  if (frame.world_from_camera) {
    outputs.pose.publish(pose_message(stamp, *frame.world_from_camera));
  }
}

void PairPlayer::await_subscribers() {
  const auto enough = [this] {
    for (const Outputs* outputs : {&a_, &b_}) {
      for (const ros::Publisher* publisher :
           {&outputs->colour, &outputs->camera_info, &outputs->depth}) {
        if (static_cast<int>(publisher->getNumSubscribers()) >= settings_.wait_for_subscribers) {
          continue;
        }
        health_->show("waiting for", std::to_string(settings_.wait_for_subscribers) +
                                         " subscribers on " + publisher->getTopic());
        return false;
      }
    }
    health_->show("waiting for", "nothing");
    return true;
  };
  if (!wait_until(enough, settings_.wait_timeout) && running()) {
    health_->warn("subscribers", "less than ~wait_for_subscribers = " +
                                     std::to_string(settings_.wait_for_subscribers) +
                                     " subscribers on the robots' camera topics after "
                                     "~wait_timeout; playing nevertheless");
  }
  // Nobody need listen to the ground truth, but who does connects about now and wants the first
  // too.
  if (settings_.wait_for_subscribers > 0) {
    wait_until(
        [this] { return a_.pose.getNumSubscribers() > 0 && b_.pose.getNumSubscribers() > 0; },
        kGroundTruthPatience);
  }
}

void PairPlayer::await_turn() {
  if (settings_.rate <= 0.0) {
    if (settings_.handshake) return;
    NODELET_INFO_ONCE("~rate is 0: playing a pair for each call of %s", next_.getService().c_str());
    wait_until([this] { return requested_ > 0; }, -1.0);
    const std::lock_guard<std::mutex> lock(mutex_);
    requested_ = std::max(requested_ - 1, 0);
    return;
  }
  if (last_stamp_.isZero()) return;
  // Counted from when the last pair was due, not from when it came: so the mean rate is right.
  // What is late by more than a pair is not caught up.
  const ros::Duration period(1.0 / settings_.rate);
  const ros::Duration late = last_stamp_ - due_;
  if (due_.isZero() || late > period || late < ros::Duration(0)) due_ = last_stamp_;
  due_ += period;
  wait_until(
      [&] {
        // Simulated time may jump back, when a bag begins again.
        const ros::Time now = ros::Time::now();
        return now >= due_ || now < last_stamp_ - ros::Duration(1.0);
      },
      -1.0);
}

void PairPlayer::await_answer(const ros::Time& stamp) {
  if (wait_until([&] { return answered_ == stamp; }, settings_.handshake_timeout) || !running()) {
    return;
  }
  health_->count("answers missed");
  health_->warn("handshake", "no " + statistics_.getTopic() + " of " + settings_.b +
                                 " within ~handshake_timeout; going on with the next pair");
}

ros::Time PairPlayer::fresh_stamp() {
  wait_until([] { return !ros::Time::now().isZero(); }, -1.0);
  // Frames are named by their stamps: no two may have the same.
  const ros::Time now = ros::Time::now();
  const bool repeated = now <= last_stamp_ && now > last_stamp_ - ros::Duration(1.0);
  last_stamp_ = repeated ? last_stamp_ + ros::Duration(0, 1000000) : now;
  return last_stamp_;
}

void PairPlayer::finish(bool all_played) {
  std_msgs::Bool done;
  done.data = static_cast<unsigned char>(all_played);
  done_.publish(done);
  NODELET_INFO("played to the end%s", all_played ? "" : ", not without faults");
}

bool PairPlayer::running() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return !stop_ && ros::ok();
}

bool PairPlayer::wait_until(const std::function<bool()>& ready, double timeout) {
  const auto start = std::chrono::steady_clock::now();
  std::unique_lock<std::mutex> lock(mutex_);
  while (!ready()) {
    const std::chrono::duration<double> waited = std::chrono::steady_clock::now() - start;
    if (stop_ || !ros::ok() || (timeout >= 0.0 && waited.count() > timeout)) return false;
    wake_.wait_for(lock, kPoll);
  }
  return true;
}

}  // namespace rprr

PLUGINLIB_EXPORT_CLASS(rprr::PairPlayer, nodelet::Nodelet)
