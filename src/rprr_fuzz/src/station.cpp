// SPDX-License-Identifier: BSD-3-Clause
// Any bytes as what a station receives: u8 robot and stamp, u16 length, then the message, as it is
// or with the checksum made good. Colour payloads are any image: they are left to the worker
// process.
#include "rprr_station/station.hpp"
#include "fuzz.hpp"
#include "rprr_wire/bytes.hpp"

using namespace rprr;

namespace {

class AnyColour : public ColourDecoder {
 public:
  Result<cv::Mat> decode(const std::string&, ByteView payload, cv::Size expected) override {
    if (payload.size == 0) return Error{"empty"};
    return cv::Mat(expected, CV_8UC3, cv::Scalar::all(payload.data[0]));
  }
};

StationOptions small_station() {
  StationOptions options;
  options.robots = {"a", "b"};
  options.waiting = 2;
  options.references_held = 2;
  options.largest_message = 1 << 16;
  options.largest_image = 1 << 14;
  return options;
}

void check(const StationOptions& options, const Station& station, const StationOutput& output) {
  fuzz::require(station.waiting() <= options.robots.size() * options.waiting);
  fuzz::require(station.held("a").size() <= options.references_held);
  for (const RebuiltFrame& frame : output.frames) {
    fuzz::require(frame.bgr.total() <= options.largest_image);
    fuzz::require(frame.bgr.size() == frame.depth.counts.size());
    fuzz::require(frame.bgr.size() == frame.provenance.size());
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const StationOptions options = small_station();
  Station station(options, std::make_unique<AnyColour>());
  ByteView rest(data, size);
  for (SteadyTime now(1); rest.size >= 3; now += from_seconds(0.2)) {
    const std::uint8_t head = rest.data[0];
    const std::size_t stated = rest.data[1] | rest.data[2] << 8;
    const std::size_t length = std::min(stated, rest.size - 3);
    Bytes bytes(rest.data + 3, rest.data + 3 + length);
    rest = rest.from(3 + length);
    if ((head & 1) != 0) seal(bytes);
    ReceivedMessage message;
    message.robot = (head & 2) != 0 ? "a" : "b";
    message.stamp = head >> 2 & 3;
    message.data = bytes;
    check(options, station, station.receive(message, now));
  }
  check(options, station, station.tick(steady_seconds(1000.0)));
  return 0;
}
