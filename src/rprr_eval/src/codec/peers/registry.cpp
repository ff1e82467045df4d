// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "codec/peers/makers.hpp"

namespace rprr {

const std::vector<DepthCodecEntry>& depth_codecs() {
  static const std::vector<DepthCodecEntry> kCodecs = {
      {"dhcm_fast", "DHC-M, mode fast", DhcmMode::kFast, [] { return make_dhcm(DhcmMode::kFast); }},
      {"dhcm", "DHC-M, mode default", DhcmMode::kDefault,
       [] { return make_dhcm(DhcmMode::kDefault); }},
      {"dhcm_small", "DHC-M, mode small", DhcmMode::kSmall,
       [] { return make_dhcm(DhcmMode::kSmall); }},
      {"rvl", "RVL, written from its paper", {}, make_rvl},
      {"lz4", "LZ4 over byte-split row deltas", {}, make_lz4},
      {"zstd1", "Zstandard level 1 over byte-split row deltas", {}, [] { return make_zstd(1); }},
      {"zstd3", "Zstandard level 3 over byte-split row deltas", {}, [] { return make_zstd(3); }},
      {"png1", "PNG level 1 (OpenCV)", {}, [] { return make_png(1); }},
      {"png6", "PNG level 6 (OpenCV)", {}, [] { return make_png(6); }},
      {"jpegls", "JPEG-LS (CharLS)", {}, make_jpeg_ls},
      {"jxl1", "JPEG XL lossless, effort 1 (libjxl)", {}, [] { return make_jpeg_xl(1); }},
      {"jxl3", "JPEG XL lossless, effort 3 (libjxl)", {}, [] { return make_jpeg_xl(3); }},
      {"ffv1", "FFV1 version 3 (libavcodec)", {}, make_ffv1},
  };
  return kCodecs;
}

Result<std::vector<NamedDepthCodec>> make_depth_codecs(const std::vector<std::string>& names,
                                                       std::vector<std::string>& notes) {
  std::vector<std::string> wanted = names;
  if (wanted.empty()) {
    for (const DepthCodecEntry& entry : depth_codecs()) wanted.push_back(entry.name);
  }
  std::vector<NamedDepthCodec> made;
  for (const std::string& name : wanted) {
    const auto entry = std::find_if(depth_codecs().begin(), depth_codecs().end(),
                                    [&](const DepthCodecEntry& e) { return e.name == name; });
    if (entry == depth_codecs().end()) {
      std::string known;
      for (const DepthCodecEntry& e : depth_codecs()) known += " " + e.name;
      return Error{"no codec " + name + "; there are" + known};
    }
    DepthCodecResult codec = entry->make();
    if (codec) {
      made.push_back({name, entry->ours, std::move(*codec)});
    } else if (names.empty()) {
      notes.push_back(name + ": " + codec.reason());
    } else {
      return Error{name + ": " + codec.reason()};
    }
  }
  return made;
}

}  // namespace rprr
