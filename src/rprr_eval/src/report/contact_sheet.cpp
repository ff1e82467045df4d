// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_eval/report/contact_sheet.hpp"

#include <opencv2/imgproc.hpp>

namespace rprr {
namespace {

constexpr int kCaption = 30;  // [px]
constexpr int kGap = 6;
constexpr int kColumns = 2;

}  // namespace

cv::Mat contact_sheet(const std::vector<Captioned>& pictures, int width) {
  int height = width * 3 / 4;
  for (const Captioned& picture : pictures) {
    if (!picture.bgr.empty()) {
      height = picture.bgr.rows * width / picture.bgr.cols;
      break;
    }
  }
  const int rows = (static_cast<int>(pictures.size()) + kColumns - 1) / kColumns;
  cv::Mat sheet(rows * (height + kCaption + kGap) + kGap, kColumns * (width + kGap) + kGap, CV_8UC3,
                cv::Scalar::all(255));
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    const int x = kGap + static_cast<int>(i % kColumns) * (width + kGap);
    const int y = kGap + static_cast<int>(i / kColumns) * (height + kCaption + kGap);
    cv::putText(sheet, pictures[i].caption, {x + 2, y + kCaption - 9}, cv::FONT_HERSHEY_SIMPLEX,
                0.55, cv::Scalar::all(20), 1, cv::LINE_AA);
    cv::Mat place = sheet(cv::Rect(x, y + kCaption, width, height));
    if (pictures[i].bgr.empty()) {
      place.setTo(cv::Scalar::all(190));
    } else {
      cv::resize(pictures[i].bgr, place, place.size(), 0, 0, cv::INTER_AREA);
    }
  }
  return sheet;
}

}  // namespace rprr
