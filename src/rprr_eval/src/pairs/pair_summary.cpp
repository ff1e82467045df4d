// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_eval/pairs/pair_summary.hpp"

#include <cstdio>
#include <functional>

#include "rprr_eval/measure/median.hpp"

namespace rprr {
namespace {

using Field = std::function<double(const PairResult&)>;

bool accepted(const PairResult& r) {
  return r.exchange.pose && r.exchange.pose->verdict.accepted();
}
bool right(const PairResult& r) {
  return r.pose_error && is_right(*r.pose_error);
}
bool wrong(const PairResult& r) {
  return r.pose_error && is_wrong(*r.pose_error);
}

double median_of(const std::vector<PairResult>& results, const Field& field) {
  std::vector<double> values;
  values.reserve(results.size());
  for (const PairResult& result : results) values.push_back(field(result));
  return median(std::move(values));
}

void line(std::string& out, const char* label, const char* format, double value) {
  char text[160];
  std::snprintf(text, sizeof(text), format, value);
  char row[240];
  std::snprintf(row, sizeof(row), "  %-44s %s\n", label, text);
  out += row;
}

void pose_lines(std::string& out, const std::vector<PairResult>& results) {
  std::vector<PairResult> good;
  double n_accepted = 0, n_right = 0, n_wrong = 0, with_truth = 0;
  for (const PairResult& result : results) {
    if (result.pose_error) ++with_truth;
    if (!accepted(result)) continue;
    ++n_accepted;
    if (right(result)) ++n_right;
    if (wrong(result)) ++n_wrong;
    if (result.pose_error) good.push_back(result);
  }
  line(out, "poses accepted", "%.0f", n_accepted);
  if (with_truth > 0) {
    line(out, "  and right (under 8 cm and 3 deg)", "%.0f", n_right);
    line(out, "  but wrong (over 16 cm or 6 deg)", "%.0f", n_wrong);
    line(out, "  median error", "%.1f mm",
         1e3 * median_of(good, [](const PairResult& r) { return r.pose_error->metres; }));
    line(out, "", "%.2f deg",
         median_of(good, [](const PairResult& r) { return r.pose_error->degrees; }));
  }
}

}  // namespace

std::string summary_table(const std::vector<PairResult>& results, const Profile& profile) {
  std::string out = "profile " + profile.name + ", colour codec " + profile.codec.colour_codec +
                    " at quality " + std::to_string(profile.codec.colour_quality) + ", " +
                    std::to_string(results.size()) + " pairs; medians over all of them\n";
  const auto add = [&](const char* label, const char* format, const Field& field) {
    line(out, label, format, median_of(results, field));
  };
  pose_lines(out, results);
  add("blocks sent of all", "%.3f", [](const PairResult& r) {
    return static_cast<double>(r.rebuilt.blocks_sent) / r.rebuilt.blocks_total;
  });
  add("bytes: pose exchange", "%.0f", [](const PairResult& r) { return double(r.exchange.bytes); });
  add("bytes: masks", "%.0f", [](const PairResult& r) { return double(r.rebuilt.bytes_masks); });
  add("bytes: depth", "%.0f", [](const PairResult& r) { return double(r.rebuilt.sizes.depth); });
  add("bytes: colour", "%.0f",
      [](const PairResult& r) { return double(r.rebuilt.sizes.colour + r.rebuilt.sizes.base); });
  add("bytes: total", "%.0f", [](const PairResult& r) { return double(r.rebuilt.bytes_total); });
  add("bytes: independent", "%.0f",
      [](const PairResult& r) { return double(r.independent.total); });
  add("bytes: total / independent", "%.3f", [](const PairResult& r) {
    return static_cast<double>(r.rebuilt.bytes_total) / static_cast<double>(r.independent.total);
  });
  add("PSNR, whole frame", "%.2f dB", [](const PairResult& r) { return r.psnr; });
  add("PSNR, independent", "%.2f dB", [](const PairResult& r) { return r.independent_psnr; });
  add("SSIM, whole frame", "%.3f", [](const PairResult& r) { return r.ssim; });
  add("depth RMSE", "%.1f mm", [](const PairResult& r) { return r.depth.rmse_mm; });
  add("depth coverage", "%.3f", [](const PairResult& r) { return r.depth.coverage; });
  const bool exact = std::all_of(results.begin(), results.end(),
                                 [](const PairResult& r) { return r.depth_exact; });
  out += std::string("  depth of sent blocks bit-exact in every pair   ") + (exact ? "yes" : "NO") +
         "\n";
  add("ms: pose, both robots", "%.2f",
      [](const PairResult& r) { return 1e3 * r.exchange.seconds_compute; });
  add("ms: predict + validate", "%.2f",
      [](const PairResult& r) { return r.ms_predict + r.ms_validate; });
  add("ms: encode", "%.2f", [](const PairResult& r) { return double(r.rebuilt.report.ms_encode); });
  add("ms: decode + reconstruct", "%.2f",
      [](const PairResult& r) { return r.rebuilt.ms_decode + r.rebuilt.ms_reconstruct; });
  return out;
}

}  // namespace rprr
