// SPDX-License-Identifier: BSD-3-Clause
#include "dhcm/values.hpp"

#include <algorithm>
#include <cmath>

#include "dhcm/huffman.hpp"

namespace rprr::dhcm {
namespace {

// Steps between sensor levels grow slowly with depth: the difference of steps is small.
template <typename Visit>
void for_each_step_change(const std::vector<std::uint16_t>& values, const Visit& visit) {
  std::uint16_t last_step = 1;
  for (std::size_t i = 1; i < values.size(); ++i) {
    const auto step = static_cast<std::uint16_t>(values[i] - values[i - 1]);
    visit(split_number(fold(static_cast<std::uint16_t>(step - last_step))));
    last_step = step;
  }
}

}  // namespace

void ValueTable::collect(const std::vector<std::uint8_t>& occurs) {
  values_.clear();
  for (std::size_t eight = 0; eight < occurs.size(); eight += 8) {
    if (load64(occurs.data() + eight) == 0) continue;  // most do not occur
    for (std::size_t value = std::max<std::size_t>(eight, 1); value < eight + 8; ++value) {
      if (occurs[value] != 0) values_.push_back(static_cast<std::uint16_t>(value));
    }
  }
}

bool ValueTable::pays(std::size_t readings) const {
  if (values_.size() < 2) return false;
  const double range = values_.back() - values_.front() + 1.0;
  const auto count = static_cast<double>(values_.size());
  // Residuals shrink by range / count; a table entry takes about 5 bits. About a third of the
  // readings are no plain repetition.
  return static_cast<double>(readings) / 3.0 * std::log2(range / count) > 5.0 * count + 200.0;
}

void ValueTable::write(BitWriter& bits) const {
  bits.put(static_cast<std::uint32_t>(values_.size()), 16);
  bits.put(values_.front(), 16);
  Histogram histogram{};
  for_each_step_change(values_, [&](const Split& split) { ++histogram[split.symbol]; });
  const CodeLengths lengths = code_lengths(histogram);
  write_lengths(lengths, bits);
  const EncodeTable table(lengths);
  for_each_step_change(values_, [&](const Split& split) {
    const EncodeTable::Word& word = table.words[split.symbol];
    bits.put(word.code, word.length);
    bits.put(split.extra, split.extra_bits);
  });
}

bool ValueTable::read(BitReader& bits) {
  const std::uint32_t count = bits.get(16);
  const std::uint32_t first = bits.get(16);
  CodeLengths lengths;
  DecodeTable table;
  if (count == 0 || first == 0 || !read_lengths(bits, lengths) || !table.build(lengths)) {
    return false;
  }
  values_.clear();
  values_.reserve(count);
  values_.push_back(static_cast<std::uint16_t>(first));
  std::uint16_t step = 1;
  while (values_.size() < count) {
    bits.refill();
    const DecodeTable::Entry entry = table.entries[bits.peek(kMaxCodeLength)];
    bits.skip(entry.length);
    if (entry.symbol >= kResidualSymbols) return false;
    const int extra_bits = extra_bits_of(entry.symbol);
    const std::uint32_t number = base_of(entry.symbol) + bits.peek(extra_bits);
    bits.skip(extra_bits);
    step = static_cast<std::uint16_t>(step + unfold(number));
    const std::uint32_t value = values_.back() + std::uint32_t{step};
    if (step == 0 || value > 65535u) return false;
    values_.push_back(static_cast<std::uint16_t>(value));
  }
  return !bits.overrun();
}

}  // namespace rprr::dhcm
