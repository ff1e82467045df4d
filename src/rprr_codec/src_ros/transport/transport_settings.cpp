// SPDX-License-Identifier: BSD-3-Clause
#include "transport/transport_settings.hpp"

namespace rprr {
namespace {

// The largest image that both formats can carry; the least is smaller than any camera's.
constexpr OptionRange kMegapixels{0.01, 68.0};
constexpr const char* kMegapixelsHelp = "Larger images are refused before memory is taken";

}  // namespace

void list_options(DhcmSending& s, OptionTable& table) {
  table
      .word<DhcmMode>(
          "mode", s.mode,
          {{"fast", DhcmMode::kFast}, {"default", DhcmMode::kDefault}, {"small", DhcmMode::kSmall}},
          "Between speed and size; all are lossless")
      .as_live();
  table
      .number("step", s.step, {0.0, 1.0}, "m",
              "32FC1 only: depth is rounded to whole multiples of this; 0: lossless")
      .as_live();
}

void list_options(PgfSending& s, OptionTable& table) {
  table.whole("quality", s.quality, {0, 30}, "", "0: lossless, 1: finest, 30: coarsest").as_live();
}

void list_options(DhcmReceiving& s, OptionTable& table) {
  table.number("max_megapixels", s.max_megapixels, kMegapixels, "megapixels", kMegapixelsHelp)
      .as_live();
}

void list_options(PgfReceiving& s, OptionTable& table) {
  table.number("max_megapixels", s.max_megapixels, kMegapixels, "megapixels", kMegapixelsHelp)
      .as_live();
  table.number("time_limit", s.time_limit, {0.1, 60.0}, "s", "Time that decoding an image may take")
      .as_live();
}

}  // namespace rprr
