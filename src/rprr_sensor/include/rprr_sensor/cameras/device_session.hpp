// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "rprr_geometry/stamp.hpp"
#include "rprr_geometry/steady_time.hpp"
#include "rprr_sensor/cameras/device_clock.hpp"
#include "rprr_sensor/cameras/frame_pairing.hpp"
#include "rprr_sensor/cameras/rgbd_device.hpp"

namespace rprr {

struct SessionOptions {
  std::string serial;  // as RgbdDriver::open takes it
  DeviceModes modes;
  DeviceControls controls;
  Duration window = from_seconds(0.02);      // between colour and depth of a pair
  Duration silence = from_seconds(5.0);      // of a stream, after which the device is given up
  Duration first_retry = from_seconds(0.5);  // until a device is looked for again; doubles
  Duration longest_retry = from_seconds(5.0);
};

struct SessionClocks {
  std::function<SteadyTime()> steady;  // for timeouts
  std::function<Stamp()> stamps;       // for frames
};

/// Something that a person should know.
struct SessionNotice {
  std::string key;  // the same for the same kind of notice
  std::string text;
  bool is_error = false;
};

/// What one step of a session came to; any of it may be empty.
struct SessionStep {
  bool opened = false;  // a device was opened in this step
  std::optional<DevicePair> pair;
  std::optional<SessionNotice> notice;
  Duration idle = 0;  // nothing will happen before so long, ns
};

/// How the streams run, over the last few seconds.
struct SessionRates {
  double colour = 0.0;  // images per second
  double depth = 0.0;
  double worst_skew = 0.0;  // between colour and depth of a pair, s
};

/// Keeps a camera running: opens it, reads and pairs its images, notices when it is lost or silent,
/// and looks for it again, ever less often. One thread uses it.
class DeviceSession {
 public:
  DeviceSession(std::unique_ptr<RgbdDriver> driver, const SessionOptions& options,
                SessionClocks clocks);

  /// Blocks for 0.1 s at most, or while the driver opens a device.
  SessionStep step();

  /// Null while no device is open.
  const RgbdDevice* device() const { return device_.get(); }
  SessionRates rates() const;
  std::uint64_t unpaired() const { return pairing_.unpaired(); }
  /// Also for devices opened later. Returns what RgbdDevice::control does.
  std::string control(const DeviceControls& controls);

 private:
  struct Arrival {
    SteadyTime when;
    DeviceImage::Kind kind;
  };
  struct Skew {
    SteadyTime when;
    Duration skew;
  };

  SessionStep open(SteadyTime now);
  SessionStep read(SteadyTime now);
  SessionStep take(DeviceImage image, SteadyTime now);
  std::optional<SessionNotice> pace(SteadyTime now);
  SessionStep give_up(SteadyTime now, const std::string& why);
  void forget_old(SteadyTime now);

  std::unique_ptr<RgbdDriver> driver_;  // outlives its device
  SessionOptions options_;
  SessionClocks clocks_;
  std::unique_ptr<RgbdDevice> device_;
  DeviceClock device_clock_;
  FramePairing pairing_;
  Duration retry_ = 0;
  SteadyTime next_try_;   // when a device is looked for again
  SteadyTime opened_at_;  // when the device was opened
  SteadyTime last_colour_;
  SteadyTime last_depth_;
  SteadyTime pace_checked_;
  std::deque<Arrival> arrivals_;
  std::deque<Skew> skews_;
};

}  // namespace rprr
