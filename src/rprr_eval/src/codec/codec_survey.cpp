// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_eval/codec/codec_survey.hpp"

#include <algorithm>
#include <functional>
#include <opencv2/core.hpp>

#include "rprr_codec/dhcm.hpp"
#include "rprr_eval/codec/block_regions.hpp"
#include "rprr_eval/measure/median.hpp"
#include "rprr_eval/measure/metrics.hpp"
#include "rprr_eval/measure/processor_time.hpp"
#include "rprr_wire/bytes.hpp"
#include "rprr_wire/mask_wire.hpp"

namespace rprr {
namespace {

constexpr int kRegions = 3;

double milliseconds(const std::function<void()>& action) {
  const ProcessorTime time;
  action();
  return time.ms();
}

bool same(const cv::Mat& left, const cv::Mat& right) {
  return left.size() == right.size() && left.type() == right.type() &&
         cv::norm(left, right, cv::NORM_INF) == 0.0;
}

// One image through one codec.
struct Trip {
  double encode_ms = 0.0;
  double decode_ms = 0.0;
  double ratio = 0.0;
  bool lossless = false;
  double psnr = 99.0;
};

// Trips of a folder's images through one codec.
struct Series {
  std::vector<double> encode, decode, ratio, psnr;
  bool lossless = true;

  void add(const Trip& trip) {
    encode.push_back(trip.encode_ms);
    decode.push_back(trip.decode_ms);
    ratio.push_back(trip.ratio);
    psnr.push_back(trip.psnr);
    lossless = lossless && trip.lossless;
  }
  CodecFigures figures(const std::string& codec, const std::string& folder) const {
    CodecFigures out;
    out.codec = codec;
    out.folder = folder;
    out.frames = ratio.size();
    out.ratio = median(ratio);
    out.encode_ms = median(encode);
    out.decode_ms = median(decode);
    out.lossless = lossless && !ratio.empty();
    out.psnr = median(psnr);
    return out;
  }
};

Trip best_of(int repeats, const std::function<Trip()>& run) {
  Trip best = run();
  for (int i = 1; i < repeats; ++i) {
    const Trip again = run();
    best.encode_ms = std::min(best.encode_ms, again.encode_ms);
    best.decode_ms = std::min(best.decode_ms, again.decode_ms);
    best.lossless = best.lossless && again.lossless;
  }
  return best;
}

double ratio_of(const cv::Mat& raw, std::size_t coded) {
  return coded == 0
             ? 0.0
             : static_cast<double>(raw.total() * raw.elemSize()) / static_cast<double>(coded);
}

Trip depth_trip(DepthCodec& codec, const cv::Mat& counts) {
  Trip trip;
  Bytes coded;
  bool good = false;
  trip.encode_ms = milliseconds([&] { good = codec.encode(counts, coded); });
  if (!good) return trip;
  cv::Mat back(counts.size(), CV_16UC1, cv::Scalar(1));
  trip.decode_ms = milliseconds([&] { good = codec.decode(coded, back); });
  trip.lossless = good && same(back, counts);
  trip.ratio = ratio_of(counts, coded.size());
  return trip;
}

Trip colour_trip(ColourEncoder& encoder, int quality, ColourDecoder& decoder, const cv::Mat& bgr) {
  Trip trip;
  Result<Bytes> coded = Error{"not encoded"};
  trip.encode_ms = milliseconds([&] { coded = encoder.encode(bgr, quality); });
  if (!coded) return trip;
  Result<cv::Mat> back = Error{"not decoded"};
  trip.decode_ms = milliseconds([&] { back = decoder.decode(encoder.name(), *coded, bgr.size()); });
  trip.psnr = back ? psnr(*back, bgr).value_or(0.0) : 0.0;
  trip.lossless = back && same(*back, bgr);
  trip.ratio = ratio_of(bgr, coded->size());
  return trip;
}

std::size_t pixels_in(const BlockMask& mask) {
  std::size_t pixels = 0;
  for (int block = 0; block < mask.grid().count(); ++block) {
    if (mask[block]) pixels += static_cast<std::size_t>(mask.grid().rect(block).area());
  }
  return pixels;
}

double bits_per_pixel(const Bytes& coded, std::size_t pixels) {
  return 8.0 * static_cast<double>(coded.size()) / static_cast<double>(pixels);
}

}  // namespace

std::vector<CodecFigures> survey_depth(const std::string& folder,
                                       const std::vector<DepthFrame>& frames,
                                       const std::vector<NamedDepthCodec>& codecs, int repeats) {
  std::vector<Series> series(codecs.size());
  for (const DepthFrame& frame : frames) {
    const cv::Mat counts = frame.counts.isContinuous() ? frame.counts : frame.counts.clone();
    for (std::size_t i = 0; i < codecs.size(); ++i) {
      series[i].add(best_of(repeats, [&] { return depth_trip(*codecs[i].codec, counts); }));
    }
  }
  std::vector<CodecFigures> figures;
  for (std::size_t i = 0; i < codecs.size(); ++i) {
    figures.push_back(series[i].figures(codecs[i].name, folder));
  }
  return figures;
}

std::vector<SparseFigures> survey_sparse(const std::vector<DepthFrame>& frames, DhcmMode mode,
                                         const std::vector<double>& shares, int draws) {
  DhcmEncoder encoder(mode);
  std::vector<SparseFigures> all;
  for (const double share : shares) {
    std::vector<double> relative, bits, masks;
    std::uint32_t seed = 1;
    for (const DepthFrame& frame : frames) {
      const double dense = bits_per_pixel(encoder.encode(frame), frame.counts.total());
      for (int draw = 0; draw < draws; ++draw) {
        const BlockGrid grid(frame.width(), frame.height());
        const BlockMask mask = random_regions(grid, share, kRegions, seed++);
        bits.push_back(bits_per_pixel(encoder.encode(frame, mask), pixels_in(mask)));
        relative.push_back(bits.back() / dense);
        masks.push_back(static_cast<double>(encode_mask(mask).size()));
      }
    }
    all.push_back({share, median(relative), median(bits), median(masks)});
  }
  return all;
}

CodecFigures survey_colour(const std::string& folder, const std::vector<cv::Mat>& images,
                           ColourEncoder& encoder, int quality, ColourDecoder& decoder,
                           int repeats) {
  Series series;
  for (const cv::Mat& bgr : images) {
    series.add(best_of(repeats, [&] { return colour_trip(encoder, quality, decoder, bgr); }));
  }
  CodecFigures figures = series.figures(encoder.name(), folder);
  figures.colour = true;
  return figures;
}

}  // namespace rprr
