// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <functional>

#include "rprr_eval/codec/codec_survey.hpp"
#include "rprr_eval/report/text_table.hpp"

namespace rprr {
namespace {

using Cell = std::function<std::string(const CodecFigures&)>;

class Tables {
 public:
  explicit Tables(const std::vector<CodecFigures>& figures) : figures_(figures) {
    for (const CodecFigures& f : figures) {
      if (f.colour) continue;
      note(codecs_, f.codec);
      note(folders_, f.folder);
    }
  }

  const CodecFigures* find(const std::string& codec, const std::string& folder) const {
    const auto found = std::find_if(figures_.begin(), figures_.end(), [&](const CodecFigures& f) {
      return !f.colour && f.codec == codec && f.folder == folder;
    });
    return found == figures_.end() ? nullptr : &*found;
  }

  std::string table(const std::string& corner, const Cell& cell) const {
    std::string text = row(corner, [](const std::string& folder) { return folder; }) + "|---|";
    for (std::size_t i = 0; i < folders_.size(); ++i) text += "---:|";
    text += "\n";
    for (const std::string& codec : codecs_) {
      text += row(codec, [&](const std::string& folder) {
        const CodecFigures* figures = find(codec, folder);
        return figures == nullptr ? std::string() : cell(*figures);
      });
    }
    return text;
  }

  // For the codecs that have it, the shares of blocks side by side in a cell.
  std::string sparse_table(const std::string& corner,
                           const std::function<std::string(const SparseFigures&)>& value) const {
    Tables ours(figures_);
    ours.codecs_.erase(std::remove_if(ours.codecs_.begin(), ours.codecs_.end(),
                                      [&](const std::string& codec) {
                                        const CodecFigures* f = find(codec, folders_.front());
                                        return f == nullptr || f->sparse.empty();
                                      }),
                       ours.codecs_.end());
    if (ours.codecs_.empty()) return {};
    return "\n" + ours.table(corner, [&](const CodecFigures& figures) {
      std::string cell;
      for (const SparseFigures& s : figures.sparse) {
        cell += (cell.empty() ? "" : " / ") + value(s);
      }
      return cell;
    });
  }

 private:
  static void note(std::vector<std::string>& names, const std::string& name) {
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  }
  std::string row(const std::string& first,
                  const std::function<std::string(const std::string&)>& cell) const {
    std::string text = "| " + first + " |";
    for (const std::string& folder : folders_) text += " " + cell(folder) + " |";
    return text + "\n";
  }

  const std::vector<CodecFigures>& figures_;
  std::vector<std::string> codecs_;
  std::vector<std::string> folders_;
};

}  // namespace

std::string codec_tables(const std::vector<CodecFigures>& figures) {
  const Tables tables(figures);
  std::string text = tables.table("ratio to raw 16 bit", [](const CodecFigures& f) {
    return fixed(f.ratio, 2) + (f.lossless ? "" : " (not lossless)");
  });
  text += "\n" + tables.table("ms to encode / decode", [](const CodecFigures& f) {
    return fixed(f.encode_ms, 2) + " / " + fixed(f.decode_ms, 2);
  });
  const bool has_rvl = std::any_of(figures.begin(), figures.end(),
                                   [](const CodecFigures& f) { return f.codec == "rvl"; });
  if (has_rvl) {
    text += "\n" + tables.table("times RVL's, encode / decode", [&](const CodecFigures& f) {
      const CodecFigures* rvl = tables.find("rvl", f.folder);
      if (rvl == nullptr || rvl->encode_ms <= 0.0 || rvl->decode_ms <= 0.0) return std::string();
      return fixed(f.encode_ms / rvl->encode_ms, 2) + " / " +
             fixed(f.decode_ms / rvl->decode_ms, 2);
    });
  }
  text += tables.sparse_table(
      "bits per kept pixel over the whole frame's",
      [](const SparseFigures& sparse) { return fixed(sparse.relative_bits, 2); });
  text += tables.sparse_table(
      "mask, bytes", [](const SparseFigures& sparse) { return fixed(sparse.mask_bytes, 0); });
  return text;
}

}  // namespace rprr
