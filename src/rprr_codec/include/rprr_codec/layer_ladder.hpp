// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "rprr_codec/colour_codec.hpp"

namespace rprr {

/// What a dependent's colour is for.
enum class Objective {
  kFixed,  // the blocks sent, and nothing of the rest
  kMap,    // new surfaces well, the least for the rest
  kView,   // the best whole picture
};

/// How the colour of one frame is sent. Of a whole frame only detail_quality counts.
struct LayerSettings {
  int base_reduction = 0;  // 0: no base; 1, 2, 4, 8, 16
  int base_quality = 0;    // the codec's own scale
  int detail_quality = 0;  // the codec's own scale
  bool detail = true;      // false: the base alone
};

/// The settings worth choosing for an objective, from few bytes to many. For kView all that lies
/// between the preview's block means and the whole frame is on it: from a base of 1/16 of the size
/// to the whole image at one quality, with the blocks that only this robot sees in more detail as
/// long as that gains more per byte. For kMap those blocks at rising quality over the least base.
/// Chosen by the pictures that combinations of base and detail gave on pairs of a kitchen and of a
/// rendered room; what the ladder reaches there and elsewhere: docs/quality.md.
class LayerLadder {
 public:
  /// few_blocks: whether few of the frame's blocks are to be sent (kFewBlocksShare). usual_quality:
  /// that of a whole image, on WebP's scale, which the usual rung is like.
  LayerLadder(Objective objective, bool few_blocks, const ColourCodecInfo& codec,
              double usual_quality);

  int rungs() const { return static_cast<int>(settings_.size()); }
  const LayerSettings& at(int rung) const { return settings_[static_cast<std::size_t>(rung)]; }
  const std::vector<LayerSettings>& all() const { return settings_; }
  /// The rung that is like the usual quality.
  int usual() const { return usual_; }

 private:
  std::vector<LayerSettings> settings_;
  int usual_ = 0;
};

/// Qualities of a codec from its coarsest to just below quality, each some 5 to 20% more bytes.
std::vector<int> coarser_qualities(const ColourCodecInfo& codec, int quality);

/// Fewer than this share of blocks are few.
constexpr double kFewBlocksShare = 0.15;

/// The quality of a codec at which its error is about that of WebP at a quality (0 to 100).
int like_webp(const ColourCodecInfo& codec, double webp_quality);
/// The other way round.
double as_webp(const ColourCodecInfo& codec, int quality);

}  // namespace rprr
