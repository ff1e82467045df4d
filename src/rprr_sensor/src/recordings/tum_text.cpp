// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/tum_text.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <functional>
#include <limits>
#include <locale>
#include <sstream>

namespace rprr {
namespace {

constexpr Stamp kSecond = 1000000000;
// Stamps beyond it (year 2116) would not fit ROS's 32-bit seconds anyway.
constexpr Stamp kMostSeconds = 4294967295;

using Words = std::vector<std::string>;

Words words_of(const std::string& line) {
  std::istringstream stream(line);
  Words words;
  for (std::string word; stream >> word;) words.push_back(word);
  return words;
}

std::optional<double> parse_number(const std::string& word) {
  std::istringstream stream(word);
  stream.imbue(std::locale::classic());
  double value = 0.0;
  if (!(stream >> value) || !stream.eof() || !std::isfinite(value)) return std::nullopt;
  return value;
}

/// Calls `take` with the words of every line that says something; it returns false for a bad line.
std::optional<Error> for_each_line(const std::string& path, const std::string& expected,
                                   const std::function<bool(const Words&)>& take) {
  std::ifstream file(path);
  if (!file) return Error{path + ": cannot be opened"};
  std::string line;
  for (int number = 1; std::getline(file, line); ++number) {
    const Words words = words_of(line);
    if (words.empty() || words.front().front() == '#') continue;
    if (!take(words)) {
      return Error{path + ":" + std::to_string(number) + ": expected '" + expected + "', found '" +
                   line.substr(0, 120) + "'; mend or remove the line"};
    }
  }
  if (file.bad()) return Error{path + ": cannot be read to its end"};
  return std::nullopt;
}

std::optional<Pose> parse_pose(const Words& words) {
  Eigen::Matrix<double, 7, 1> numbers;
  for (int i = 0; i < 7; ++i) {
    const auto number = parse_number(words[static_cast<std::size_t>(i) + 1]);
    if (!number) return std::nullopt;
    numbers[i] = *number;
  }
  const Eigen::Vector4d quaternion = numbers.tail<4>();
  // Recordings round their quaternions or average them: make_pose normalises what is about of unit
  // length; what is not is no rotation.
  if (std::abs(quaternion.norm() - 1.0) > 0.1) return std::nullopt;
  return make_pose(numbers.head<3>(), quaternion);
}

}  // namespace

std::optional<Stamp> parse_stamp(const std::string& text) {
  Stamp seconds = 0;
  Stamp nanoseconds = 0;
  Stamp place = kSecond / 10;
  bool fraction = false;
  int digits = 0;
  for (const char c : text) {
    if (c == '.' && !fraction) {
      fraction = true;
      continue;
    }
    if (c < '0' || c > '9') return std::nullopt;
    ++digits;
    if (fraction) {
      nanoseconds += (c - '0') * place;
      place /= 10;
    } else {
      seconds = seconds * 10 + (c - '0');
      if (seconds > kMostSeconds) return std::nullopt;
    }
  }
  if (digits == 0) return std::nullopt;
  return seconds * kSecond + nanoseconds;
}

std::string format_stamp(Stamp stamp) {
  char text[32];
  std::snprintf(text, sizeof text, "%lld.%09lld", static_cast<long long>(stamp / kSecond),
                static_cast<long long>(stamp % kSecond));
  return text;
}

Result<std::vector<StampedFile>> read_file_list(const std::string& path) {
  std::vector<StampedFile> files;
  const auto error = for_each_line(path, "stamp file", [&](const Words& words) {
    const auto stamp = words.size() == 2 ? parse_stamp(words[0]) : std::nullopt;
    if (!stamp) return false;
    files.push_back({*stamp, words[1]});
    return true;
  });
  if (error) return *error;
  return files;
}

Result<std::vector<AssociatedFiles>> read_associations(const std::string& path) {
  std::vector<AssociatedFiles> associations;
  const auto error =
      for_each_line(path, "stamp colour-file stamp depth-file", [&](const Words& words) {
        if (words.size() != 4) return false;
        const auto colour = parse_stamp(words[0]);
        const auto depth = parse_stamp(words[2]);
        if (!colour || !depth) return false;
        associations.push_back({{*colour, words[1]}, {*depth, words[3]}});
        return true;
      });
  if (error) return *error;
  return associations;
}

Result<std::vector<StampedPose>> read_poses(const std::string& path) {
  std::vector<StampedPose> poses;
  const auto error = for_each_line(path, "stamp tx ty tz qx qy qz qw (finite, unit quaternion)",
                                   [&](const Words& words) {
                                     if (words.size() != 8) return false;
                                     const auto stamp = parse_stamp(words[0]);
                                     const auto pose = parse_pose(words);
                                     if (!stamp || !pose) return false;
                                     poses.push_back({*stamp, *pose});
                                     return true;
                                   });
  if (error) return *error;
  std::stable_sort(poses.begin(), poses.end(),
                   [](const StampedPose& a, const StampedPose& b) { return a.stamp < b.stamp; });
  return poses;
}

}  // namespace rprr
