// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_sensor/cameras/device_session.hpp"

#include <algorithm>
#include <cstdio>
#include <utility>

namespace rprr {
namespace {

constexpr Duration kReadTimeout = from_seconds(0.1);
constexpr Duration kMeasured = from_seconds(3.0);  // over which rates are taken
constexpr double kSlow = 0.6;                      // of the rate asked for

std::string one_decimal(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f", value);
  return text;
}

}  // namespace

DeviceSession::DeviceSession(std::unique_ptr<RgbdDriver> driver, const SessionOptions& options,
                             SessionClocks clocks)
    : driver_(std::move(driver)),
      options_(options),
      clocks_(std::move(clocks)),
      pairing_(options.window),
      retry_(options.first_retry) {
}

SessionStep DeviceSession::step() {
  const SteadyTime now = clocks_.steady();
  if (device_) return read(now);
  if (now < next_try_) {
    SessionStep step;
    step.idle = next_try_ - now;
    return step;
  }
  return open(now);
}

SessionStep DeviceSession::open(SteadyTime now) {
  auto device = driver_->open(options_.serial, options_.modes);
  if (!device) return give_up(clocks_.steady(), device.reason());
  device_ = std::move(*device);
  device_clock_ = DeviceClock();
  opened_at_ = last_colour_ = last_depth_ = pace_checked_ = std::max(now, clocks_.steady());
  arrivals_.clear();
  skews_.clear();
  SessionStep step;
  step.opened = true;
  const std::string refused = device_->control(options_.controls);
  if (!refused.empty()) step.notice = SessionNotice{"controls", refused, false};
  return step;
}

SessionStep DeviceSession::read(SteadyTime now) {
  auto image = device_->next(kReadTimeout);
  if (!image) return give_up(now, image.reason());
  now = clocks_.steady();
  SessionStep step;
  if (*image) step = take(std::move(**image), now);
  const Duration colour_silence = now - last_colour_;
  const Duration depth_silence = now - last_depth_;
  if (std::max(colour_silence, depth_silence) > options_.silence) {
    const bool both = std::min(colour_silence, depth_silence) > options_.silence;
    const std::string silent = both                             ? "both streams are silent"
                               : colour_silence > depth_silence ? "the colour stream is silent"
                                                                : "the depth stream is silent";
    return give_up(now, silent + " for " + one_decimal(to_seconds(options_.silence)) +
                            " s: opening the camera anew; if that does not help check its cable, "
                            "its power supply and that it has a USB controller to itself");
  }
  if (!step.notice) step.notice = pace(now);
  return step;
}

SessionStep DeviceSession::take(DeviceImage image, SteadyTime now) {
  const Stamp stamp = device_clock_.stamp(image.device_time, clocks_.stamps());
  (image.kind == DeviceImage::Kind::colour ? last_colour_ : last_depth_) = now;
  arrivals_.push_back({now, image.kind});
  forget_old(now);
  SessionStep step;
  step.pair = pairing_.add(std::move(image), stamp);
  if (step.pair) {
    retry_ = options_.first_retry;  // it works: next time begin with short waits again
    const Duration skew = step.pair->colour_stamp - step.pair->depth_stamp;
    skews_.push_back({now, skew < 0 ? -skew : skew});
  }
  return step;
}

std::optional<SessionNotice> DeviceSession::pace(SteadyTime now) {
  if (now - pace_checked_ < kMeasured) return std::nullopt;
  pace_checked_ = now;
  forget_old(now);
  const SessionRates measured = rates();
  const double expected = kSlow * options_.modes.rate;
  if (measured.colour < expected || measured.depth < expected) {
    return SessionNotice{"rate",
                         "slow streams: colour " + one_decimal(measured.colour) + ", depth " +
                             one_decimal(measured.depth) + " of " +
                             std::to_string(options_.modes.rate) +
                             " images a second; is the processor or the USB bus overloaded, or "
                             "does auto exposure lengthen exposures in the dark?",
                         false};
  }
  if (skews_.empty()) {
    return SessionNotice{"pairs",
                         "no colour and depth image lie within ~max_skew = " +
                             std::to_string(to_seconds(options_.window)) +
                             " s of each other: raise it to half of a frame's period or more",
                         false};
  }
  return std::nullopt;
}

SessionStep DeviceSession::give_up(SteadyTime now, const std::string& why) {
  const bool was_open = device_ != nullptr;
  device_.reset();
  next_try_ = now + retry_;
  retry_ = std::min(2 * retry_, options_.longest_retry);
  SessionStep step;
  step.notice = SessionNotice{was_open ? "lost" : "device", driver_->name() + ": " + why, true};
  return step;
}

void DeviceSession::forget_old(SteadyTime now) {
  while (!arrivals_.empty() && arrivals_.front().when < now - kMeasured) arrivals_.pop_front();
  while (!skews_.empty() && skews_.front().when < now - kMeasured) skews_.pop_front();
}

SessionRates DeviceSession::rates() const {
  SessionRates rates;
  const Duration since_open = clocks_.steady() - opened_at_;
  const double seconds = to_seconds(std::clamp(since_open, from_seconds(0.1), kMeasured));
  for (const Arrival& arrival : arrivals_) {
    (arrival.kind == DeviceImage::Kind::colour ? rates.colour : rates.depth) += 1.0 / seconds;
  }
  for (const Skew& skew : skews_) {
    rates.worst_skew = std::max(rates.worst_skew, to_seconds(skew.skew));
  }
  return rates;
}

std::string DeviceSession::control(const DeviceControls& controls) {
  options_.controls = controls;
  return device_ ? device_->control(controls) : std::string();
}

}  // namespace rprr
