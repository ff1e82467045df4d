// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_codec/layer_ladder.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace rprr {
namespace {

struct Rung {
  int reduction;  // of the base
  int base;       // quality, on WebP's scale
  int detail;     // quality of the detail layer; kNone: the base alone
  int like;       // quality of a whole image, on WebP's scale, that shows as much
};
constexpr int kNone = -1;

// Where much is sent, its blocks are scattered and a finer base for all is worth more than detail
// for some.
constexpr std::array<Rung, 39> kManyBlocks{
    {{16, 20, kNone, 0}, {16, 50, kNone, 0}, {8, 20, kNone, 0},   {8, 50, kNone, 0},
     {4, 10, kNone, 0},  {4, 18, kNone, 0},  {4, 25, kNone, 1},   {4, 37, kNone, 1},
     {4, 50, kNone, 2},  {2, 10, kNone, 4},  {2, 17, kNone, 5},   {2, 25, kNone, 7},
     {2, 37, kNone, 11}, {2, 50, kNone, 15}, {2, 62, kNone, 18},  {2, 75, kNone, 22},
     {1, 15, kNone, 25}, {1, 20, kNone, 29}, {1, 25, kNone, 33},  {1, 30, kNone, 38},
     {1, 35, kNone, 42}, {1, 40, kNone, 46}, {1, 45, kNone, 50},  {1, 50, kNone, 54},
     {1, 55, kNone, 58}, {1, 60, kNone, 62}, {1, 66, kNone, 67},  {1, 72, kNone, 73},
     {1, 76, kNone, 76}, {1, 79, kNone, 79}, {1, 82, kNone, 82},  {1, 85, kNone, 85},
     {1, 88, kNone, 88}, {1, 90, kNone, 90}, {1, 92, kNone, 92},  {1, 94, kNone, 94},
     {1, 96, kNone, 96}, {1, 98, kNone, 98}, {1, 100, kNone, 100}}};

constexpr std::array<Rung, 35> kFewBlocks{
    {{16, 20, kNone, 0}, {16, 50, kNone, 0}, {8, 20, kNone, 0},   {16, 50, 0, 0},
     {8, 20, 5, 1},      {8, 20, 10, 2},     {8, 50, 20, 4},      {8, 50, 30, 7},
     {4, 50, 30, 11},    {2, 10, 30, 15},    {2, 17, 30, 18},     {2, 25, 30, 22},
     {2, 37, 30, 25},    {2, 50, 30, 27},    {1, 25, kNone, 33},  {1, 30, kNone, 38},
     {1, 35, kNone, 42}, {1, 40, kNone, 46}, {1, 45, kNone, 50},  {1, 50, kNone, 54},
     {1, 55, kNone, 58}, {1, 60, kNone, 62}, {1, 66, kNone, 67},  {1, 72, kNone, 73},
     {1, 76, kNone, 76}, {1, 79, kNone, 79}, {1, 82, kNone, 82},  {1, 85, kNone, 85},
     {1, 88, kNone, 88}, {1, 90, kNone, 90}, {1, 92, kNone, 92},  {1, 94, kNone, 94},
     {1, 96, kNone, 96}, {1, 98, kNone, 98}, {1, 100, kNone, 100}}};

constexpr std::array<int, 20> kMapDetail{0,  2,  5,  9,  14, 20, 28, 36, 45, 55,
                                         65, 75, 82, 86, 89, 92, 94, 96, 98, 100};
constexpr int kMapReduction = 8;
constexpr int kMapBase = 20;

// Qualities of the same error: WebP's, and those of another codec.
struct Equal {
  double webp;
  double other;
};
constexpr std::array<Equal, 7> kJpeg{
    {{0, 8}, {5, 14}, {10, 20}, {20, 25}, {40, 43}, {75, 72}, {100, 97}}};
constexpr std::array<Equal, 7> kPgf{
    {{0, 8.4}, {5, 7.6}, {10, 7}, {20, 6.6}, {40, 5.9}, {75, 5}, {100, 2}}};

using Column = double Equal::*;

// Values of one column at a value of the other, in which the table rises or falls.
double interpolate(const std::array<Equal, 7>& table, Column from, Column to, double value) {
  const bool rises = table.back().*from > table.front().*from;
  std::size_t i = 1;
  while (i + 1 < table.size() && (rises ? table[i].*from < value : table[i].*from > value)) ++i;
  const Equal& a = table[i - 1];
  const Equal& b = table[i];
  return a.*to + (value - a.*from) / (b.*from - a.*from) * (b.*to - a.*to);
}

// None: qualities are WebP's.
const std::array<Equal, 7>* table_of(const std::string& codec) {
  if (codec == "jpeg") return &kJpeg;
  if (codec == "pgf") return &kPgf;
  return nullptr;
}

}  // namespace

int like_webp(const ColourCodecInfo& codec, double webp_quality) {
  const auto* table = table_of(codec.name);
  const double quality = table == nullptr
                             ? webp_quality
                             : interpolate(*table, &Equal::webp, &Equal::other, webp_quality);
  const auto [low, high] = std::minmax(codec.best, codec.coarsest);
  return std::clamp(static_cast<int>(std::lround(quality)), low, high);
}

double as_webp(const ColourCodecInfo& codec, int quality) {
  const auto* table = table_of(codec.name);
  return table == nullptr ? quality : interpolate(*table, &Equal::other, &Equal::webp, quality);
}

std::vector<int> coarser_qualities(const ColourCodecInfo& codec, int quality) {
  const int sign = codec.best > codec.coarsest ? 1 : -1;
  std::vector<int> qualities;
  const auto add = [&](int next) {
    if (sign * (quality - next) <= 0) return;
    if (qualities.empty() || sign * (next - qualities.back()) > 0) qualities.push_back(next);
  };
  // Some codecs go below the least of WebP.
  constexpr int kStep = 3;
  const int least = like_webp(codec, kMapDetail[0]);
  for (int next = codec.coarsest; sign * (least - next) > 0; next += sign * kStep) add(next);
  for (const int webp : kMapDetail) add(like_webp(codec, webp));
  return qualities;
}

LayerLadder::LayerLadder(Objective objective, bool few_blocks, const ColourCodecInfo& codec,
                         double usual_quality) {
  double nearest = 1e9;
  const auto add = [&](const Rung& rung) {
    const bool has_detail = rung.detail != kNone;
    settings_.push_back({rung.reduction, like_webp(codec, rung.base),
                         like_webp(codec, has_detail ? rung.detail : rung.base), has_detail});
    const double distance = std::abs(rung.like - usual_quality);
    if (distance > nearest) return;
    nearest = distance;
    usual_ = rungs() - 1;
  };
  if (objective == Objective::kMap) {
    for (const int quality : kMapDetail) add({kMapReduction, kMapBase, quality, quality});
  } else if (few_blocks) {
    for (const Rung& rung : kFewBlocks) add(rung);
  } else {
    for (const Rung& rung : kManyBlocks) add(rung);
  }
}

}  // namespace rprr
