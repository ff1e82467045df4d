// SPDX-License-Identifier: BSD-3-Clause
#include <array>

#include "dhcm/container.hpp"
#include "dhcm/scan.hpp"
#include "dhcm/tables.hpp"
#include "dhcm/values.hpp"
#include "rprr_codec/dhcm.hpp"

namespace rprr {
namespace dhcm {

// A symbol in one of the tables and the plain bits behind it.
struct Token {
  std::uint8_t table;
  std::uint8_t symbol;
  std::uint16_t extra;
};

namespace {

// First pass: pixels become tokens, and the tokens of each table are counted.
class TokenCoder {
 public:
  TokenCoder(std::vector<Token>& tokens, Histograms& histograms)
      : tokens_(tokens), histograms_(histograms) {
    tokens_.clear();
    for (auto& histogram : histograms_) histogram.fill(0);
  }

  /// Ranks (or readings) of the row that is scanned next; 0 = no reading.
  void begin_row(const std::uint16_t* ranks) { ranks_ = ranks; }

  int run(int context, int guess, int u) {
    Run& run = runs_[static_cast<std::size_t>(context)];
    if (run.token == kNone) {
      run.token = tokens_.size();
      run.length = 0;
      tokens_.push_back({static_cast<std::uint8_t>(kRunTables + context), 0, 0});
    }
    const int value = at(u);
    if (value == (context == kInHole ? kNoReading : guess)) {
      if (++run.length == kRunLimit) end_run(run);
      return value;
    }
    end_run(run);
    return pixel(context, guess, u);
  }

  int pixel(int context, int guess, int u) {
    const int value = at(u);
    if (value == kNoReading) {
      add(context, {kHoleSymbol, 0, 0});
    } else {
      add(context, split_number(fold(static_cast<std::uint16_t>(value - guess))));
    }
    return value;
  }

  void end() {
    for (Run& run : runs_) {
      if (run.token != kNone) end_run(run);
    }
  }

 private:
  static constexpr std::size_t kNone = ~std::size_t{0};
  struct Run {
    std::size_t token = kNone;  // where its length will stand
    std::uint32_t length = 0;
  };

  int at(int u) const { return ranks_[u] == 0 ? kNoReading : ranks_[u]; }
  void add(int table, const Split& split) {
    tokens_.push_back({static_cast<std::uint8_t>(table), split.symbol, split.extra});
    ++histograms_[static_cast<std::size_t>(table)][split.symbol];
  }
  void end_run(Run& run) {
    const Split split = split_number(run.length);
    Token& token = tokens_[run.token];
    token.symbol = split.symbol;
    token.extra = split.extra;
    ++histograms_[token.table][split.symbol];
    run.token = kNone;
  }

  std::vector<Token>& tokens_;
  Histograms& histograms_;
  std::array<Run, kRunContexts> runs_;
  const std::uint16_t* ranks_ = nullptr;
};

// Second pass.
void write_tokens(const std::vector<Token>& tokens, const EncodeTables& tables, BitWriter& bits) {
  for (const Token& token : tokens) {
    const EncodeTable::Word& word = tables[token.table].words[token.symbol];
    bits.put(word.code | static_cast<std::uint32_t>(token.extra) << word.length,
             word.length + extra_bits_of(token.symbol));
  }
}

}  // namespace
}  // namespace dhcm

struct DhcmEncoder::Buffers {
  std::vector<std::uint8_t> occurs;    // by reading
  std::vector<std::uint16_t> rank_of;  // by reading
  std::vector<std::uint16_t> row;
  dhcm::ValueTable values;
  dhcm::Surface surface;
  std::vector<dhcm::Token> tokens;
  dhcm::Histograms histograms;
  dhcm::EncodeTables tables;

  Bytes encode(const DepthFrame& frame, const BlockMask* mask);

 private:
  bool rank_values(const DepthFrame& frame, dhcm::Segments& segments);
  void collect_tokens(const DepthFrame& frame, dhcm::Segments& segments, bool ranked);
  static Bytes stored(const DepthFrame& frame, dhcm::Segments& segments, dhcm::Header header);
};

bool DhcmEncoder::Buffers::rank_values(const DepthFrame& frame, dhcm::Segments& segments) {
  occurs.assign(65536, 0);
  for (int v = 0; v < frame.height(); ++v) {
    const auto* in = frame.counts.ptr<std::uint16_t>(v);
    for (const dhcm::Segment& segment : segments.of_row(v)) {
      for (int u = segment.begin; u < segment.end; ++u) occurs[in[u]] = 1;
    }
  }
  values.collect(occurs);
  if (!values.pays(segments.pixels())) return false;
  rank_of.assign(65536, 0);
  std::uint16_t rank = 0;
  for (const std::uint16_t value : values.values()) rank_of[value] = ++rank;
  return true;
}

void DhcmEncoder::Buffers::collect_tokens(const DepthFrame& frame, dhcm::Segments& segments,
                                          bool ranked) {
  surface.reset(frame.width());
  row.resize(static_cast<std::size_t>(frame.width()));
  dhcm::TokenCoder coder(tokens, histograms);
  for (int v = 0; v < frame.height(); ++v) {
    const auto* in = frame.counts.ptr<std::uint16_t>(v);
    if (ranked) {
      for (std::size_t u = 0; u < row.size(); ++u) row[u] = rank_of[in[u]];
    }
    coder.begin_row(ranked ? row.data() : in);
    dhcm::scan_row(segments.of_row(v), surface, coder);
  }
  coder.end();
}

Bytes DhcmEncoder::Buffers::stored(const DepthFrame& frame, dhcm::Segments& segments,
                                   dhcm::Header header) {
  header.mode = dhcm::Mode::kStored;
  Bytes out;
  dhcm::begin(header, out);
  out.reserve(out.size() + 2 * segments.pixels() + 4);
  for (int v = 0; v < frame.height(); ++v) {
    const auto* in = frame.counts.ptr<std::uint16_t>(v);
    for (const dhcm::Segment& segment : segments.of_row(v)) {
      for (int u = segment.begin; u < segment.end; ++u) {
        out.push_back(static_cast<std::uint8_t>(in[u]));
        out.push_back(static_cast<std::uint8_t>(in[u] >> 8));
      }
    }
  }
  dhcm::finish(out);
  return out;
}

Bytes DhcmEncoder::Buffers::encode(const DepthFrame& frame, const BlockMask* mask) {
  dhcm::Segments segments(BlockGrid(frame.width(), frame.height()), mask);
  const dhcm::Header header = {dhcm::Mode::kCoded, mask != nullptr, frame.width(), frame.height(),
                               frame.unit};
  const bool ranked = rank_values(frame, segments);
  collect_tokens(frame, segments, ranked);
  Bytes out;
  dhcm::begin(header, out);
  if (!tokens.empty()) {
    dhcm::BitWriter bits(out);
    bits.put(ranked ? 1 : 0, 1);
    if (ranked) values.write(bits);
    dhcm::write_tables(histograms, bits, tables);
    dhcm::write_tokens(tokens, tables, bits);
    bits.finish();
  }
  if (out.size() > 2 * segments.pixels() + 32) return stored(frame, segments, header);
  dhcm::finish(out);
  return out;
}

DhcmEncoder::DhcmEncoder() : buffers_(std::make_unique<Buffers>()) {
}
DhcmEncoder::~DhcmEncoder() = default;

Bytes DhcmEncoder::encode(const DepthFrame& frame) {
  return buffers_->encode(frame, nullptr);
}

Bytes DhcmEncoder::encode(const DepthFrame& frame, const BlockMask& blocks) {
  return buffers_->encode(frame, &blocks);
}

}  // namespace rprr
