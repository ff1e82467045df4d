// SPDX-License-Identifier: BSD-3-Clause
#include <cstdio>
#include <cstdlib>

#include "rprr_codec/frame_codec.hpp"

namespace rprr {
namespace {

constexpr double kMostBytes = 1e7;
constexpr double kMostPsnr = 99.0;  // dB; of images that are the same

// A plain decimal number above 0; 0 where the text is none.
double positive(const std::string& text) {
  const bool is_decimal = !text.empty() && text.find_first_not_of("0123456789.") == text.npos;
  char* end = nullptr;
  const double value = is_decimal ? std::strtod(text.c_str(), &end) : 0.0;
  return is_decimal && *end == '\0' ? value : 0.0;
}

Option sparse_colours_option(SparseColours& field) {
  Option option;
  option.name = "sparse_colours";
  option.kind = OptionKind::kText;
  option.help =
      "What the colours of a sparse frame go by, under objectives view and map. quality: "
      "colour_quality. bytes:N: the finest with which the frame, depth and all, takes at most N "
      "bytes. psnr:D: the coarsest with which what is sent comes so near to the camera's image "
      "[dB]. A narrow radio goes first";
  option.get = [&field] { return OptionValue(text_of(field)); };
  option.set = [&field](const OptionValue& value) {
    field = *sparse_colours_of(std::get<std::string>(value));
  };
  option.only_if(
      [](const OptionValue& value) {
        return sparse_colours_of(std::get<std::string>(value)).has_value();
      },
      "quality, bytes:N with N from 1 to 10000000, psnr:D with D above 0 up to 99");
  return option;
}

}  // namespace

std::optional<SparseColours> sparse_colours_of(const std::string& text) {
  using By = SparseColours::By;
  if (text == "quality") return SparseColours{};
  const std::size_t colon = text.find(':');
  if (colon == std::string::npos) return std::nullopt;
  const std::string form = text.substr(0, colon);
  const double amount = positive(text.substr(colon + 1));
  const bool is_whole = text.find('.') == std::string::npos;
  if (form == "bytes" && is_whole && amount >= 1.0 && amount <= kMostBytes) {
    return SparseColours{By::kBytes, amount};
  }
  if (form == "psnr" && amount > 0.0 && amount <= kMostPsnr) {
    return SparseColours{By::kPsnr, amount};
  }
  return std::nullopt;
}

std::string text_of(const SparseColours& colours) {
  char text[40] = "quality";
  if (colours.by == SparseColours::By::kBytes) {
    std::snprintf(text, sizeof text, "bytes:%.0f", colours.amount);
  } else if (colours.by == SparseColours::By::kPsnr) {
    std::snprintf(text, sizeof text, "psnr:%g", colours.amount);
  }
  return text;
}

void list_options(FrameCodecOptions& o, OptionTable& table) {
  table.group("Depth");
  table.word<DhcmMode>(
      "depth_mode", o.depth_mode,
      {{"fast", DhcmMode::kFast}, {"default", DhcmMode::kDefault}, {"small", DhcmMode::kSmall}},
      "Of DHC-M, always lossless: small is a seventh smaller than default and takes some "
      "milliseconds more for a whole VGA frame");
  table.number("depth_step", o.depth_step, {0.0, 0.1}, "1/m",
               "Where depth alone is too long for a narrow radio it may be rounded to steps of "
               "inverse depth of up to this (0.012: up to 6 mm at 1 m, 24 mm at 2 m); 0: always "
               "lossless");
  table.group(
      "Colours. How fine they are: a narrow radio goes first, then sparse_colours, then "
      "colour_quality");
  table.word("colour_codec", o.colour_codec, colour_codecs(),
             "Codec of all colours; colour_quality is on its scale");
  table
      .whole(
          "colour_quality", o.colour_quality, {0, 100}, "",
          "How fine colours are, the one knob, on the codec's own scale. webp: 0 coarsest to 100 "
          "finest; jpeg: 1 to 100; pgf: 30 coarsest to 1 finest, 0 lossless. Whole frames have "
          "it; a rebuilt view is like a whole image of half of it")
      .as_live();
  table
      .word<Objective>(
          "objective", o.objective,
          {{"fixed", Objective::kFixed}, {"map", Objective::kMap}, {"view", Objective::kView}},
          "What the colours of sparse frames are for. fixed: the blocks sent, at "
          "colour_quality, as in the paper; map: the same, and the least for the rest; "
          "view: the best whole picture for the bytes")
      .as_live();
  table.add(sparse_colours_option(o.sparse_colours)).as_live();
  table.word<UnsentFill>("unsent_fill", o.fill,
                         {{"black", UnsentFill::kBlack}, {"smooth", UnsentFill::kSmooth}},
                         "What stands for blocks that are not sent: smooth continues those around, "
                         "which is cheaper to code; black is the paper's");
  table.flag("measure_independent", o.measure_independent,
             "Also encode each sparse frame whole, to report what that would cost");
}

}  // namespace rprr
