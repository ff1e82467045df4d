// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_codec/colour_layers.hpp"
#include "rprr_geometry/block_mask.hpp"
#include "rprr_wire/bytes.hpp"

#include <algorithm>
#include <opencv2/core.hpp>
#include <utility>

namespace rprr {
namespace {

constexpr int kChannels = 3;

// Which power of two.
std::size_t halvings(int reduction) {
  std::size_t count = 0;
  while (1 << count < reduction) ++count;
  return count;
}

// Mean of one cell, clipped to the image.
cv::Vec3b mean_of(const cv::Mat& bgr, const cv::Rect& cell) {
  std::array<int, kChannels> sum = {};
  for (int v = cell.y; v < cell.y + cell.height; ++v) {
    const auto* row = bgr.ptr<std::uint8_t>(v) + kChannels * cell.x;
    for (int i = 0; i < kChannels * cell.width; i += kChannels) {
      for (std::size_t c = 0; c < kChannels; ++c) sum[c] += row[static_cast<std::size_t>(i) + c];
    }
  }
  const int area = std::max(cell.area(), 1);
  const auto mean = [&](std::size_t c) {
    return static_cast<std::uint8_t>((sum[c] + area / 2) / area);
  };
  return {mean(0), mean(1), mean(2)};
}

}  // namespace

cv::Size base_size(cv::Size image, int reduction) {
  return {(image.width + reduction - 1) / reduction, (image.height + reduction - 1) / reduction};
}

void reduce_image(const cv::Mat& bgr, int reduction, cv::Mat& reduced) {
  reduced.create(base_size(bgr.size(), reduction), CV_8UC3);
  if (reduction == 1) {
    bgr.copyTo(reduced);
    return;
  }
  const cv::Rect whole({0, 0}, bgr.size());
  for (int v = 0; v < reduced.rows; ++v) {
    auto* row = reduced.ptr<cv::Vec3b>(v);
    for (int u = 0; u < reduced.cols; ++u) {
      row[u] = mean_of(bgr, cv::Rect(u * reduction, v * reduction, reduction, reduction) & whole);
    }
  }
}

void enlarge_row(const cv::Mat& base, int reduction, int row, cv::Mat& out) {
  const auto place = [reduction](int pixel, int count) {
    const float at = (static_cast<float>(pixel) + 0.5f) / static_cast<float>(reduction) - 0.5f;
    return std::clamp(at, 0.0f, static_cast<float>(count - 1));
  };
  const float y = place(row, base.rows);
  const int top = static_cast<int>(y);
  const float down = y - static_cast<float>(top);
  const auto* upper = base.ptr<std::uint8_t>(top);
  const auto* lower = base.ptr<std::uint8_t>(std::min(top + 1, base.rows - 1));
  auto* to = out.ptr<std::uint8_t>();
  for (int u = 0; u < out.cols; ++u) {
    const float x = place(u, base.cols);
    const int left = kChannels * static_cast<int>(x);
    const int right = std::min(left + kChannels, kChannels * (base.cols - 1));
    const float across = x - static_cast<float>(static_cast<int>(x));
    for (int c = 0; c < kChannels; ++c) {
      const auto mix = [&](const std::uint8_t* line) {
        const auto near = static_cast<float>(line[left + c]);
        return near + across * (static_cast<float>(line[right + c]) - near);
      };
      const float above = mix(upper);
      to[kChannels * u + c] = static_cast<std::uint8_t>(above + down * (mix(lower) - above) + 0.5f);
    }
  }
}

Result<ColourLayers> ColourLayers::create(const std::string& codec, UnsentFill fill) {
  Result<std::unique_ptr<ColourEncoder>> encoder = make_colour_encoder(codec);
  if (!encoder) return Error{encoder.reason()};
  return ColourLayers(std::move(*encoder), fill);
}

ColourLayers::ColourLayers(std::unique_ptr<ColourEncoder> codec, UnsentFill fill)
    : codec_(std::move(codec)), fill_(fill) {
}

void ColourLayers::prepare(const cv::Mat& bgr, const BlockMask* sent) {
  bgr_ = bgr;
  detail_.ready = false;
  for (Prepared& base : bases_) base.ready = false;
  layout_ = ColourLayout::kInPlace;
  sent_.reset();
  compact_.reset();
  if (sent == nullptr) return;
  sent_ = *sent;
  choose_layout();
  unsent_ = BlockMask(sent->grid());
  for (int block = 0; block < sent->grid().count(); ++block) unsent_.set(block, !(*sent)[block]);
}

void ColourLayers::choose_layout() {
  if (fill_ == UnsentFill::kBlack) return;
  compact_.emplace(*sent_);
  const int columns = compact_->used().grid().columns;
  const int rows = compact_->used().grid().rows;
  if (columns * rows < sent_->grid().count()) layout_ = ColourLayout::kCompact;
}

void ColourLayers::fill(cv::Mat& bgr, const BlockMask& known, int reduction, bool flat) {
  if (fill_ == UnsentFill::kSmooth) {
    smooth_.fill_in_place(bgr, known, reduction, flat);
  } else {
    black_out(bgr, known, reduction);
  }
}

const cv::Mat& ColourLayers::detail() {
  if (!sent_) return bgr_;
  if (detail_.ready) return detail_.image;
  const bool flat = codec_->prefers_flat_blocks();
  if (layout_ == ColourLayout::kCompact) {
    compact_->gather(bgr_, detail_.image);
    fill(detail_.image, compact_->used(), 1, flat);
  } else {
    bgr_.copyTo(detail_.image);
    fill(detail_.image, *sent_, 1, flat);
  }
  detail_.ready = true;
  return detail_.image;
}

const cv::Mat& ColourLayers::base(int reduction, bool with_detail) {
  Prepared& base = bases_[2 * halvings(reduction) + (with_detail ? 1 : 0)];
  if (base.ready) return base.image;
  reduce_image(bgr_, reduction, base.image);
  if (with_detail && sent_ && reduction <= kBlockSide) {
    // Blocks of a reduced image are smaller than the codec's. A cell of 16 pixels is four blocks:
    // too few to be worth it.
    fill(base.image, unsent_, reduction, reduction == 1 && codec_->prefers_flat_blocks());
  }
  base.ready = true;
  return base.image;
}

Result<Bytes> ColourLayers::encode_detail(int quality) {
  if (sent_ && sent_->count() == 0) return Error{"no block's colour is to be sent"};
  return codec_->encode(detail(), quality);
}

Result<Bytes> ColourLayers::encode_base(int reduction, int quality, bool with_detail) {
  if (!is_base_reduction(reduction)) {
    return Error{"the base is reduced " + std::to_string(reduction) +
                 " times, must be 1, 2, 4, 8, 16"};
  }
  return codec_->encode(base(reduction, with_detail), quality);
}

Result<Bytes> ColourLayers::encode_whole(int quality) {
  return codec_->encode(bgr_, quality);
}

}  // namespace rprr
