// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_geometry/block_mask.hpp"

#include <algorithm>
#include <array>
#include <numeric>

#include "rprr_geometry/camera.hpp"

namespace rprr {
namespace {

constexpr std::uint8_t kVersion = 1;
enum Mode : std::uint8_t { kNone = 0, kAll = 1, kCoded = 2 };

// Adaptive binary range coder: 12-bit probabilities of a zero, moved by 1/16 of their error.
constexpr int kProbabilityBits = 12;
constexpr std::uint32_t kTop = 1u << 24;

struct Contexts {
  std::array<std::uint16_t, 16> zero;
  Contexts() { zero.fill(1u << (kProbabilityBits - 1)); }
  void update(int context, bool bit) {
    std::uint16_t& p = zero[static_cast<std::size_t>(context)];
    if (bit) {
      p = static_cast<std::uint16_t>(p - (p >> 4));
    } else {
      p = static_cast<std::uint16_t>(p + (((1 << kProbabilityBits) - p) >> 4));
    }
    p = std::clamp<std::uint16_t>(p, 32, (1u << kProbabilityBits) - 32);
  }
  std::uint32_t split(int context, std::uint32_t range) const {
    return (range >> kProbabilityBits) * zero[static_cast<std::size_t>(context)];
  }
};

class RangeEncoder {
 public:
  void put(Contexts& contexts, int context, bool bit) {
    const std::uint32_t split = contexts.split(context, range_);
    if (bit) {
      low_ += split;
      range_ -= split;
    } else {
      range_ = split;
    }
    contexts.update(context, bit);
    while (range_ < kTop) {
      range_ <<= 8;
      shift_low();
    }
  }
  Bytes finish() {
    for (int i = 0; i < 5; ++i) shift_low();
    out_.erase(out_.begin());  // the first byte is always 0
    while (!out_.empty() && out_.back() == 0) out_.pop_back();
    return std::move(out_);
  }

 private:
  void shift_low() {
    if (static_cast<std::uint32_t>(low_) < 0xFF000000u || (low_ >> 32) != 0) {
      const auto carry = static_cast<std::uint8_t>(low_ >> 32);
      out_.push_back(static_cast<std::uint8_t>(cache_ + carry));
      for (; pending_ > 0; --pending_) out_.push_back(static_cast<std::uint8_t>(0xFF + carry));
      cache_ = static_cast<std::uint8_t>(low_ >> 24);
    } else {
      ++pending_;
    }
    low_ = (low_ & 0x00FFFFFFu) << 8;
  }

  std::uint64_t low_ = 0;
  std::uint32_t range_ = 0xFFFFFFFFu;
  std::uint8_t cache_ = 0;
  std::size_t pending_ = 0;
  Bytes out_;
};

class RangeDecoder {
 public:
  explicit RangeDecoder(ByteView bytes) : bytes_(bytes) {
    for (int i = 0; i < 4; ++i) code_ = code_ << 8 | next();
  }
  bool get(Contexts& contexts, int context) {
    const std::uint32_t split = contexts.split(context, range_);
    const bool bit = code_ >= split;
    if (bit) {
      code_ -= split;
      range_ -= split;
    } else {
      range_ = split;
    }
    contexts.update(context, bit);
    while (range_ < kTop) {
      range_ <<= 8;
      code_ = code_ << 8 | next();
    }
    return bit;
  }
  bool read_all() const { return at_ >= bytes_.size; }

 private:
  std::uint32_t next() { return at_ < bytes_.size ? bytes_.data[at_++] : 0u; }  // zeros are trimmed

  ByteView bytes_;
  std::size_t at_ = 0;
  std::uint32_t code_ = 0;
  std::uint32_t range_ = 0xFFFFFFFFu;
};

// Visits blocks in row order with the context that both ends know by then.
template <typename Visit>
void for_each_with_context(const BlockGrid& grid, const BlockMask& mask, const Visit& visit) {
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      const auto bit = [&](int dc, int dr) {
        const int c = column + dc;
        const int r = row + dr;
        return c >= 0 && r >= 0 && c < grid.columns && mask[grid.index(c, r)] ? 1 : 0;
      };
      const int context = bit(-1, 0) | bit(-1, -1) << 1 | bit(0, -1) << 2 | bit(1, -1) << 3;
      visit(grid.index(column, row), context);
    }
  }
}

}  // namespace

int BlockMask::count() const {
  return std::accumulate(bits_.begin(), bits_.end(), 0);
}

BlockMask& BlockMask::operator|=(const BlockMask& other) {
  for (std::size_t i = 0; i < std::min(bits_.size(), other.bits_.size()); ++i) {
    bits_[i] |= other.bits_[i];
  }
  return *this;
}

bool BlockMask::operator==(const BlockMask& other) const {
  return grid_.width == other.grid_.width && grid_.height == other.grid_.height &&
         bits_ == other.bits_;
}

cv::Mat BlockMask::to_image() const {
  cv::Mat image(grid_.height, grid_.width, CV_8UC1, cv::Scalar(0));
  for (int block = 0; block < grid_.count(); ++block) {
    if ((*this)[block]) image(grid_.rect(block)).setTo(255);
  }
  return image;
}

Bytes encode_mask(const BlockMask& mask) {
  const BlockGrid& grid = mask.grid();
  const int set = mask.count();
  const Mode mode = set == 0 ? kNone : set == grid.count() ? kAll : kCoded;
  ByteWriter writer;
  writer.put(kVersion);
  writer.put(static_cast<std::uint16_t>(grid.width));
  writer.put(static_cast<std::uint16_t>(grid.height));
  writer.put(static_cast<std::uint8_t>(mode));
  if (mode == kCoded) {
    Contexts contexts;
    RangeEncoder encoder;
    for_each_with_context(
        grid, mask, [&](int block, int context) { encoder.put(contexts, context, mask[block]); });
    writer.append(encoder.finish());
  }
  Bytes bytes = writer.take();
  seal(bytes);
  return bytes;
}

Result<BlockMask> decode_mask(ByteView bytes, const BlockGrid& expected) {
  ByteReader reader(unseal(bytes));
  const auto version = reader.get<std::uint8_t>();
  const int width = reader.get<std::uint16_t>();
  const int height = reader.get<std::uint16_t>();
  const auto mode = reader.get<std::uint8_t>();
  if (!reader.ok()) return Error{"block mask damaged or cut short"};
  if (version != kVersion) return Error{"block mask of an unknown version"};
  if (width != expected.width || height != expected.height) {
    return Error{"block mask for an image of another size"};
  }
  if (mode > kCoded || (mode != kCoded && reader.left() != 0)) {
    return Error{"block mask in an unknown mode"};
  }
  BlockMask mask(expected, mode == kAll);
  if (mode == kCoded) {
    Contexts contexts;
    RangeDecoder decoder(reader.get_view(reader.left()));
    for_each_with_context(expected, mask, [&](int block, int context) {
      mask.set(block, decoder.get(contexts, context));
    });
    if (!decoder.read_all()) return Error{"block mask with bytes left over"};
  }
  return mask;
}

}  // namespace rprr
