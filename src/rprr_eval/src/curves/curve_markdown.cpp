// SPDX-License-Identifier: BSD-3-Clause
#include <functional>
#include <utility>

#include "rprr_eval/curves/curve_comparison.hpp"
#include "rprr_eval/report/text_table.hpp"

namespace rprr {
namespace {

using nlohmann::json;
using Cell = std::function<std::string(const json&)>;

std::string number(const json& value, int digits, double scale = 1.0) {
  return value.is_number() ? fixed(scale * value.get<double>(), digits) : "-";
}
std::string percent(const json& value, int digits = 0) {
  return value.is_number() ? number(value, digits, 100.0) + "%" : "-";
}

// null where nothing was measured.
json member(const json& object, const std::string& name, const std::string& field) {
  return object.contains(name) ? object[name].value(field, json()) : json();
}

// One column a folder.
class Table {
 public:
  Table(const std::vector<json>& folders, const std::string& corner) : folders_(folders) {
    add(corner, [](const json& folder) { return folder["folder"].get<std::string>(); });
    text_ += "|---|";
    for (std::size_t i = 0; i < folders_.size(); ++i) text_ += "---:|";
    text_ += "\n";
  }
  void add(const std::string& label, const Cell& cell) {
    text_ += "| " + label + " |";
    for (const json& folder : folders_) text_ += " " + cell(folder) + " |";
    text_ += "\n";
  }
  std::string text() const { return text_ + "\n"; }

 private:
  const std::vector<json>& folders_;
  std::string text_;
};

std::string points_table(const std::vector<json>& folders) {
  const json& first = folders.front()["on_curve"];
  Table table(folders, "`view` at the bytes of independent, " + first["codec"].get<std::string>() +
                           " at quality: gain in PSNR and in SSIM (pairs on the curve)");
  for (std::size_t i = 0; i < first["points"].size(); ++i) {
    table.add(number(first["points"][i]["setting"], 0), [i](const json& folder) {
      const json& point = folder["on_curve"]["points"][i];
      return number(point["median_psnr_gain"], 1) + " dB (" + percent(point["share_psnr"]) + "), " +
             number(point["median_ssim_gain"], 3) + " (" + percent(point["share_ssim"]) + ")";
    });
  }
  return table.text();
}

std::string on_curve_table(const std::vector<json>& folders) {
  Table table(folders, "`view` on independent's curve, same codec");
  const auto add = [&](const std::string& label, const Cell& cell) {
    table.add(label, [cell](const json& folder) { return cell(folder["on_curve"]); });
  };
  table.add("pairs / poses accepted / overlap 0.5 and more", [](const json& folder) {
    return number(folder["pairs"], 0) + " / " + number(folder["accepted"], 0) + " / " +
           number(folder["pairs_overlap_half"], 0);
  });
  add("pairs on the whole curve: PSNR / SSIM / both", [](const json& found) {
    return percent(found["share_psnr"]) + " / " + percent(found["share_ssim"]) + " / " +
           percent(found["share_both"]);
  });
  add("median of each pair's worst shortfall (negative: above), dB / SSIM", [](const json& found) {
    return number(found["median_psnr"], 2) + " / " + number(found["median_ssim"], 4);
  });
  add("worst of all, dB / SSIM", [](const json& found) {
    return number(found["worst_psnr"], 2) + " / " + number(found["worst_ssim"], 4);
  });
  add("pairs whose smallest view has more bytes than the smallest independent frame",
      [](const json& found) { return number(found["begin_late"], 0); });
  return table.text() + points_table(folders);
}

std::string ratios_table(const std::vector<json>& folders, const std::string& method,
                         const std::string& corner) {
  Table table(folders, corner);
  for (const auto& [group, name] : {std::pair{"equal_quality_overlap_half", "overlap 0.5 and more"},
                                    std::pair{"equal_quality", "all pairs"}}) {
    for (const char* rival : {"webp", "jpeg", "pgf", "jxl"}) {
      const std::string key = group;
      const auto found = [key, method, rival](const json& folder) {
        const json& methods = folder[key];
        return methods.contains(method) && methods[method].contains(rival)
                   ? methods[method][rival]
                   : json{{"in_common", nullptr}, {"at", json::object()}};
      };
      const std::string label = std::string(rival) + ", " + name;
      table.add(label + ": over what both reach",
                [found](const json& folder) { return number(found(folder)["in_common"], 2); });
      if (std::string(rival) != "webp") continue;
      table.add(label + ": at independent's least / 28 / 30 / 32 / 34 / 36 dB",
                [found](const json& folder) {
                  const json levels = found(folder)["at"];
                  std::string cell;
                  for (const char* level : {"least", "28", "30", "32", "34", "36"}) {
                    cell += (cell.empty() ? "" : " / ") + number(member(levels, level, "ratio"), 2);
                  }
                  return cell;
                });
    }
  }
  return table.text();
}

std::string paper_table(const std::vector<json>& folders) {
  Table table(folders, "`view` at the bytes of `paper`: PSNR gain, median (least); SSIM higher");
  const std::size_t points = folders.front()["against_paper"].size();
  for (std::size_t i = 0; i < points; ++i) {
    const json& first = folders.front()["against_paper"][i];
    table.add("PGF quality " + number(first["quality"], 0) +
                  (first["of_profile"].get<bool>() ? ", the profile's" : ""),
              [i](const json& folder) {
                const json& found = folder["against_paper"][i];
                return number(found["median_gain"], 1) + " (" + number(found["least_gain"], 1) +
                       ") dB; " + percent(found["share_ssim_higher"]);
              });
  }
  return table.text();
}

std::string depth_table(const std::vector<json>& folders) {
  Table table(folders, "predicted depth, `default` / `paper`");
  const auto both = [&](const std::string& label, const std::string& key, int digits) {
    table.add(label, [key, digits](const json& folder) {
      return percent(folder["depth"]["view"][key], digits) + " / " +
             percent(folder["depth"]["paper"][key], digits);
    });
  };
  both("RMSE over depth, median", "median_rmse", 2);
  both("90% of pairs stay under", "rmse_of_90_percent", 2);
  both("off by more than 5%, median", "median_off", 2);
  both("90% of pairs stay under", "off_of_90_percent", 2);
  table.add("depth coverage of the frame, median", [](const json& folder) {
    const json& methods = folder["at_profile"];
    return percent(member(methods, "view", "depth_coverage"), 1) + " / " +
           percent(member(methods, "paper", "depth_coverage"), 1);
  });
  return table.text();
}

std::string profile_table(const std::vector<json>& folders) {
  Table table(folders, "as the profiles say: kB (depth + colour), PSNR, SSIM");
  for (const auto& [method, label] :
       {std::pair{"view", "`default`"}, std::pair{"map", "`default`, objective map"},
        std::pair{"paper", "`paper`"}, std::pair{"webp", "independent, as `default` codes it"},
        std::pair{"pgf", "independent, as `paper` codes it"}}) {
    const std::string key = method;
    table.add(label, [key](const json& folder) -> std::string {
      if (!folder["at_profile"].contains(key)) return "-";
      const json& found = folder["at_profile"][key];
      return number(found["bytes"], 1, 1e-3) + " (" + number(found["bytes_depth"], 1, 1e-3) +
             " + " + number(found["bytes_colour"], 1, 1e-3) + "), " + number(found["psnr"], 1) +
             " dB, " + number(found["ssim"], 3);
    });
  }
  return table.text();
}

std::string colour_table(const std::vector<json>& folders, const std::string& field, int digits,
                         const std::string& unit) {
  const json& first = folders.front();
  Table table(folders, "at the colour bytes of " + first["on_curve"]["codec"].get<std::string>() +
                           " at quality: gain in " + unit + " of view / pgf / jpeg / jxl");
  for (std::size_t i = 0; i < first["on_curve"]["points"].size(); ++i) {
    table.add(number(first["on_curve"]["points"][i]["setting"], 0), [=](const json& folder) {
      std::string cell;
      for (const char* method : {"view", "pgf", "jpeg", "jxl"}) {
        const json& methods = folder["at_colour_bytes"];
        const bool known = methods.contains(method) && i < methods[method].size();
        cell += (cell.empty() ? "" : " / ") +
                number(known ? methods[method][i][field] : json(), digits);
      }
      return cell;
    });
  }
  return table.text();
}

}  // namespace

std::string comparison_markdown(const std::vector<json>& folders) {
  if (folders.empty()) return {};
  return on_curve_table(folders) +
         ratios_table(folders, "view",
                      "bytes of `view` over independent's at equal PSNR of the whole frame") +
         ratios_table(folders, "map",
                      "bytes of `map` over independent's at equal PSNR of newly seen content") +
         colour_table(folders, "psnr_gain", 1, "PSNR, dB,") +
         colour_table(folders, "ssim_gain", 3, "SSIM") + paper_table(folders) +
         depth_table(folders) + profile_table(folders);
}

}  // namespace rprr
