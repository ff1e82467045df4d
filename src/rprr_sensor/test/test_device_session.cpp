// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_sensor/cameras/device_session.hpp"

#include <gtest/gtest.h>

#include <memory>

namespace rprr {
namespace {

constexpr Duration kFramePeriod = from_seconds(1.0 / 30.0);

/// What the fake camera does; shared between test, driver and device.
struct World {
  SteadyTime now = steady_seconds(1000.0);
  bool plugged = true;
  bool colour = true;
  bool depth = true;
  Duration period = kFramePeriod;
  Duration phase = from_seconds(0.004);
  int opened = 0;
  int asked = 0;
  int alive = 0;
  DeviceControls controls;
};

class FakeDevice : public RgbdDevice {
 public:
  explicit FakeDevice(World& world) : world_(world), began_(world.now) { ++world_.alive; }
  ~FakeDevice() override { --world_.alive; }
  FakeDevice(const FakeDevice&) = delete;
  FakeDevice& operator=(const FakeDevice&) = delete;

  const std::string& serial() const override { return serial_; }
  DepthFormat depth_format() const override { return DepthFormat::registered_mm; }
  Result<std::optional<DeviceImage>> next(Duration timeout) override {
    if (!world_.plugged) return Error{"gone"};
    const bool is_colour = count_ % 2 == 0;
    const Duration due = (count_ / 2) * world_.period + (is_colour ? 0 : world_.phase);
    if (began_ + due > world_.now + timeout) {
      world_.now += timeout;
      return std::optional<DeviceImage>();
    }
    world_.now = std::max(world_.now, began_ + due);
    ++count_;
    if (!(is_colour ? world_.colour : world_.depth)) {
      world_.now += 1;
      return std::optional<DeviceImage>();
    }
    const auto kind = is_colour ? DeviceImage::Kind::colour : DeviceImage::Kind::depth;
    return std::optional<DeviceImage>({kind, cv::Mat(), due});
  }
  std::string control(const DeviceControls& controls) override {
    world_.controls = controls;
    return controls.gain > 0 ? "no gain" : "";
  }

 private:
  World& world_;
  SteadyTime began_;
  int count_ = 0;
  std::string serial_ = "A1";
};

class FakeDriver : public RgbdDriver {
 public:
  explicit FakeDriver(World& world) : world_(world) {}
  std::string name() const override { return "fake"; }
  Result<std::unique_ptr<RgbdDevice>> open(const std::string& /*serial*/,
                                           const DeviceModes& /*modes*/) override {
    ++world_.asked;
    if (!world_.plugged) return Error{"no camera is plugged in"};
    ++world_.opened;
    return std::unique_ptr<RgbdDevice>(std::make_unique<FakeDevice>(world_));
  }

 private:
  World& world_;
};

class DeviceSessionTest : public testing::Test {
 protected:
  DeviceSession make(const SessionOptions& options = {}) {
    return DeviceSession(
        std::make_unique<FakeDriver>(world_), options,
        {[this] { return world_.now; }, [this] { return world_.now.since_start(); }});
  }
  /// Lets it run; idle time passes.
  void run(DeviceSession& session, double seconds) {
    pairs_ = 0;
    notices_.clear();
    const SteadyTime end = world_.now + from_seconds(seconds);
    while (world_.now < end) {
      const SessionStep step = session.step();
      pairs_ += step.pair ? 1 : 0;
      if (step.notice) notices_.push_back(*step.notice);
      world_.now += step.idle > 0 ? step.idle : 1;
    }
  }
  bool noticed(const std::string& key) const {
    for (const auto& notice : notices_) {
      if (notice.key == key) return true;
    }
    return false;
  }

  World world_;
  int pairs_ = 0;
  std::vector<SessionNotice> notices_;
};

TEST_F(DeviceSessionTest, PairsFlowAndNothingIsSaid) {
  DeviceSession session = make();
  run(session, 10.0);
  EXPECT_NEAR(pairs_, 300, 3);
  EXPECT_TRUE(notices_.empty()) << notices_[0].text;
  EXPECT_EQ(session.device()->serial(), "A1");
  EXPECT_NEAR(session.rates().colour, 30.0, 1.0);
  EXPECT_NEAR(session.rates().worst_skew, 0.004, 0.001);
}

TEST_F(DeviceSessionTest, MissingCameraIsLookedForEverLessOften) {
  world_.plugged = false;
  DeviceSession session = make();
  run(session, 60.0);
  EXPECT_TRUE(noticed("device"));
  EXPECT_EQ(notices_[0].text, "fake: no camera is plugged in");
  EXPECT_GT(world_.asked, 10);
  EXPECT_LT(world_.asked, 20);
  EXPECT_EQ(session.device(), nullptr);
  world_.plugged = true;
  run(session, 10.0);
  EXPECT_GT(pairs_, 100) << "found within the longest wait";
}

TEST_F(DeviceSessionTest, UnpluggedItIsClosedAndFoundAgain) {
  DeviceSession session = make();
  run(session, 2.0);
  world_.plugged = false;
  run(session, 1.0);
  EXPECT_TRUE(noticed("lost"));
  EXPECT_EQ(world_.alive, 0) << "closed";
  world_.plugged = true;
  run(session, 3.0);
  EXPECT_EQ(world_.opened, 2);
  EXPECT_GT(pairs_, 30);
}

TEST_F(DeviceSessionTest, SilentStreamIsNamedAndTheCameraOpenedAnew) {
  DeviceSession session = make();
  run(session, 2.0);
  world_.depth = false;
  run(session, 6.0);
  ASSERT_TRUE(noticed("lost"));
  EXPECT_NE(notices_.back().text.find("the depth stream is silent"), std::string::npos)
      << notices_.back().text;
  world_.depth = true;
  run(session, 10.0);
  EXPECT_GT(pairs_, 100);
}

TEST_F(DeviceSessionTest, SlowStreamsAreReportedAndKept) {
  world_.period = 3 * kFramePeriod;
  DeviceSession session = make();
  run(session, 20.0);
  EXPECT_TRUE(noticed("rate"));
  EXPECT_FALSE(noticed("lost"));
  EXPECT_NEAR(pairs_, 200, 5);
}

TEST_F(DeviceSessionTest, StreamsThatNeverMeetAreReported) {
  SessionOptions options;
  options.window = from_seconds(0.001);
  world_.phase = from_seconds(0.015);
  DeviceSession session = make(options);
  run(session, 10.0);
  EXPECT_EQ(pairs_, 0);
  EXPECT_TRUE(noticed("pairs"));
}

TEST_F(DeviceSessionTest, ControlsOutliveTheDevice) {
  SessionOptions options;
  options.controls.auto_exposure = false;
  DeviceSession session = make(options);
  run(session, 1.0);
  EXPECT_FALSE(world_.controls.auto_exposure) << "from the beginning";
  DeviceControls controls;
  controls.gain = 3;
  EXPECT_EQ(session.control(controls), "no gain");
  world_.plugged = false;
  run(session, 0.3);
  world_.plugged = true;
  world_.controls = DeviceControls();
  run(session, 3.0);
  EXPECT_EQ(world_.controls.gain, 3);
  EXPECT_TRUE(noticed("controls"));
}

}  // namespace
}  // namespace rprr
