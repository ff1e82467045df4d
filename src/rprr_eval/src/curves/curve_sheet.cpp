// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <opencv2/core.hpp>

#include "rprr_eval/curves/curve_comparison.hpp"
#include "rprr_eval/report/contact_sheet.hpp"
#include "rprr_eval/report/text_table.hpp"

namespace rprr {
namespace {

constexpr int kPictureWidth = 480;

// The finest point within so many bytes; the one of least bytes if none is.
const RatePoint& within(const MethodCurve& method, std::size_t bytes) {
  const RatePoint* best = nullptr;
  for (const RatePoint& point : method.points) {
    const bool fits = point.bytes <= bytes;
    if (fits && (best == nullptr || best->bytes > bytes || point.psnr > best->psnr)) best = &point;
    if (!fits && (best == nullptr || (best->bytes > bytes && point.bytes < best->bytes))) {
      best = &point;
    }
  }
  return *best;
}

Captioned captioned(const std::string& name, const RatePoint& point) {
  return {name + ": " + std::to_string(point.bytes) + " B, " + fixed(point.psnr, 1) + " dB, SSIM " +
              fixed(point.ssim, 3),
          point.bgr};
}

std::size_t bytes_of_sheet(const MethodCurve& paper, const MethodCurve& independent) {
  const std::size_t usual = paper.at_profile ? paper.at_profile->bytes : paper.points.front().bytes;
  return std::max(usual, independent.points.front().bytes);
}

cv::Mat marked(const cv::Mat& truth, const cv::Mat& new_content) {
  cv::Mat picture = truth / 4 + cv::Scalar::all(144);
  truth.copyTo(picture, new_content);
  return picture;
}

}  // namespace

cv::Mat curve_sheet(const PairCurves& pair, const cv::Mat& truth, const std::string& codec) {
  const MethodCurve& paper = *pair.find("paper");
  const MethodCurve& independent = *pair.find(codec);
  const std::size_t bytes = bytes_of_sheet(paper, independent);
  const std::vector<Captioned> pictures = {
      {"b's own image, entry " + std::to_string(pair.b), truth},
      captioned("independent " + codec, within(independent, bytes)),
      captioned("paper", within(paper, bytes)),
      captioned("default, view", within(*pair.find("view"), bytes)),
      captioned("default, map", within(*pair.find("map"), bytes)),
      {"newly seen content, " + fixed(100.0 * pair.share_new, 0) + "% of the blocks",
       marked(truth, pair.new_content)}};
  return contact_sheet(pictures, kPictureWidth);
}

}  // namespace rprr
