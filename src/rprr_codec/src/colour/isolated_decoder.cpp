// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <opencv2/core.hpp>

#include "colour/worker_process.hpp"
#include "colour/worker_protocol.hpp"
#include "rprr_codec/colour_codec.hpp"
#include "rprr_geometry/camera.hpp"
#include "rprr_wire/bytes.hpp"

namespace rprr {
namespace {

class IsolatedDecoder : public ColourDecoder {
 public:
  explicit IsolatedDecoder(const WorkerLimits& limits) : limits_(limits) {}

  Result<cv::Mat> decode(const std::string& codec, ByteView payload, cv::Size expected) override {
    if (codec.size() > kMaxCodecName) return Error{"name of the colour codec is too long"};
    if (payload.size > kMaxColourPayload) return Error{"colour payload is too large"};
    if (expected.width < 1 || expected.height < 1 || expected.width > kMaxImageSide ||
        expected.height > kMaxImageSide) {
      return Error{"impossible colour image size"};
    }
    const Deadline deadline = std::chrono::steady_clock::now() +
                              std::chrono::duration_cast<std::chrono::steady_clock::duration>(
                                  std::chrono::duration<double>(limits_.seconds));
    const Result<bool> sent = send_request(codec, payload, expected, deadline);
    if (!sent) return Error{sent.reason()};
    return receive_reply(expected, deadline);
  }

 private:
  Result<bool> send_request(const std::string& codec, ByteView payload, cv::Size expected,
                            const Deadline& deadline) {
    ByteWriter writer;
    writer.put(static_cast<std::uint32_t>(payload.size));
    writer.put(static_cast<std::uint16_t>(expected.width));
    writer.put(static_cast<std::uint16_t>(expected.height));
    writer.put(static_cast<std::uint8_t>(codec.size()));
    writer.append({reinterpret_cast<const std::uint8_t*>(codec.data()), codec.size()});
    // A worker may have died since its last image (someone killed it): then once more, anew.
    for (const bool last_try : {!worker_.running(), true}) {
      if (!worker_.running()) {
        Result<bool> started = worker_.start(colour_worker_path(), limits_);
        if (!started) return started;
      }
      Transfer state = send_all(worker_.socket(), writer.bytes(), deadline);
      if (state == Transfer::kDone) state = send_all(worker_.socket(), payload, deadline);
      if (state == Transfer::kDone) return true;
      worker_.stop();
      if (state == Transfer::kTimeout) return Error{"the colour worker took too long"};
      if (last_try) break;
    }
    return Error{"the colour worker '" + colour_worker_path() + "' does not run"};
  }

  Result<cv::Mat> receive_reply(cv::Size expected, const Deadline& deadline) {
    std::uint8_t good = 0;
    Transfer state = receive_all(worker_.socket(), &good, 1, deadline);
    if (state == Transfer::kDone && good == 1) {
      cv::Mat image(expected, CV_8UC3);
      state = receive_all(worker_.socket(), image.data, image.total() * image.elemSize(), deadline);
      if (state == Transfer::kDone) return image;
    } else if (state == Transfer::kDone && good == 0) {
      std::string reason;
      if (receive_reason(reason, deadline)) return Error{reason};
    }
    worker_.stop();  // what it would say next is not to be trusted either
    return Error{state == Transfer::kTimeout
                     ? "decoding took too long; the colour worker was killed"
                     : "the colour worker died on this payload"};
  }

  bool receive_reason(std::string& reason, const Deadline& deadline) {
    std::uint8_t raw[2];
    if (receive_all(worker_.socket(), raw, 2, deadline) != Transfer::kDone) return false;
    const std::size_t length = raw[0] | std::size_t{raw[1]} << 8;
    if (length > kMaxReason) return false;
    reason.resize(length);
    if (receive_all(worker_.socket(), reinterpret_cast<std::uint8_t*>(reason.data()), length,
                    deadline) != Transfer::kDone) {
      return false;
    }
    std::replace_if(
        reason.begin(), reason.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
    return true;
  }

  WorkerLimits limits_;
  WorkerProcess worker_;
};

}  // namespace

std::unique_ptr<ColourDecoder> make_isolated_colour_decoder(const WorkerLimits& limits) {
  return std::make_unique<IsolatedDecoder>(limits);
}

}  // namespace rprr
