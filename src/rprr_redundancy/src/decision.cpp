// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_redundancy/decision.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/core.hpp>

#include "colour_gain.hpp"
#include "rprr_geometry/block_mask.hpp"

namespace rprr {
namespace {

constexpr std::size_t kFewestForGain = 50;  // blocks; with fewer, colours are not judged
constexpr std::size_t kMostForGain = 1200;
constexpr float kDark = 6.0f;  // grey levels beyond which a camera clips
constexpr float kBright = 249.0f;

struct Sums {
  int pixels = 0;
  int agreeing = 0;
  int coloured = 0;  // pixels summed up in bgr: every second one, which is enough for a mean
  int bgr[3] = {0, 0, 0};
  std::uint32_t cells = 0;  // a bit for each 2x2 cell, row by row
};

int bits_of(std::uint32_t cells) {
  int count = 0;
  for (; cells != 0; cells &= cells - 1) ++count;
  return count;
}

Sums sum_up(const WarpedDepth& warped, const cv::Rect& rect, float nearest, float farthest,
            const std::uint8_t* colours) {
  Sums sums;
  for (int v = 0; v < rect.height; ++v) {
    const float* z = warped.metres.ptr<float>(rect.y + v) + rect.x;
    const int* source = warped.source.ptr<int>(rect.y + v) + rect.x;
    for (int u = 0; u < rect.width; ++u) {
      const int there = static_cast<int>(source[u] >= 0);
      sums.pixels += there;
      sums.agreeing +=
          static_cast<int>(z[u] >= nearest) & static_cast<int>(z[u] <= farthest) & there;
      sums.cells |= static_cast<std::uint32_t>(there) << (v / 2 * 4 + u / 2);
    }
    for (int u = v % 2; u < rect.width; u += 2) {
      if (source[u] < 0) continue;
      const std::uint8_t* colour = colours + 3 * static_cast<std::ptrdiff_t>(source[u]);
      ++sums.coloured;
      for (int c = 0; c < 3; ++c) sums.bgr[c] += colour[c];
    }
  }
  return sums;
}

bool of_size(const cv::Mat& image, const Camera& camera) {
  return image.cols == camera.width && image.rows == camera.height;
}

// The preview may come from a radio: its parts must fit each other and b's camera.
bool usable(const BlockPreview& b, const Camera& b_camera) {
  return b.grid.width == b_camera.width && b.grid.height == b_camera.height && b.well_formed();
}

}  // namespace

float Decider::tolerance(float z, double resolution) const {
  const auto sigma = static_cast<float>(depth_sigma(static_cast<double>(z)));
  const auto rounding = static_cast<float>(0.5 * resolution);
  return options_.depth_tolerance + options_.depth_tolerance_share * z + 2.0f * sigma + rounding;
}

BlockDecision Decider::decide(const DepthFrame& a, const cv::Mat& a_bgr, const Camera& a_camera,
                              const Camera& b_camera, const Pose& b_from_a,
                              const BlockPreview* b_preview) {
  BlockDecision decision;
  decision.send.colour = predictor_.predict(a, a_camera, b_camera, b_from_a);
  const bool fits = b_preview != nullptr && usable(*b_preview, b_camera) &&
                    of_size(a.counts, a_camera) && of_size(a_bgr, a_camera) &&
                    a_bgr.type() == CV_8UC3 && a_bgr.isContinuous();
  if (!fits) {
    decision.send.depth = decision.send.colour;
    decision.uncovered = decision.send.colour.count();
    return decision;
  }
  decision.from_preview = true;
  decision.send = {BlockMask(b_preview->grid), BlockMask(b_preview->grid)};
  gather(a_bgr, *b_preview);
  look_back(a_camera, b_camera, b_from_a, *b_preview);
  judge_surfaces(*b_preview, decision);
  judge_colours(*b_preview, decision);
  return decision;
}

void Decider::gather(const cv::Mat& a_bgr, const BlockPreview& b) {
  const WarpedDepth& warped = predictor_.warped();
  evidence_.assign(static_cast<std::size_t>(b.grid.count()), {});
  for (int block = 0; block < b.grid.count(); ++block) {
    const cv::Rect rect = b.grid.rect(block);
    float nearest = 0.0f;
    float farthest = 0.0f;
    if (b.valid(block)) {
      const auto z = static_cast<float>(b.metres(block));
      const float reach = tolerance(z, b.resolution(b.metres(block)));
      nearest = z - reach;
      farthest = z + reach;
    }
    const Sums sums = sum_up(warped, rect, nearest, farthest, a_bgr.ptr<std::uint8_t>());
    if (sums.pixels == 0) continue;
    const auto pixels = static_cast<float>(sums.pixels);
    const int cells = (rect.width + 1) / 2 * ((rect.height + 1) / 2);
    Evidence& evidence = evidence_[static_cast<std::size_t>(block)];
    evidence.coverage = static_cast<float>(bits_of(sums.cells)) / static_cast<float>(cells);
    evidence.agreement = static_cast<float>(sums.agreeing) / pixels;
    const auto coloured = static_cast<float>(std::max(sums.coloured, 1));
    for (int c = 0; c < 3; ++c) evidence.bgr[c] = static_cast<float>(sums.bgr[c]) / coloured;
  }
}

void Decider::look_back(const Camera& a_camera, const Camera& b_camera, const Pose& b_from_a,
                        const BlockPreview& b) {
  const Pose a_from_b = b_from_a.inverse();
  for (int block = 0; block < b.grid.count(); ++block) {
    if (!b.valid(block)) continue;
    const cv::Rect rect = b.grid.rect(block);
    const Eigen::Vector3d p =
        a_from_b * b_camera.unproject(rect.x + 0.5 * (rect.width - 1),
                                      rect.y + 0.5 * (rect.height - 1), b.metres(block));
    bool& sees = evidence_[static_cast<std::size_t>(block)].sees_a;
    sees = p.z() > 0.0;
    if (!sees) continue;
    const Eigen::Vector2d pixel = a_camera.project(p);
    sees = a_camera.contains(pixel.x(), pixel.y());
  }
}

void Decider::judge_surfaces(const BlockPreview& b, BlockDecision& decision) const {
  for (int block = 0; block < b.grid.count(); ++block) {
    const Evidence& evidence = evidence_[static_cast<std::size_t>(block)];
    const bool has_depth = b.valid(block);
    int* reason = nullptr;
    if (evidence.coverage < options_.least_coverage) {
      reason = &decision.uncovered;
    } else if (!evidence.sees_a) {
      reason = &decision.outside;
    } else if (has_depth && evidence.agreement < options_.least_agreement) {
      reason = &decision.hidden;
    }
    if (reason == nullptr) continue;
    ++*reason;
    decision.send.colour.set(block);
    decision.send.depth.set(block, has_depth);
  }
}

bool Decider::fit_gains(const BlockPreview& b, const BlockMask& another_surface,
                        std::array<ColourGain, 3>& gains) const {
  const auto* colours = b.bgr.ptr<cv::Vec3b>();
  std::vector<int> sure;  // b's own depth says that the surface is the same
  for (int block = 0; block < b.grid.count(); ++block) {
    if (!another_surface[block] && b.valid(block)) sure.push_back(block);
  }
  std::vector<ColourPair> pairs;
  std::vector<float> buffer;
  const std::size_t stride = (sure.size() + kMostForGain - 1) / kMostForGain;
  for (int c = 0; c < 3; ++c) {
    pairs.clear();
    for (std::size_t i = 0; i < sure.size(); i += std::max<std::size_t>(stride, 1)) {
      const float x = evidence_[static_cast<std::size_t>(sure[i])].bgr[c];
      const auto y = static_cast<float>(colours[sure[i]][c]);
      if (x > kDark && x < kBright && y > kDark && y < kBright) pairs.push_back({x, y});
    }
    if (pairs.size() < kFewestForGain) return false;
    gains[static_cast<std::size_t>(c)] = fit_colour_gain(pairs, buffer);
  }
  return true;
}

void Decider::judge_colours(const BlockPreview& b, BlockDecision& decision) const {
  std::array<ColourGain, 3> gains;
  if (!fit_gains(b, decision.send.colour, gains)) return;
  const auto* colours = b.bgr.ptr<cv::Vec3b>();
  for (int block = 0; block < b.grid.count(); ++block) {
    if (decision.send.colour[block]) continue;
    bool differs = false;
    for (int c = 0; c < 3; ++c) {
      const ColourGain& gain = gains[static_cast<std::size_t>(c)];
      const float expected = gain.apply(evidence_[static_cast<std::size_t>(block)].bgr[c]);
      const float allowed = options_.colour_tolerance + options_.colour_sigmas * gain.spread;
      differs = differs || std::abs(static_cast<float>(colours[block][c]) - expected) > allowed;
    }
    if (!differs) continue;
    ++decision.recoloured;
    decision.send.colour.set(block);
  }
}

cv::Mat decision_picture(const BlockPreview& preview, const BlockMaskPair& send) {
  cv::Mat picture(preview.grid.height, preview.grid.width, CV_8UC3);
  const auto* colours = preview.bgr.ptr<cv::Vec3b>();
  const auto tinted = [](const cv::Vec3b& colour, const cv::Vec3b& tint) {
    cv::Vec3b mixed;
    for (int c = 0; c < 3; ++c) mixed[c] = static_cast<std::uint8_t>((colour[c] + tint[c]) / 2);
    return mixed;
  };
  for (int block = 0; block < preview.grid.count(); ++block) {
    cv::Vec3b colour = colours[block];
    if (send.depth[block]) {
      colour = tinted(colour, {0, 0, 255});
    } else if (send.colour[block]) {
      colour = tinted(colour, {255, 0, 0});
    }
    picture(preview.grid.rect(block)).setTo(cv::Scalar(colour[0], colour[1], colour[2]));
  }
  return picture;
}

}  // namespace rprr
