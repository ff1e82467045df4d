// SPDX-License-Identifier: BSD-3-Clause
// Images through ROS's own `republish`, raw to dhcm or pgf and back to raw (transports.test).
#include <dynamic_reconfigure/Reconfigure.h>
#include <gtest/gtest.h>
#include <image_transport/image_transport.h>
#include <ros/ros.h>
#include <sensor_msgs/CompressedImage.h>
#include <sensor_msgs/image_encodings.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <functional>
#include <opencv2/core.hpp>
#include <random>

#include "rprr_ros/conversions.hpp"
#include "rprr_synthetic/coded_images.hpp"
#include "rprr_wire/bytes.hpp"

namespace rprr {
namespace {

namespace encodings = sensor_msgs::image_encodings;

constexpr int kWidth = 164;
constexpr int kHeight = 122;
constexpr double kPatience = 20.0;  // [s] for processes that start and stop

cv::Mat depth_counts() {
  return synthetic::kinect_like(kWidth, kHeight).counts;
}

cv::Mat depth_metres() {
  cv::Mat metres = to_float_image(synthetic::kinect_like(kWidth, kHeight));
  metres.at<float>(0, 0) = 1.0f / 3.0f;
  return metres;
}

double psnr(const cv::Mat& a, const cv::Mat& b) {
  const double mean = cv::norm(a, b, cv::NORM_L2SQR) / (3.0 * static_cast<double>(a.total()));
  return mean == 0.0 ? 99.0 : 10.0 * std::log10(255.0 * 255.0 / mean);
}

bool wait_until(const std::function<bool()>& done) {
  const ros::WallTime deadline = ros::WallTime::now() + ros::WallDuration(kPatience);
  while (!done() && ros::WallTime::now() < deadline) {
    ros::WallDuration(0.01).sleep();
    ros::spinOnce();
  }
  return done();
}

// A raw topic that two `republish` stand behind.
class Trip {
 public:
  Trip(const std::string& in, const std::string& out, const std::string& hint = "raw")
      : publisher_(transport_.advertise("/in/" + in, 5)),
        subscriber_(transport_.subscribe(
            out, 5, [this](const sensor_msgs::ImageConstPtr& image) { last_ = image; }, {},
            image_transport::TransportHints(hint))) {}

  // What comes back of an image, sent until it does: connections take their time.
  sensor_msgs::ImageConstPtr send(const std::string& encoding, const cv::Mat& pixels) {
    std_msgs::Header header;
    header.frame_id = "camera";
    header.stamp = ros::Time(100 + next_stamp_++, 5000);
    const sensor_msgs::Image image = to_image(header, encoding, pixels);
    ros::WallTime sent;
    wait_until([&] {
      if (last_ && last_->header.stamp == header.stamp) return true;
      if (ros::WallTime::now() - sent > ros::WallDuration(0.2)) {
        publisher_.publish(image);
        sent = ros::WallTime::now();
      }
      return false;
    });
    return last_ && last_->header.stamp == header.stamp ? last_ : nullptr;
  }

 private:
  ros::NodeHandle nh_;
  image_transport::ImageTransport transport_{nh_};
  image_transport::Publisher publisher_;
  image_transport::Subscriber subscriber_;
  sensor_msgs::ImageConstPtr last_;
  std::uint32_t next_stamp_ = 1;
};

bool holds(const sensor_msgs::ImageConstPtr& image, const std::string& encoding,
           const cv::Mat& pixels) {
  return image && image->encoding == encoding && image->header.frame_id == "camera" &&
         image->width == static_cast<std::uint32_t>(pixels.cols) &&
         image->height == static_cast<std::uint32_t>(pixels.rows) &&
         image->data.size() == pixels.total() * pixels.elemSize() &&
         std::memcmp(image->data.data(), pixels.data, image->data.size()) == 0;
}

cv::Mat bgr_of(const sensor_msgs::ImageConstPtr& image) {
  const Result<cv::Mat> bgr = bgr_from_image(*image);
  return bgr ? bgr->clone() : cv::Mat();
}

// The next message of a topic.
sensor_msgs::CompressedImageConstPtr listen(const std::string& topic,
                                            const std::function<void()>& meanwhile) {
  ros::NodeHandle nh;
  sensor_msgs::CompressedImageConstPtr heard;
  const ros::Subscriber subscriber = nh.subscribe<sensor_msgs::CompressedImage>(
      topic, 1, [&heard](const sensor_msgs::CompressedImageConstPtr& m) { heard = m; });
  wait_until([&] { return subscriber.getNumPublishers() > 0; });
  meanwhile();
  wait_until([&] { return heard != nullptr; });
  return heard;
}

void attack(const std::string& topic, const sensor_msgs::CompressedImage& good, int attempts) {
  ros::NodeHandle nh;
  ros::Publisher publisher =
      nh.advertise<sensor_msgs::CompressedImage>(topic, static_cast<std::uint32_t>(attempts));
  ASSERT_TRUE(wait_until([&] { return publisher.getNumSubscribers() > 0; })) << topic;
  std::mt19937 random(5);
  for (int i = 0; i < attempts; ++i) {
    sensor_msgs::CompressedImage bad = good;
    if (i % 4 == 0) {
      bad.data.resize(random() % bad.data.size());
    } else if (i % 4 == 1) {
      for (auto& byte : bad.data) byte = static_cast<std::uint8_t>(random());
    } else {
      bad.data.resize(bad.data.size() - 4);
      const std::size_t from = i % 4 == 2 ? 6 : random() % bad.data.size();
      for (std::size_t at = from; at < std::min(from + 12, bad.data.size()); ++at) {
        bad.data[at] = static_cast<std::uint8_t>(random());
      }
      seal(bad.data);
    }
    if (i % 5 == 0) bad.format.assign(random() % 300, '\xff');
    publisher.publish(bad);
    ros::WallDuration(0.002).sleep();
    ros::spinOnce();
  }
}

bool reconfigure(const std::string& name_space, const dynamic_reconfigure::Config& config) {
  dynamic_reconfigure::Reconfigure change;
  change.request.config = config;
  ros::service::waitForService(name_space + "/set_parameters", ros::Duration(kPatience));
  return ros::service::call(name_space + "/set_parameters", change);
}

TEST(Transports, AreListedAsRvizAndRepublishFindThem) {
  FILE* pipe = ::popen("rosrun image_transport list_transports 2>&1", "r");
  ASSERT_NE(pipe, nullptr);
  std::string text;
  std::array<char, 256> part{};
  while (std::fgets(part.data(), part.size(), pipe) != nullptr) text += part.data();
  EXPECT_EQ(::pclose(pipe), 0);
  EXPECT_EQ(text.find("Not available"), std::string::npos) << text;
  for (const std::string name : {"image_transport/dhcm", "image_transport/pgf"}) {
    EXPECT_NE(text.find("\"" + name + "\""), std::string::npos) << text;
    ros::NodeHandle nh;
    const auto loadable = image_transport::ImageTransport(nh).getLoadableTransports();
    EXPECT_NE(std::find(loadable.begin(), loadable.end(), name), loadable.end()) << name;
  }
}

TEST(Transports, DepthCountsComeBackBitByBit) {
  Trip trip("depth", "/out/depth");
  const cv::Mat counts = depth_counts();
  EXPECT_TRUE(holds(trip.send(encodings::TYPE_16UC1, counts), encodings::TYPE_16UC1, counts));
}

TEST(Transports, DepthMetresComeBackBitByBit) {
  Trip trip("metres", "/out/metres");
  const cv::Mat metres = depth_metres();
  EXPECT_TRUE(holds(trip.send(encodings::TYPE_32FC1, metres), encodings::TYPE_32FC1, metres));
}

TEST(Transports, AStepIsKeptAndCanBeTakenBackAtRunTime) {
  Trip trip("metres", "/out/coarse");
  const cv::Mat metres = depth_metres();
  const auto rough = trip.send(encodings::TYPE_32FC1, metres);
  ASSERT_TRUE(rough);
  EXPECT_FALSE(holds(rough, encodings::TYPE_32FC1, metres));
  const cv::Mat back(metres.size(), CV_32FC1, const_cast<std::uint8_t*>(rough->data.data()));
  EXPECT_LE(cv::norm(back, metres, cv::NORM_INF, metres > 0.0f), 0.005001);

  dynamic_reconfigure::Config config;
  config.doubles.resize(1);
  config.doubles[0].name = "step";
  config.doubles[0].value = 0.0;
  ASSERT_TRUE(reconfigure("/coarse/dhcm", config));
  EXPECT_TRUE(holds(trip.send(encodings::TYPE_32FC1, metres), encodings::TYPE_32FC1, metres));
}

TEST(Transports, ColourComesBackAsFineAsAskedFor) {
  Trip trip("colour", "/out/colour");
  const cv::Mat bgr = synthetic::colourful(kWidth, kHeight);
  const auto back = trip.send(encodings::BGR8, bgr);
  ASSERT_TRUE(back);
  EXPECT_EQ(back->encoding, encodings::BGR8);
  ASSERT_EQ(bgr_of(back).size(), bgr.size());
  EXPECT_GT(psnr(bgr_of(back), bgr), 32.0);

  dynamic_reconfigure::Config config;
  config.ints.resize(1);
  config.ints[0].name = "quality";
  config.ints[0].value = 0;
  ASSERT_TRUE(reconfigure("/colour/pgf", config));
  EXPECT_TRUE(holds(trip.send(encodings::RGB8, bgr), encodings::RGB8, bgr));

  config.ints[0].value = 31;  // out of range: nothing changes
  ASSERT_TRUE(reconfigure("/colour/pgf", config));
  EXPECT_TRUE(holds(trip.send(encodings::RGB8, bgr), encodings::RGB8, bgr));
}

TEST(Transports, WrongParametersLeaveTheDefaults) {
  Trip trip("depth", "/out/misspelt");
  const cv::Mat counts = depth_counts();
  const auto message = listen("/misspelt/dhcm", [&] { trip.send("16UC1", counts); });
  ASSERT_TRUE(message);
  EXPECT_EQ(message->format, "16UC1; dhcm default");  // a row of transports.test asks for small
}

TEST(Transports, MessagesSayWhatTheyAre) {
  Trip trip("depth", "/out/depth");
  const auto message = listen("/depth/dhcm", [&] { trip.send("16UC1", depth_counts()); });
  ASSERT_TRUE(message);
  EXPECT_EQ(message->format, "16UC1; dhcm small");  // as transports.test sets the topic
  EXPECT_EQ(message->header.frame_id, "camera");
}

// Two of a topic in one node: settings have names once only.
TEST(Transports, ServeTwoSubscribersInANode) {
  Trip first("depth", "/depth", "dhcm");
  Trip second("depth", "/depth", "dhcm");
  const cv::Mat counts = depth_counts();
  EXPECT_TRUE(holds(second.send(encodings::TYPE_16UC1, counts), encodings::TYPE_16UC1, counts));
  EXPECT_TRUE(holds(first.send(encodings::TYPE_16UC1, counts), encodings::TYPE_16UC1, counts));
}

TEST(Transports, GarbageInDepthHarmsNothing) {
  Trip trip("depth", "/out/depth");
  const cv::Mat counts = depth_counts();
  const auto good = listen("/depth/dhcm", [&] { trip.send("16UC1", counts); });
  ASSERT_TRUE(good);
  attack("/depth/dhcm", *good, 400);
  EXPECT_TRUE(holds(trip.send(encodings::TYPE_16UC1, counts), encodings::TYPE_16UC1, counts));
}

TEST(Transports, GarbageInColourHarmsNothing) {
  Trip trip("colour", "/out/colour");
  const cv::Mat bgr = synthetic::colourful(kWidth, kHeight);
  const auto good = listen("/colour/pgf", [&] { trip.send("bgr8", bgr); });
  ASSERT_TRUE(good);
  attack("/colour/pgf", *good, 200);
  const auto back = trip.send(encodings::BGR8, bgr);
  ASSERT_TRUE(back);
  EXPECT_GT(psnr(bgr_of(back), bgr), 32.0);
}

}  // namespace
}  // namespace rprr

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "test_transports");
  ros::NodeHandle keep_alive;
  return RUN_ALL_TESTS();
}
