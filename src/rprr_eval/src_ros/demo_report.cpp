// SPDX-License-Identifier: BSD-3-Clause
// Watches the topics of a pair until enough exchanges are through, then writes table, picture and
// summary and ends.
#include <geometry_msgs/PoseStamped.h>
#include <ros/ros.h>
#include <rprr_msgs/ExchangeEvent.h>
#include <rprr_msgs/PairStatistics.h>
#include <rprr_msgs/RelativePose.h>
#include <sensor_msgs/Image.h>
#include <std_msgs/Bool.h>

#include <deque>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>

#include "rprr_eval/exchange/exchange_log.hpp"
#include "rprr_eval/measure/metrics.hpp"
#include "rprr_eval/report/contact_sheet.hpp"
#include "rprr_ros/conversions.hpp"
#include "rprr_ros/parameters.hpp"

namespace rprr {
namespace {

constexpr std::size_t kKept = 30;     // images and poses of a topic
const ros::WallDuration kGrace(4.0);  // for what is under way when the source ends

// The last messages of a topic, by stamp.
template <typename Message>
class Recent {
 public:
  void add(const boost::shared_ptr<Message const>& message) {
    messages_.push_back(message);
    if (messages_.size() > kKept) messages_.pop_front();
  }
  boost::shared_ptr<Message const> at(const ros::Time& stamp) const {
    for (auto message = messages_.rbegin(); message != messages_.rend(); ++message) {
      if ((*message)->header.stamp == stamp) return *message;
    }
    return nullptr;
  }

 private:
  std::deque<boost::shared_ptr<Message const>> messages_;
};

cv::Mat pixels_of(const sensor_msgs::ImageConstPtr& image) {
  if (!image) return {};
  const Result<cv::Mat> bgr = bgr_from_image(*image);
  return bgr ? bgr->clone() : cv::Mat();
}

Pose pose_of(const geometry_msgs::PoseStamped& message) {
  const auto& p = message.pose.position;
  const auto& q = message.pose.orientation;
  return make_pose({p.x, p.y, p.z}, {q.x, q.y, q.z, q.w});
}

struct ReportOptions {
  std::string a = "eyebug_a";
  std::string b = "eyebug_b";
  std::string output = ".";
  double timeout = 120.0;  // [s]
  std::size_t exchanges = 15;
};

void list_options(ReportOptions& o, OptionTable& table) {
  table.robot("a", o.a, "The robot whose frames go out whole").as_wiring();
  table.robot("b", o.b, "The robot that sends only what the other does not see").as_wiring();
  table.text("output", o.output, "Folder of what is written").as_wiring();
  table.number("timeout", o.timeout, {1.0, 86400.0}, "s", "It ends after this in any case")
      .as_wiring();
  table.whole("exchanges", o.exchanges, {1, 100000}, "", "It ends after so many").as_wiring();
}

class DemoReport {
 public:
  explicit DemoReport(const ReportOptions& options)
      : a_(options.a),
        b_(options.b),
        output_(options.output),
        timeout_(options.timeout),
        log_(options.exchanges) {
    listen<sensor_msgs::Image>("/" + a_ + "/camera/rgb/image_rect_color",
                               [this](const auto& m) { rgb_a_.add(m); });
    listen<sensor_msgs::Image>("/" + b_ + "/camera/rgb/image_rect_color",
                               [this](const auto& m) { rgb_b_.add(m); });
    listen<sensor_msgs::Image>("/" + b_ + "/rprr/sparse/rgb",
                               [this](const auto& m) { sparse_.add(m); });
    listen<sensor_msgs::Image>("/station/" + b_ + "/rgb/image_rect_color", [this](const auto& m) {
      rebuilt_.add(m);
      settle();
    });
    listen<rprr_msgs::PairStatistics>("/station/statistics", [this](const auto& m) {
      if (m->robot == b_ && m->exchange != 0) waiting_[m->exchange] = m;
      settle();
    });
    listen<geometry_msgs::PoseStamped>("/" + a_ + "/ground_truth/pose",
                                       [this](const auto& m) { truth_a_.add(m); });
    listen<geometry_msgs::PoseStamped>("/" + b_ + "/ground_truth/pose",
                                       [this](const auto& m) { truth_b_.add(m); });
    listen<rprr_msgs::ExchangeEvent>("/" + a_ + "/rprr/exchange",
                                     [this](const auto& m) { on_reference_event(*m); });
    listen<rprr_msgs::ExchangeEvent>("/" + b_ + "/rprr/exchange",
                                     [this](const auto& m) { on_dependent_event(*m); });
    listen<rprr_msgs::RelativePose>("/" + a_ + "/rprr/relative_pose",
                                    [this](const auto& m) { on_pose(*m); });
    listen<std_msgs::Bool>("/rprr/source_done", [this](const auto& m) {
      if (m->data && source_done_.isZero()) source_done_ = ros::WallTime::now();
    });
  }

  // Until enough exchanges are through, the source has ended, or time is up.
  void watch() {
    const ros::WallTime start = ros::WallTime::now();
    ros::WallRate rate(50);
    while (ros::ok() && !log_.finished()) {
      ros::spinOnce();
      const ros::WallTime now = ros::WallTime::now();
      if ((now - start).toSec() > timeout_) {
        std::cout << "time is up after " << timeout_ << " s\n";
        break;
      }
      if (!source_done_.isZero() && now - source_done_ > kGrace) break;
      rate.sleep();
    }
  }

  bool write() const {
    const nlohmann::json summary = log_.summary();
    std::cout << "\n" << log_.table() << std::flush;
    std::error_code error;
    std::filesystem::create_directories(output_, error);
    std::ofstream(output_ + "/summary.json") << summary.dump(2) << "\n";
    const cv::Mat sheet = contact_sheet({{"a: what the reference sees", picture_.a},
                                         {"b: what the dependent sees", picture_.b},
                                         {"the blocks that b sent", picture_.sparse},
                                         {"b's view, rebuilt at the station", picture_.rebuilt}},
                                        640);
    const bool written = cv::imwrite(output_ + "/picture.png", sheet);
    std::cout << "written: " << output_ << "/summary.json, " << output_ << "/picture.png\n";
    return written && summary["exchanges"]["completed"] > 0 && summary["exchanges"]["lost"] == 0;
  }

 private:
  struct Picture {
    cv::Mat a, b, sparse, rebuilt;
  };

  template <typename Message, typename Callback>
  void listen(const std::string& topic, Callback callback) {
    const boost::function<void(const boost::shared_ptr<Message const>&)> function = callback;
    subscribers_.push_back(nh_.subscribe<Message>(topic, 50, function));
  }

  // Topics overtake each other: whichever first speaks of an exchange starts it here.
  void begin(std::uint32_t exchange) {
    if (exchange == 0) return;
    const std::size_t before = log_.started();
    log_.start(exchange);
    if (log_.started() != before) std::cout << "exchange " << log_.started() << "\n" << std::flush;
  }

  void on_reference_event(const rprr_msgs::ExchangeEvent& event) {
    if (event.exchange == 0 || event.peer != b_) return;
    begin(event.exchange);
    if (event.action == rprr_msgs::ExchangeEvent::SEND_REFERENCE) {
      stamp_a_[event.exchange] = event.frame.header.stamp;
    }
    if (LoggedExchange* record = log_.find(event.exchange)) {
      record->ms_pose_reference = event.ms_pose;
    }
  }

  void on_dependent_event(const rprr_msgs::ExchangeEvent& event) {
    begin(event.exchange);
    if (LoggedExchange* record = log_.find(event.exchange)) {
      record->ms_pose_dependent = event.ms_pose;
    }
  }

  void on_pose(const rprr_msgs::RelativePose& pose) {
    if (pose.dependent == b_) begin(pose.exchange);
    LoggedExchange* record = log_.find(pose.exchange);
    if (!record || pose.status != rprr_msgs::RelativePose::ACCEPTED) return;
    record->accepted = true;
    const auto world_a = truth_a_.at(pose.header.stamp);
    const auto world_b = truth_b_.at(pose.dependent_stamp);
    if (!world_a || !world_b) return;
    record->pose_error = pose_error(pose_from_fields(pose.translation, pose.rotation),
                                    pose_of(*world_b).inverse() * pose_of(*world_a));
  }

  // Statistics and pictures come on topics of their own, in any order.
  void settle() {
    for (auto entry = waiting_.begin(); entry != waiting_.end();) {
      const rprr_msgs::PairStatistics& statistics = *entry->second;
      const auto rebuilt = rebuilt_.at(statistics.header.stamp);
      LoggedExchange* record = log_.find(statistics.exchange);
      if (record && !rebuilt) {
        ++entry;
        continue;
      }
      if (record) fill(statistics, rebuilt, *record);
      entry = waiting_.erase(entry);
    }
  }

  void fill(const rprr_msgs::PairStatistics& s, const sensor_msgs::ImageConstPtr& rebuilt,
            LoggedExchange& record) {
    record.rebuilt = true;
    record.blocks_total = s.blocks_total;
    record.blocks_sent = s.blocks_sent;
    record.blocks_sent_without_depth = s.blocks_sent_without_depth;
    record.bytes_pose = s.bytes_pose;
    record.bytes_masks = s.bytes_masks;
    record.bytes_depth = s.bytes_depth;
    record.bytes_colour = s.bytes_colour;
    record.bytes_extras = s.bytes_extras;
    record.bytes_total = s.bytes_total;
    record.independent_bytes = s.independent_bytes_total;
    record.ms_validate = s.ms_validate;
    record.ms_encode = s.ms_encode;
    record.ms_decode = s.ms_decode;
    record.ms_reconstruct = s.ms_reconstruct;
    const cv::Mat view = pixels_of(rebuilt);
    const cv::Mat truth = pixels_of(rgb_b_.at(s.header.stamp));
    if (!view.empty() && view.size() == truth.size()) record.psnr = psnr(view, truth);
    if (!s.reference.empty()) {
      picture_ = {pixels_of(rgb_a_.at(s.reference_stamp)), truth,
                  pixels_of(sparse_.at(s.header.stamp)), view};
    } else if (picture_.b.empty()) {
      picture_ = {pixels_of(rgb_a_.at(stamp_a_[s.exchange])), truth, truth, view};
    }
  }

  ros::NodeHandle nh_;
  std::string a_, b_, output_;
  double timeout_;
  ExchangeLog log_;
  std::vector<ros::Subscriber> subscribers_;
  Recent<sensor_msgs::Image> rgb_a_, rgb_b_, sparse_, rebuilt_;
  Recent<geometry_msgs::PoseStamped> truth_a_, truth_b_;
  std::map<std::uint32_t, rprr_msgs::PairStatisticsConstPtr> waiting_;
  std::map<std::uint32_t, ros::Time> stamp_a_;
  Picture picture_;
  ros::WallTime source_done_;
};

}  // namespace
}  // namespace rprr

int main(int argc, char** argv) {
  ros::init(argc, argv, "demo_report");
  rprr::ReportOptions options;
  const std::string wrong = rprr::read_parameters(ros::NodeHandle("~"), rprr::options_of(options));
  if (!wrong.empty()) {
    ROS_FATAL_STREAM("wrong parameters: " << wrong);
    return 1;
  }
  rprr::DemoReport report(options);
  report.watch();
  return report.write() ? 0 : 1;
}
