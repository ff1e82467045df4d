// SPDX-License-Identifier: BSD-3-Clause
#include "colour/pgf.hpp"

#include <PGFimage.h>

#include <algorithm>
#include <exception>
#include <opencv2/core.hpp>

#include "colour/checks.hpp"
#include "colour/pgf_container.hpp"
#include "rprr_wire/bytes.hpp"

namespace rprr {
namespace {

constexpr int kBitsPerPixel = 24;
constexpr int kChannels = 3;
// As many as the image's sides allow, up to this. libpgf's own choice leaves a small image at up to
// 100 pixels a side that it codes badly: the blocks of a sparse frame would take up to three times
// the bytes.
constexpr UINT8 kLevels = 6;

// libpgf throws IOException, which is no std::exception.
template <typename T, typename Work>
Result<T> guarded(const char* what, const Work& work) {
  try {
    return work();
  } catch (const IOException& error) {
    return Error{std::string(what) + ": libpgf error " + std::to_string(error.error)};
  } catch (const std::exception& error) {
    return Error{std::string(what) + ": " + error.what()};
  }
}

Bytes encode_image(const cv::Mat& bgr, int quality) {
  PGFHeader header;
  header.width = static_cast<UINT32>(bgr.cols);
  header.height = static_cast<UINT32>(bgr.rows);
  header.nLevels = kLevels;
  header.quality = static_cast<UINT8>(quality);
  header.bpp = kBitsPerPixel;
  header.channels = kChannels;
  header.mode = ImageModeRGBColor;
  header.usedBitsPerChannel = 0;  // all

  CPGFImage image;
  image.ConfigureEncoder(false);
  image.SetHeader(header);
  // ImportBitmap only reads, though it takes a pointer to non-const.
  image.ImportBitmap(static_cast<int>(bgr.step), const_cast<UINT8*>(bgr.ptr<UINT8>()),
                     kBitsPerPixel);
  CPGFMemoryStream stream(bgr.total() * bgr.elemSize() + (1u << 16));
  image.Write(&stream);
  const UINT8* begin = stream.GetBuffer();
  return Bytes(begin, begin + stream.GetEOS());
}

// The image of a level: ceil(side / 2^level) pixels a side.
cv::Mat decode_level(Bytes& file, cv::Size expected, int level) {
  CPGFMemoryStream stream(file.data(), file.size());
  CPGFImage image;
  image.ConfigureDecoder(false);
  image.Open(&stream);
  if (image.Width() != static_cast<UINT32>(expected.width) ||
      image.Height() != static_cast<UINT32>(expected.height) || image.Mode() != ImageModeRGBColor ||
      image.BPP() != kBitsPerPixel || image.Channels() != kChannels || image.Levels() <= level) {
    throw IOException(FormatCannotRead);
  }
  image.Read(level);
  cv::Mat bgr(static_cast<int>(image.Height(level)), static_cast<int>(image.Width(level)), CV_8UC3);
  image.GetBitmap(static_cast<int>(bgr.step), bgr.ptr<UINT8>(), kBitsPerPixel);
  return bgr;
}

std::uint8_t between(int a, int b) {
  return static_cast<std::uint8_t>((a + b + 1) >> 1);
}

// Twice the resolution, as PGF's wavelet (5/3) does it where the finer level is zero: pixels stand
// at even places, what is between them is their mean.
cv::Mat doubled(const cv::Mat& coarse, cv::Size size) {
  cv::Mat fine(size, CV_8UC3);
  for (int v = 0; v < size.height; v += 2) {
    const auto* from = coarse.ptr<std::uint8_t>(v / 2);
    auto* to = fine.ptr<std::uint8_t>(v);
    for (int u = 0; u < size.width; ++u, to += kChannels) {
      const auto* left = from + kChannels * (u / 2);
      const auto* right = from + kChannels * std::min((u + 1) / 2, coarse.cols - 1);
      for (int c = 0; c < kChannels; ++c) to[c] = between(left[c], right[c]);
    }
  }
  for (int v = 1; v < size.height; v += 2) {
    const auto* above = fine.ptr<std::uint8_t>(v - 1);
    const auto* below = fine.ptr<std::uint8_t>(v + 1 < size.height ? v + 1 : v - 1);
    auto* to = fine.ptr<std::uint8_t>(v);
    for (int i = 0; i < kChannels * size.width; ++i) to[i] = between(above[i], below[i]);
  }
  return fine;
}

int level_side(int side, int level) {
  return (side + (1 << level) - 1) >> level;
}

cv::Mat decode_parts(const PgfParts& parts) {
  const cv::Size coded = pgf_coded_size(parts.size);
  Bytes file = pgf_file(parts);
  cv::Mat image = decode_level(file, coded, parts.coarse);
  for (int level = parts.coarse - 1; level >= 0; --level) {
    image = doubled(image, {level_side(coded.width, level), level_side(coded.height, level)});
  }
  return image.size() == parts.size ? image : image(cv::Rect({0, 0}, parts.size)).clone();
}

cv::Mat widened(const cv::Mat& bgr) {
  const cv::Size size = pgf_coded_size(bgr.size());
  if (size == bgr.size()) return bgr;
  cv::Mat wide;
  cv::copyMakeBorder(bgr, wide, 0, size.height - bgr.rows, 0, size.width - bgr.cols,
                     cv::BORDER_REPLICATE);
  return wide;
}

}  // namespace

Result<Bytes> PgfEncoder::encode(const cv::Mat& bgr, int quality) {
  const std::string wrong = unencodable(bgr, quality, info());
  if (!wrong.empty()) return Error{wrong};
  const Result<Bytes> file =
      guarded<Bytes>("encoding PGF", [&] { return encode_image(widened(bgr), quality); });
  if (!file) return file;
  const Result<PgfParts> parts = parse_pgf_file(*file, bgr.size());
  if (!parts) return Error{"encoding PGF: " + parts.reason()};
  return pgf_payload(*parts);
}

Result<cv::Size> pgf_payload_size(ByteView payload) {
  const Result<PgfParts> parts = parse_pgf_payload(payload);
  return parts ? Result<cv::Size>(parts->size) : Result<cv::Size>(Error{parts.reason()});
}

Result<int> pgf_payload_coarse(ByteView payload) {
  const Result<PgfParts> parts = parse_pgf_payload(payload);
  return parts ? Result<int>(parts->coarse) : Result<int>(Error{parts.reason()});
}

Result<cv::Mat> decode_pgf(ByteView payload, cv::Size expected) {
  const Result<PgfParts> parts = parse_pgf_payload(payload);
  if (!parts) return Error{parts.reason()};
  if (parts->size != expected) return Error{"colour payload is of another size than expected"};
  return guarded<cv::Mat>("decoding PGF", [&] { return decode_parts(*parts); });
}

}  // namespace rprr
