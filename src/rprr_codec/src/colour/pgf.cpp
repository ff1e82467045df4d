// SPDX-License-Identifier: BSD-3-Clause
#include "colour/pgf.hpp"

#include <PGFimage.h>

#include <algorithm>
#include <exception>
#include <opencv2/core.hpp>

#include "colour/checks.hpp"

namespace rprr {
namespace {

constexpr std::uint8_t kVersion = 1;
constexpr int kBitsPerPixel = 24;
// libpgf leaks where an image is too small for a wavelet level: smaller images are widened to this.
constexpr int kMinSide = 16;

cv::Size coded_size(cv::Size size) {
  return {std::max(size.width, kMinSide), std::max(size.height, kMinSide)};
}

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
  header.nLevels = 0;  // libpgf chooses
  header.quality = static_cast<UINT8>(quality);
  header.bpp = kBitsPerPixel;
  header.channels = 3;
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

cv::Mat decode_image(ByteView pgf, cv::Size expected) {
  // The stream only reads, though it takes a pointer to non-const.
  CPGFMemoryStream stream(const_cast<UINT8*>(pgf.data), pgf.size);
  CPGFImage image;
  image.ConfigureDecoder(false);
  image.Open(&stream);
  if (image.Width() != static_cast<UINT32>(expected.width) ||
      image.Height() != static_cast<UINT32>(expected.height) || image.Mode() != ImageModeRGBColor ||
      image.BPP() != kBitsPerPixel || image.Channels() != 3) {
    throw IOException(FormatCannotRead);
  }
  image.Read();
  cv::Mat bgr(expected, CV_8UC3);
  image.GetBitmap(static_cast<int>(bgr.step), bgr.ptr<UINT8>(), kBitsPerPixel);
  return bgr;
}

// Reads what stands before the PGF bytes: the size of the image.
Result<cv::Size> open_container(ByteReader& reader) {
  const auto version = reader.get<std::uint8_t>();
  reader.get<std::uint8_t>();  // quality: stands in the PGF header as well
  const int width = reader.get<std::uint16_t>();
  const int height = reader.get<std::uint16_t>();
  if (!reader.ok()) return Error{"colour payload damaged or cut short"};
  if (version != kVersion) return Error{"colour payload of an unknown version"};
  return possible_size(width, height);
}

cv::Mat widened(const cv::Mat& bgr) {
  const cv::Size size = coded_size(bgr.size());
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
  Result<Bytes> pgf =
      guarded<Bytes>("encoding PGF", [&] { return encode_image(widened(bgr), quality); });
  if (!pgf) return pgf;
  ByteWriter writer;
  writer.bytes().reserve(pgf->size() + 10);
  writer.put(kVersion);
  writer.put(static_cast<std::uint8_t>(quality));
  writer.put(static_cast<std::uint16_t>(bgr.cols));
  writer.put(static_cast<std::uint16_t>(bgr.rows));
  writer.append(*pgf);
  Bytes payload = writer.take();
  seal(payload);
  return payload;
}

Result<cv::Size> pgf_payload_size(ByteView payload) {
  ByteReader reader(unseal(payload));
  return open_container(reader);
}

Result<cv::Mat> decode_pgf(ByteView payload, cv::Size expected) {
  ByteReader reader(unseal(payload));
  const Result<cv::Size> size = open_container(reader);
  if (!size) return Error{size.reason()};
  if (*size != expected) return Error{"colour payload is of another size than expected"};
  const ByteView pgf = reader.get_view(reader.left());
  return guarded<cv::Mat>("decoding PGF", [&] {
    const cv::Mat image = decode_image(pgf, coded_size(expected));
    return image.size() == expected ? image : image(cv::Rect({0, 0}, expected)).clone();
  });
}

}  // namespace rprr
