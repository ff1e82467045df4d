// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "rprr_codec/outgoing_frame.hpp"
#include "rprr_eval/exchange/exchange_harness.hpp"
#include "rprr_eval/measure/metrics.hpp"
#include "rprr_eval/profile/profile.hpp"
#include "rprr_geometry/result.hpp"
#include "rprr_redundancy/redundancy.hpp"
#include "rprr_sensor/recordings/tum_folder.hpp"

namespace rprr {

/// One pair through the whole scheme: the object that `rprr_eval pairs` writes (field names are
/// fixed).
struct PairResult {
  std::size_t a = 0, b = 0;  // entries of the folder
  ExchangeOutcome exchange;
  std::optional<PoseError> pose_error;  // where poses are known
  std::optional<double> overlap;
  RebuiltFrame rebuilt;
  int blocks_predicted = 0, blocks_validated = 0;
  EncodedSizes independent;  // of b's whole frame; total with the message around it
  double psnr = 0.0, ssim = 0.0;
  std::optional<double> psnr_predicted;
  double independent_psnr = 0.0, independent_ssim = 0.0;
  DepthQuality depth;
  bool depth_exact = false;  // received blocks equal b's own counts
  double ms_predict = 0.0, ms_validate = 0.0;
};

nlohmann::json to_json(const PairResult& result);

/// A pair up to what b sends, before it is encoded.
struct PreparedPair {
  PairResult result;  // what is known so far: exchange, blocks, pose error, overlap
  RgbdFramePtr a, b;
  OutgoingFrame outgoing;
};

/// Two robots and a station in one process, without ROS: the state machines and codecs that the
/// nodelets run. Robots keep between pairs what they learn of each other.
class PairRunner {
 public:
  /// Errors: what a codec refuses.
  static Result<PairRunner> create(const Profile& profile);

  /// Entry a of the folder as the reference's frame, entry b as the dependent's. Errors: images
  /// that cannot be read, a station that rebuilt nothing.
  Result<PairResult> run(const TumFolder& folder, std::size_t a, std::size_t b);

  /// run in steps, for whoever tries several settings: the exchange and b's decision once, the
  /// station then holding a's frame as the profile codes it, and b's frame encoded and rebuilt as
  /// often as one likes until the next pair. Errors as above.
  Result<PreparedPair> prepare(const TumFolder& folder, std::size_t a, std::size_t b);
  static Result<EncodedFrame> encode(const PreparedPair& pair, FrameEncoder& encoder);
  Result<RebuiltFrame> rebuild(const PreparedPair& pair, const EncodedFrame& encoded);

 private:
  struct Robots;
  static Result<RebuiltFrame> send_reference(const OutgoingFrame& outgoing, Robots& robots);
  explicit PairRunner(std::unique_ptr<Robots> robots);

 public:
  PairRunner(PairRunner&&) noexcept;
  PairRunner& operator=(PairRunner&&) noexcept;
  ~PairRunner();

 private:
  std::unique_ptr<Robots> robots_;
};

}  // namespace rprr
