// SPDX-License-Identifier: BSD-3-Clause
#include <webp/decode.h>
#include <webp/encode.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

#include "rprr_geometry/camera.hpp"
#include "rprr_geometry/preview.hpp"
#include "rprr_geometry/range_coder.hpp"

namespace rprr {
namespace {

constexpr std::uint8_t kVersion = 1;
constexpr int kActivities = 5;
constexpr std::size_t kExponents = 17;

// What both ends know of a block's neighbours before the block itself.
struct Neighbourhood {
  int predicted = 0;  // inverse depth, steps
  int activity = 0;   // how rough it is around
  int validity = 0;   // which of W, NW, N, NE have a reading
};

Neighbourhood around(const cv::Mat& q, int column, int row) {
  const auto at = [&](int c, int r) {
    return c >= 0 && r >= 0 && c < q.cols ? int{q.at<std::uint16_t>(r, c)} : 0;
  };
  const int w = at(column - 1, row);
  const int nw = at(column - 1, row - 1);
  const int n = at(column, row - 1);
  const int ne = at(column + 1, row - 1);
  Neighbourhood out;
  out.validity = (w ? 1 : 0) | (nw ? 2 : 0) | (n ? 4 : 0) | (ne ? 8 : 0);
  if (w && n && nw) {
    out.predicted = std::clamp(w + n - nw, std::min(w, n), std::max(w, n));
  } else {
    out.predicted = w ? w : n ? n : ne ? ne : nw ? nw : at(column - 2, row);
  }
  if (out.predicted == 0) out.predicted = 100;
  int rough = 0;
  if (w && nw) rough += std::abs(w - nw);
  if (n && nw) rough += std::abs(n - nw);
  if (n && ne) rough += std::abs(n - ne);
  out.activity = rough < 2 ? 0 : rough < 5 ? 1 : rough < 12 ? 2 : rough < 40 ? 3 : 4;
  return out;
}

// Adaptive Exp-Golomb: zero or not, sign, bits of the exponent in unary, mantissa.
struct ResidualModel {
  std::array<AdaptiveBit, 16> valid;
  struct Activity {
    AdaptiveBit zero;
    AdaptiveBit sign;
    std::array<AdaptiveBit, kExponents> exponent;
    std::array<std::array<AdaptiveBit, 2>, kExponents> high;  // the mantissa's top bit
    std::array<AdaptiveBit, kExponents> low;
  };
  std::array<Activity, kActivities> activities;
};

template <typename Bit>
int code_residual(ResidualModel::Activity& model, int residual, const Bit& bit) {
  if (!bit(model.zero, residual != 0)) return 0;
  const bool negative = bit(model.sign, residual < 0);
  const unsigned magnitude = static_cast<unsigned>(std::abs(residual));  // 1 or more when encoding
  std::size_t exponent = 0;
  while (exponent + 1 < kExponents &&
         bit(model.exponent[exponent], magnitude >> (exponent + 1) != 0)) {
    ++exponent;
  }
  unsigned value = 1;
  for (std::size_t i = exponent; i > 0; --i) {
    AdaptiveBit& context = i == exponent ? model.high[exponent][0] : model.low[i];
    value = value << 1 | (bit(context, (magnitude >> (i - 1) & 1) != 0) ? 1u : 0u);
  }
  return negative ? -static_cast<int>(value) : static_cast<int>(value);
}

Bytes encode_depth(const cv::Mat& q) {
  ResidualModel model;
  RangeEncoder encoder;
  const auto bit = [&](AdaptiveBit& context, bool value) {
    encoder.put(context, value);
    return value;
  };
  for (int row = 0; row < q.rows; ++row) {
    for (int column = 0; column < q.cols; ++column) {
      const Neighbourhood n = around(q, column, row);
      const int value = q.at<std::uint16_t>(row, column);
      if (!bit(model.valid[static_cast<std::size_t>(n.validity)], value != 0)) continue;
      code_residual(model.activities[static_cast<std::size_t>(n.activity)], value - n.predicted,
                    bit);
    }
  }
  return encoder.finish();
}

bool decode_depth(ByteView bytes, cv::Mat& q) {
  ResidualModel model;
  RangeDecoder decoder(bytes);
  const auto bit = [&](AdaptiveBit& context, bool) { return decoder.get(context); };
  for (int row = 0; row < q.rows; ++row) {
    for (int column = 0; column < q.cols; ++column) {
      const Neighbourhood n = around(q, column, row);
      std::uint16_t& value = q.at<std::uint16_t>(row, column);
      if (!bit(model.valid[static_cast<std::size_t>(n.validity)], false)) continue;
      const int decoded =
          n.predicted +
          code_residual(model.activities[static_cast<std::size_t>(n.activity)], 0, bit);
      if (decoded < 1 || decoded > 65535) return false;
      value = static_cast<std::uint16_t>(decoded);
    }
  }
  return decoder.read_all();
}

Bytes encode_colour(const cv::Mat& bgr, int quality) {
  WebPConfig config;
  WebPPicture picture;
  Bytes bytes;
  if (!WebPConfigPreset(&config, WEBP_PRESET_DEFAULT, static_cast<float>(quality)) ||
      !WebPPictureInit(&picture)) {
    return bytes;
  }
  config.method = 1;
  config.segments = 1;
  picture.width = bgr.cols;
  picture.height = bgr.rows;
  WebPMemoryWriter writer;
  WebPMemoryWriterInit(&writer);
  picture.writer = WebPMemoryWrite;
  picture.custom_ptr = &writer;
  if (WebPPictureImportBGR(&picture, bgr.ptr(), static_cast<int>(bgr.step)) &&
      WebPEncode(&config, &picture)) {
    bytes.assign(writer.mem, writer.mem + writer.size);
  }
  WebPPictureFree(&picture);
  WebPMemoryWriterClear(&writer);
  return bytes;
}

bool decode_colour(ByteView bytes, cv::Mat& bgr) {
  int width = 0;
  int height = 0;
  if (!WebPGetInfo(bytes.data, bytes.size, &width, &height)) return false;
  if (width != bgr.cols || height != bgr.rows) return false;
  return WebPDecodeBGRInto(bytes.data, bytes.size, bgr.ptr(),
                           bgr.step * static_cast<std::size_t>(bgr.rows),
                           static_cast<int>(bgr.step)) != nullptr;
}

}  // namespace

Bytes encode_preview(const BlockPreview& preview, int colour_quality) {
  const Bytes depth = encode_depth(preview.inverse_depth);
  ByteWriter writer;
  writer.put(kVersion);
  writer.put(static_cast<std::uint16_t>(preview.grid.width));
  writer.put(static_cast<std::uint16_t>(preview.grid.height));
  writer.put(static_cast<float>(preview.step));
  writer.put(static_cast<std::uint8_t>(colour_quality));
  writer.put(static_cast<std::uint32_t>(depth.size()));
  writer.append(depth);
  writer.append(encode_colour(preview.bgr, colour_quality));
  Bytes bytes = writer.take();
  seal(bytes);
  return bytes;
}

Result<BlockPreview> decode_preview(ByteView bytes) {
  ByteReader reader(unseal(bytes));
  const auto version = reader.get<std::uint8_t>();
  const int width = reader.get<std::uint16_t>();
  const int height = reader.get<std::uint16_t>();
  const auto step = static_cast<double>(reader.get<float>());
  reader.get<std::uint8_t>();
  const std::size_t length = reader.get<std::uint32_t>();
  if (!reader.ok()) return Error{"preview damaged or cut short"};
  if (version != kVersion) return Error{"preview of an unknown version"};
  if (width < 1 || height < 1 || width > kMaxImageSide || height > kMaxImageSide) {
    return Error{"preview of an image of impossible size"};
  }
  if (!(step > 1e-6 && step < 1.0)) return Error{"preview with an impossible depth step"};
  const ByteView depth = reader.get_view(length);
  if (!reader.ok()) return Error{"preview with a length that does not fit"};
  BlockPreview preview;
  preview.grid = BlockGrid(width, height);
  preview.step = step;
  preview.inverse_depth = cv::Mat(preview.grid.rows, preview.grid.columns, CV_16UC1, cv::Scalar(0));
  preview.bgr.create(preview.grid.rows, preview.grid.columns, CV_8UC3);
  if (!decode_depth(depth, preview.inverse_depth)) return Error{"preview with impossible depths"};
  if (!decode_colour(reader.get_view(reader.left()), preview.bgr)) {
    return Error{"preview with colours that cannot be read"};
  }
  return preview;
}

}  // namespace rprr
