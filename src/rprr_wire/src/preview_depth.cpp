// SPDX-License-Identifier: BSD-3-Clause
#include "preview_depth.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <opencv2/core.hpp>
#include <vector>

#include "mixed_bit.hpp"
#include "rprr_wire/bytes.hpp"
#include "rprr_wire/range_coder.hpp"

namespace rprr {
namespace {

constexpr int kUnary = 3;                 // magnitudes up to this are coded bit by bit in contexts
constexpr std::size_t kExponents = 17;    // of what magnitudes have beyond that
constexpr int kFirstGuess = 100;          // where no neighbour has a reading
constexpr std::size_t kBlocksAValue = 4;  // that a table of the values needs to pay

// Where the bits go to or come from; either way the result is the bit that was meant.
class Writer {
 public:
  bool bit(int one, bool value) {
    encoder_.put(static_cast<std::uint32_t>(65536 - one), value);
    return value;
  }
  Bytes finish() { return encoder_.finish(); }

 private:
  RangeEncoder encoder_;
};

class Reader {
 public:
  explicit Reader(ByteView bytes) : decoder_(bytes) {}
  bool bit(int one, bool) { return decoder_.get(static_cast<std::uint32_t>(65536 - one)); }
  bool read_all() const { return decoder_.read_all(); }

 private:
  RangeDecoder decoder_;
};

template <typename Io>
bool code_bit(Io& io, BitEstimate& estimate, bool value) {
  const bool bit = io.bit(std::clamp(estimate.one(), 64, 65536 - 64), value);
  estimate.update(bit);
  return bit;
}

template <typename Io, std::size_t N>
bool code_bit(Io& io, BitMixer<N>& mixer, const std::array<BitEstimate*, N>& contexts, bool value) {
  const bool bit = io.bit(mixer.mix(contexts), value);
  mixer.update(contexts, bit);
  return bit;
}

// Exponent in unary, then the mantissa, of which the top bit is learnt.
struct LongNumbers {
  std::array<BitEstimate, kExponents> more;
  std::array<BitEstimate, kExponents> top;

  // 1 to 2^17 - 1; value counts in a Writer only.
  template <typename Io>
  int code(Io& io, unsigned value) {
    std::size_t exponent = 0;
    while (exponent + 1 < kExponents &&
           code_bit(io, more[exponent], value >> (exponent + 1) != 0)) {
      ++exponent;
    }
    unsigned out = 1;
    for (std::size_t i = exponent; i > 0; --i) {
      const bool wanted = (value >> (i - 1) & 1u) != 0;
      const bool bit = i == exponent ? code_bit(io, top[exponent], wanted) : io.bit(32768, wanted);
      out = out << 1 | (bit ? 1u : 0u);
    }
    return static_cast<int>(out);
  }
};

constexpr std::array<std::uint8_t, 91> size_classes() {
  constexpr int limits[] = {1, 2, 3, 5, 8, 13, 22, 40, 90};
  std::array<std::uint8_t, 91> classes{};
  std::uint8_t size = 0;
  for (int i = 0; i < 91; ++i) {
    while (size < 9 && i >= limits[size]) ++size;
    classes[static_cast<std::size_t>(i)] = size;
  }
  return classes;
}

// 0 to 9, by size.
int size_class(int magnitude) {
  static constexpr auto classes = size_classes();
  return classes[static_cast<std::size_t>(std::min(magnitude, 90))];
}

// 0 to 2 * most.
int clipped(int value, int most) {
  return std::clamp(value, -most, most) + most;
}

int sign_class(int value) {
  return value > 0 ? 2 : value < 0 ? 1 : 0;
}

// What both ends know of a block from those before it. Values: 0 = no reading.
struct Neighbourhood {
  int w, ww, n, nw, ne;                      // values
  int error_w, error_n, error_nw, error_ne;  // what their predictions were off by
};

// What follows from it: a prediction, and contexts that say how far and which way it may be off.
struct Contexts {
  int predicted;
  int roughness;            // 0 to 4, of the neighbours
  std::array<int, 4> size;  // for whether and how far the prediction is off
  std::array<int, 4> sign;  // for which way
};

constexpr std::array<std::size_t, 4> kSizeContexts = {250, 10, 50, 97};
constexpr std::array<std::size_t, 4> kSignContexts = {250, 90, 81, 97};

Contexts contexts_of(const Neighbourhood& at) {
  Contexts out{};
  const int w = at.w, n = at.n, nw = at.nw, ne = at.ne;
  const bool corner = w != 0 && n != 0 && nw != 0;
  out.predicted = corner       ? std::clamp(w + n - nw, std::min(w, n), std::max(w, n))
                  : w != 0     ? w
                  : n != 0     ? n
                  : ne != 0    ? ne
                  : nw != 0    ? nw
                  : at.ww != 0 ? at.ww
                               : kFirstGuess;
  int rough = 0;
  if (w != 0 && nw != 0) rough += std::abs(w - nw);
  if (n != 0 && nw != 0) rough += std::abs(n - nw);
  if (n != 0 && ne != 0) rough += std::abs(n - ne);
  out.roughness = rough < 2 ? 0 : rough < 5 ? 1 : rough < 12 ? 2 : rough < 40 ? 3 : 4;

  // Other predictions, less this one: smooth (times 4), of a plane, of the row above's slope.
  const auto off = [&](int value) { return value != 0 ? value - out.predicted : 0; };
  const int smooth = 2 * (off(w) + off(n)) + off(ne) - off(nw);
  const int plane = off(w) + off(n) - off(nw);
  const int slope = off(w) + off(ne) - off(n);
  const int lean = smooth + 2 * plane + 2 * slope;
  const int lean_class = lean > 8    ? 8
                         : lean > 3  ? 7
                         : lean > 0  ? 6
                         : lean < -8 ? 0
                         : lean < -3 ? 1
                         : lean < 0  ? 2
                                     : 4;
  const int spread = size_class(std::abs(smooth) / 2 + std::abs(plane));
  const int errors = 2 * std::abs(at.error_w) + 2 * std::abs(at.error_n) + std::abs(at.error_nw) +
                     std::abs(at.error_ne);
  const int error = size_class((errors + 1) / 2);
  const int error_signs = sign_class(at.error_w) + 3 * sign_class(at.error_n);
  const int mask = (w != 0 ? 1 : 0) | (n != 0 ? 2 : 0) | (nw != 0 ? 4 : 0) | (ne != 0 ? 8 : 0);
  const int shape = corner ? clipped(w - nw, 4) * 9 + clipped(n - nw, 4) : 81 + mask;
  const int leaning = clipped(lean, 12) * 10 + size_class(rough);
  out.size = {leaning, error, out.roughness * 10 + spread, shape};
  out.sign = {leaning, lean_class * 10 + error, lean_class * 9 + error_signs, shape};
  return out;
}

class DepthModel {
 public:
  DepthModel() {
    for (std::size_t i = 0; i < 4; ++i) {
      sizes_[i].resize(kSizeContexts[i]);
      signs_[i].resize(kSignContexts[i]);
    }
  }

  template <typename Io>
  bool code_valid(Io& io, const Neighbourhood& at, bool valid) {
    const std::size_t mask = (at.w != 0 ? 1u : 0u) | (at.n != 0 ? 2u : 0u) |
                             (at.nw != 0 ? 4u : 0u) | (at.ne != 0 ? 8u : 0u);
    return code_bit(io, valid_[mask], valid);
  }

  /// What the prediction is off by.
  template <typename Io>
  int code_error(Io& io, const Contexts& contexts, int error) {
    const int wanted = std::abs(error);
    int magnitude = 0;
    while (magnitude <= kUnary) {
      const auto step = static_cast<std::size_t>(magnitude);
      std::array<BitEstimate*, 4> at{};
      for (std::size_t i = 0; i < 4; ++i) {
        at[i] = &sizes_[i][static_cast<std::size_t>(contexts.size[i])][step];
      }
      if (!code_bit(io, size_mixers_[step], at, wanted > magnitude)) break;
      ++magnitude;
    }
    if (magnitude == 0) return 0;
    std::array<BitEstimate*, 4> at{};
    for (std::size_t i = 0; i < 4; ++i) {
      at[i] = &signs_[i][static_cast<std::size_t>(contexts.sign[i])];
    }
    const bool negative = code_bit(io, sign_mixer_, at, error < 0);
    if (magnitude > kUnary) {
      LongNumbers& numbers = long_[static_cast<std::size_t>(contexts.roughness)];
      magnitude = kUnary + numbers.code(io, static_cast<unsigned>(wanted - kUnary));
    }
    return negative ? -magnitude : magnitude;
  }

 private:
  using Steps = std::array<BitEstimate, kUnary + 1>;

  std::array<BitEstimate, 16> valid_;
  std::array<std::vector<Steps>, 4> sizes_;
  std::array<BitMixer<4>, kUnary + 1> size_mixers_;
  std::array<std::vector<BitEstimate>, 4> signs_;
  BitMixer<4> sign_mixer_;
  std::array<LongNumbers, 5> long_;
};

// Goes over an image of values 1 to most, 0 = no reading. False if a decoded value is none of them.
template <typename Io>
bool code_image(Io& io, int most, cv::Mat& image) {
  constexpr std::size_t kLeft =
      2;  // columns without readings around the image, and one right of it
  const std::size_t stride = static_cast<std::size_t>(image.cols) + kLeft + 1;
  std::vector<int> values((static_cast<std::size_t>(image.rows) + 1) * stride, 0);
  std::vector<int> errors(values.size(), 0);
  DepthModel model;
  for (int row = 0; row < image.rows; ++row) {
    auto* pixels = image.ptr<std::uint16_t>(row);
    const std::size_t first = (static_cast<std::size_t>(row) + 1) * stride + kLeft;
    for (std::size_t column = 0; column < static_cast<std::size_t>(image.cols); ++column) {
      const std::size_t i = first + column;
      const int* value = values.data() + i;
      const int* above = value - stride;
      const int* error = errors.data() + i;
      const int* error_above = error - stride;
      const Neighbourhood at = {value[-1], value[-2],      above[0],        above[-1],     above[1],
                                error[-1], error_above[0], error_above[-1], error_above[1]};
      if (!model.code_valid(io, at, pixels[column] != 0)) {
        pixels[column] = 0;
        errors[i] = error[-1] / 2;
        continue;
      }
      const Contexts contexts = contexts_of(at);
      errors[i] = model.code_error(io, contexts, pixels[column] - contexts.predicted);
      values[i] = contexts.predicted + errors[i];
      if (values[i] < 1 || values[i] > most) return false;
      pixels[column] = static_cast<std::uint16_t>(values[i]);
    }
  }
  return true;
}

std::vector<std::uint16_t> distinct_values(const cv::Mat& depth) {
  std::vector<bool> occurs(65536, false);
  for (int row = 0; row < depth.rows; ++row) {
    const auto* pixels = depth.ptr<std::uint16_t>(row);
    for (int column = 0; column < depth.cols; ++column) occurs[pixels[column]] = true;
  }
  std::vector<std::uint16_t> values;
  for (std::size_t value = 1; value < occurs.size(); ++value) {
    if (occurs[value]) values.push_back(static_cast<std::uint16_t>(value));
  }
  return values;
}

// Ascending, as the gaps between them. False if decoded values leave 16 bits, or are too many.
template <typename Io>
bool code_table(Io& io, std::size_t most, std::vector<std::uint16_t>& table) {
  LongNumbers numbers;
  const int count = LongNumbers().code(io, static_cast<unsigned>(table.size()) + 1) - 1;
  if (count < 0 || static_cast<std::size_t>(count) > most) return false;
  table.resize(static_cast<std::size_t>(count));
  int last = 0;
  for (std::uint16_t& value : table) {
    last += numbers.code(io, static_cast<unsigned>(value - last));
    if (last > 65535) return false;
    value = static_cast<std::uint16_t>(last);
  }
  return true;
}

}  // namespace

bool ranks_pay(const cv::Mat& depth) {
  return distinct_values(depth).size() * kBlocksAValue <=
         static_cast<std::size_t>(cv::countNonZero(depth));
}

Bytes encode_preview_depth(const cv::Mat& depth, bool ranks) {
  Writer writer;
  cv::Mat image = depth.clone();
  int most = 65535;
  if (ranks) {
    std::vector<std::uint16_t> table = distinct_values(depth);
    code_table(writer, table.size(), table);
    std::vector<std::uint16_t> rank_of(65536, 0);
    for (std::size_t i = 0; i < table.size(); ++i) {
      rank_of[table[i]] = static_cast<std::uint16_t>(i + 1);
    }
    std::for_each(image.begin<std::uint16_t>(), image.end<std::uint16_t>(),
                  [&](std::uint16_t& value) { value = rank_of[value]; });
    most = static_cast<int>(table.size());
  }
  code_image(writer, most, image);
  return writer.finish();
}

bool decode_preview_depth(ByteView bytes, bool ranks, cv::Mat& depth) {
  Reader reader(bytes);
  int most = 65535;
  std::vector<std::uint16_t> table;
  if (ranks) {
    if (!code_table(reader, depth.total(), table)) return false;
    most = static_cast<int>(table.size());
  }
  if (!code_image(reader, most, depth) || !reader.read_all()) return false;
  if (ranks) {
    std::for_each(depth.begin<std::uint16_t>(), depth.end<std::uint16_t>(),
                  [&](std::uint16_t& value) {
                    if (value != 0) value = table[value - 1u];
                  });
  }
  return true;
}

}  // namespace rprr
