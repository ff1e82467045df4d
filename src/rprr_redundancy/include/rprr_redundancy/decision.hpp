// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "rprr_geometry/camera.hpp"
#include "rprr_geometry/se3.hpp"
#include "rprr_redundancy/prediction.hpp"
#include "rprr_wire/mask_wire.hpp"
#include "rprr_wire/preview.hpp"

namespace rprr {

struct ColourGain;

/// The thresholds were set on the synthetic room, poses 1 cm off:
///   rosrun rprr_sensor synthetic_to_folder FOLDER --frames 16 --seed 3
///   rosrun rprr_eval rprr_eval decision FOLDER --step 1
/// Of 5800 blocks whose surface the prediction gets wrong 5365 are sent with depth, and 242 right
/// ones. --agreement 0.4: 5409 and 409; with --coverage 0.7 and --agreement 0.5: 5705 and 1172.
/// 112 blocks of the right colour are sent in colour only; with --colour-sigmas 2.5: 959.
/// On seeds 21 to 23, which nothing was set on: 19005 of 20674 wrong ones and 701 right ones.
struct DecisionOptions {
  /// A block is covered if this share of its 2x2 cells holds a warped pixel (cells, since a surface
  /// that b sees nearer than a spreads its pixels).
  float least_coverage = 0.5f;
  /// Depths agree if this share of the block's warped pixels lies within the tolerance of the
  /// preview's depth. Low, so that blocks across an edge agree through either of their surfaces.
  float least_agreement = 0.25f;
  float depth_tolerance = 0.02f;         // [m]
  float depth_tolerance_share = 0.015f;  // of the depth; both sensors' sigma is added
  float colour_tolerance = 8.0f;         // the preview's coding noise [grey levels]
  float colour_sigmas = 4.0f;            // of the robust spread of the frame's blocks
};

/// What the reference tells the dependent to send, and why. Each block counts once, by the first
/// reason that holds.
struct BlockDecision {
  BlockMaskPair send;         // blocks whose colour, and of these whose depth, b must send
  bool from_preview = false;  // false: the paper's B_p for both
  int uncovered = 0;          // too few warped pixels: all of B_p and more
  int outside = 0;            // b's surface is outside of a's field of view
  int hidden = 0;             // b sees another surface than the one warped there
  int recoloured = 0;         // same surface, another colour than gain explains
};

/// Decides every block of b from a's frame, the pose and, if it has one, b's preview. Keeps its
/// buffers between frames; one object serves one thread.
class Decider {
 public:
  explicit Decider(DecisionOptions options = {}) : options_(options) {}

  /// b_preview may be null. A preview of another size than b's camera, or colours (CV_8UC3) that
  /// are not of a's, count as none. b_from_a maps points of a's optical frame into b's.
  BlockDecision decide(const DepthFrame& a, const cv::Mat& a_bgr, const Camera& a_camera,
                       const Camera& b_camera, const Pose& b_from_a, const BlockPreview* b_preview);

  /// What the warp says of one block.
  struct Evidence {
    float coverage = 0.0f;              // share of the 2x2 cells with a warped pixel
    float agreement = 0.0f;             // share of the warped pixels at the preview's depth
    float bgr[3] = {0.0f, 0.0f, 0.0f};  // mean over the warped pixels
    bool sees_a = true;                 // the preview's point lies in a's field of view
  };

 private:
  void gather(const cv::Mat& a_bgr, const BlockPreview& b);
  void look_back(const Camera& a_camera, const Camera& b_camera, const Pose& b_from_a,
                 const BlockPreview& b);
  void judge_surfaces(const BlockPreview& b, BlockDecision& decision) const;
  /// False where too few blocks tell.
  bool fit_gains(const BlockPreview& b, const BlockMask& another_surface,
                 std::array<ColourGain, 3>& gains) const;
  void judge_colours(const BlockPreview& b, BlockDecision& decision) const;
  float tolerance(float z, double resolution) const;

  DecisionOptions options_;
  Predictor predictor_;
  std::vector<Evidence> evidence_;
};

/// A picture for people (CV_8UC3, full size): the preview's colours, tinted blue where only colour
/// is to be sent and red where both are.
cv::Mat decision_picture(const BlockPreview& preview, const BlockMaskPair& send);

}  // namespace rprr
