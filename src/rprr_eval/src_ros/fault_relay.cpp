// SPDX-License-Identifier: BSD-3-Clause
// A bad radio for tests: passes topics on under a prefix, and does to their messages what
// FaultChannel can do, as set by dynamic_reconfigure. Its parameters: list_options() below.
//
// Topic /x comes out as /relayed/x; whoever is to hear it through the relay remaps /x to that. Bits
// are flipped in the data of RPRR's radio messages only: a wrong length of an array would cost the
// receiver gigabytes inside of roscpp, which is not what is tested.
#include <ros/ros.h>
#include <rprr_msgs/BlockMask.h>
#include <rprr_msgs/BlockPreview.h>
#include <rprr_msgs/EncodedFrame.h>
#include <rprr_msgs/PoseUpdate.h>
#include <rprr_msgs/RelativePose.h>
#include <rprr_msgs/SamplePoints.h>
#include <std_msgs/String.h>
#include <topic_tools/shape_shifter.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "rprr_eval/exchange/fault_channel.hpp"
#include "rprr_ros/live_options.hpp"
#include "rprr_ros/parameters.hpp"
#include "rprr_ros/steady_now.hpp"
#include "rprr_wire/bytes.hpp"

namespace rprr {
namespace {

struct RelayOptions {
  std::vector<std::string> topics;
  std::string prefix = "/relayed";
  int seed = 1;
  std::string only;
  Faults faults;
};

void list_options(RelayOptions& o, OptionTable& table) {
  constexpr OptionRange kShare{0.0, 1.0};
  constexpr OptionRange kLongest{0.0, 60.0};
  Faults& f = o.faults;
  table.texts("topics", o.topics, "Topics that pass, by their full names").as_wiring();
  table.text("prefix", o.prefix, "Topic /x comes out as PREFIX/x").as_wiring();
  table.whole("seed", o.seed, {0, 1e6}, "", "The same seed makes the same faults").as_wiring();
  table.text("only", o.only, "Faults are of topics that contain this text; empty: of all")
      .as_live();
  table.flag("down", f.down, "Nothing passes").as_live();
  table.number("lose", f.lose, kShare, "", "Share of messages that are lost").as_live();
  table.number("duplicate", f.duplicate, kShare, "", "Share that come twice").as_live();
  table.number("reorder", f.reorder, kShare, "", "Share that come `late` later").as_live();
  table.number("corrupt", f.corrupt, kShare, "", "Share in which bits of the data are flipped")
      .as_live();
  table.seconds("delay", f.delay, kLongest, "Of every message").as_live();
  table.seconds("late", f.late, kLongest, "Of duplicates and of what is reordered").as_live();
}

// The bytes of data, which come last in these messages.
template <typename Message>
bool find_data(const topic_tools::ShapeShifter& shape, ChannelMessage& message) {
  if (shape.getDataType() != ros::message_traits::datatype<Message>()) return false;
  message.flip_count = shape.instantiate<Message>()->data.size();
  message.flip_from = message.bytes.size() - message.flip_count;
  return true;
}

// A pose has plain fields from the status on, up to the length of the camera. Behind the camera
// come bytes_spent and the checksum.
bool find_pose(const topic_tools::ShapeShifter& shape, ChannelMessage& message) {
  using Pose = rprr_msgs::RelativePose;
  if (shape.getDataType() != ros::message_traits::datatype<Pose>()) return false;
  const auto pose = shape.instantiate<Pose>();
  message.flip_from = ros::serialization::serializationLength(pose->header) + sizeof(double) + 4 +
                      pose->dependent.size() + sizeof(pose->exchange);
  const std::size_t camera = 4 + pose->reference_camera.size();
  message.flip_count = shape.size() - message.flip_from - camera - sizeof(pose->bytes_spent) -
                       sizeof(pose->checksum);
  return true;
}

ChannelMessage to_channel_message(const topic_tools::ShapeShifter& shape) {
  ChannelMessage message;
  message.bytes.resize(shape.size());
  ros::serialization::OStream stream(message.bytes.data(), shape.size());
  shape.write(stream);
  find_data<rprr_msgs::EncodedFrame>(shape, message) ||
      find_data<rprr_msgs::BlockPreview>(shape, message) ||
      find_data<rprr_msgs::BlockMask>(shape, message) ||
      find_data<rprr_msgs::SamplePoints>(shape, message) ||
      find_data<rprr_msgs::PoseUpdate>(shape, message) || find_pose(shape, message);
  return message;
}

class FaultRelay {
 public:
  // Empty, or what is wrong with the parameters: then it does nothing.
  std::string start() {
    std::string wrong = read_parameters(private_nh_, options_of(options_));
    if (!wrong.empty()) return wrong;
    for (const std::string& topic : options_.topics) {
      const auto number = static_cast<std::uint32_t>(links_.size());
      links_.push_back(std::make_unique<Link>(static_cast<std::uint32_t>(options_.seed) + number));
      Link& link = *links_.back();
      link.topic = topic;
      link.out = options_.prefix + topic;
      link.subscriber = nh_.subscribe<topic_tools::ShapeShifter>(
          topic, 100,
          [this, &link](const topic_tools::ShapeShifter::ConstPtr& shape) { pass(link, *shape); },
          ros::VoidConstPtr(), ros::TransportHints().tcpNoDelay());
    }
    set_faults();
    live_ = std::make_unique<LiveOptions>(
        private_nh_, options_of(options_),
        [](const std::string& reason) { ROS_ERROR_STREAM("refused: " << reason); },
        [this] {
          set_faults();
          return std::string();
        });
    timer_ = nh_.createWallTimer(ros::WallDuration(0.005),
                                 [this](const ros::WallTimerEvent&) { send_due(); });
    report_ = nh_.createWallTimer(ros::WallDuration(1.0),
                                  [this](const ros::WallTimerEvent&) { report(); });
    return {};
  }

 private:
  struct Link {
    explicit Link(std::uint32_t seed) : channel(seed) {}
    std::string topic, out;
    FaultChannel channel;
    ros::Subscriber subscriber;
    ros::Publisher publisher;
    topic_tools::ShapeShifter shape;  // of the messages that pass
  };

  void set_faults() {
    for (const auto& link : links_) {
      const bool meant = link->topic.find(options_.only) != std::string::npos;
      link->channel.set(meant ? options_.faults : Faults());
    }
  }

  void pass(Link& link, const topic_tools::ShapeShifter& shape) {
    if (!link.publisher) {
      // What it carries is known only now; those who listen need a moment to connect.
      link.publisher = shape.advertise(nh_, link.out, 100);
      link.shape.morph(shape.getMD5Sum(), shape.getDataType(), shape.getMessageDefinition(), "");
    }
    link.channel.add(to_channel_message(shape), steady_now());
    send_due(link);
  }

  void send_due() {
    for (const auto& link : links_) send_due(*link);
  }
  static void send_due(Link& link) {
    for (Bytes& bytes : link.channel.due(steady_now())) {
      ros::serialization::IStream stream(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
      link.shape.read(stream);
      link.publisher.publish(link.shape);
    }
  }

  void report() {
    std_msgs::String text;
    for (const auto& link : links_) {
      const FaultChannel::Counts& counts = link->channel.counts();
      text.data += link->topic + " came " + std::to_string(counts.came) + " lost " +
                   std::to_string(counts.lost) + " duplicated " +
                   std::to_string(counts.duplicated) + " reordered " +
                   std::to_string(counts.reordered) + " corrupted " +
                   std::to_string(counts.corrupted) + "\n";
    }
    counts_.publish(text);
  }

  ros::NodeHandle nh_;
  ros::NodeHandle private_nh_{"~"};
  ros::Publisher counts_ = private_nh_.advertise<std_msgs::String>("counts", 1, true);
  std::vector<std::unique_ptr<Link>> links_;
  RelayOptions options_;
  std::unique_ptr<LiveOptions> live_;
  ros::WallTimer timer_, report_;
};

}  // namespace
}  // namespace rprr

int main(int argc, char** argv) {
  ros::init(argc, argv, "fault_relay");
  rprr::FaultRelay relay;
  const std::string wrong = relay.start();
  if (!wrong.empty()) {
    ROS_FATAL_STREAM("wrong parameters: " << wrong);
    return 1;
  }
  ros::spin();
  return 0;
}
