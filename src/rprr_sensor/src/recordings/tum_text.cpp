// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/tum_text.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <limits>
#include <locale>
#include <sstream>

namespace rprr {
namespace {

constexpr Stamp kSecond = 1000000000;
// Stamps beyond it (year 2106) would not fit ROS's 32-bit seconds anyway.
constexpr Stamp kMostSeconds = 4294967295;
constexpr std::size_t kPoseColumns = 8;
constexpr std::size_t kMatrixColumns = 12;  // of KITTI's poses, which have no stamp

using Words = std::vector<std::string>;

std::string trimmed(const std::string& text) {
  const char* blanks = " \t\r\n\"";
  const std::size_t begin = text.find_first_not_of(blanks);
  if (begin == std::string::npos) return {};
  return text.substr(begin, text.find_last_not_of(blanks) + 1 - begin);
}

// The columns of a line: between commas or semicolons where it has any, else between blanks.
Words words_of(const std::string& line) {
  Words words;
  const std::size_t mark = line.find_first_of(",;");
  if (mark == std::string::npos) {
    std::istringstream stream(line);
    for (std::string word; stream >> word;) words.push_back(word);
    return words;
  }
  std::istringstream stream(line);
  for (std::string word; std::getline(stream, word, line[mark]);) words.push_back(trimmed(word));
  return words;
}

std::optional<double> parse_number(const std::string& word) {
  std::istringstream stream(word);
  stream.imbue(std::locale::classic());
  double value = 0.0;
  if (!(stream >> value) || !stream.eof() || !std::isfinite(value)) return std::nullopt;
  return value;
}

std::string without_mark(const std::string& line) {
  return line.compare(0, 3, "\xef\xbb\xbf") == 0 ? line.substr(3) : line;
}

// Calls `take` with the columns of every line that says something; it returns false for a line that
// it cannot use. A text of what was left out, empty: nothing.
Result<std::string> for_each_line(const std::string& path, const std::string& expected,
                                  const std::function<bool(const Words&)>& take,
                                  const std::function<void(const std::string&)>& comment = {}) {
  std::ifstream file(path);
  if (!file) return Error{path + ": cannot be opened"};
  std::string line;
  std::string first_bad;
  std::size_t bad = 0;
  std::size_t good = 0;
  for (int number = 1; std::getline(file, line); ++number) {
    if (number == 1) line = without_mark(line);
    const Words words = words_of(line);
    if (words.empty() || trimmed(line).empty()) continue;
    if (trimmed(line).front() == '#') {
      if (comment) comment(line);
      continue;
    }
    if (take(words)) {
      ++good;
      continue;
    }
    if (good == 0 && bad == 0 && comment) comment(line);  // perhaps a header
    if (bad++ == 0) {
      std::ostringstream text;
      text << path << ":" << number << ": expected '" << expected << "', found '"
           << line.substr(0, 120) << "'";
      first_bad = text.str();
    }
  }
  if (file.bad()) return Error{path + ": cannot be read to its end"};
  if (bad == 0) return std::string();
  if (good == 0) return Error{first_bad + "; mend or remove the line"};
  return std::to_string(bad) + " of " + std::to_string(bad + good) + " lines left out, the first " +
         first_bad;
}

// Columns `from` to the last one before `end` as one name, if that is a file, else ever fewer.
std::string file_name(const Words& words, std::size_t from, std::size_t end,
                      const IsFile& is_file) {
  for (std::size_t last = end; last > from + 1; --last) {
    std::string name = words[from];
    for (std::size_t i = from + 1; i < last; ++i) name += " " + words[i];
    if (is_file(name)) return name;
  }
  return words[from];
}

bool says_depth(const std::string& file) {
  return file.find("depth") != std::string::npos;
}

// Column of the second stamp; 0: there is none.
std::size_t second_stamp(const Words& words) {
  for (std::size_t i = 2; i + 1 < words.size(); ++i) {
    if (parse_stamp(words[i])) return i;
  }
  return 0;
}

std::optional<Pose> parse_pose(const Words& words, bool real_first) {
  Eigen::Matrix<double, 7, 1> numbers;
  for (int i = 0; i < 7; ++i) {
    const auto number = parse_number(words[static_cast<std::size_t>(i) + 1]);
    if (!number) return std::nullopt;
    numbers[i] = *number;
  }
  Eigen::Vector4d quaternion = numbers.tail<4>();  // x y z w
  if (real_first) quaternion = Eigen::Vector4d(numbers[4], numbers[5], numbers[6], numbers[3]);
  // Recordings round their quaternions or average them: make_pose normalises what is about of unit
  // length; what is not is no rotation.
  if (std::abs(quaternion.norm() - 1.0) > 0.1) return std::nullopt;
  return make_pose(numbers.head<3>(), quaternion);
}

// A row of KITTI's poses: three rows of a rotation and a translation, no stamp.
bool is_kitti_matrix(const Words& words) {
  if (words.size() != kMatrixColumns) return false;
  Eigen::Matrix3d rotation;
  for (int i = 0; i < 9; ++i) {
    const auto number = parse_number(words[static_cast<std::size_t>(4 * (i / 3) + i % 3)]);
    if (!number) return false;
    rotation(i / 3, i % 3) = *number;
  }
  return (rotation * rotation.transpose()).isIdentity(1e-3);
}

// Whether a header names the quaternion's real part before the others.
bool names_real_first(const std::string& header) {
  const auto place = [&](const char* suffix) {
    for (const char* prefix : {"q", "q_", "q_RS_", "quat_"}) {
      const std::size_t found = header.find(std::string(prefix) + suffix);
      if (found != std::string::npos) return found;
    }
    return std::string::npos;
  };
  return place("w") != std::string::npos && place("x") != std::string::npos &&
         place("w") < place("x");
}

// Of a whole number: how many nanoseconds its unit has; 0: it is no stamp.
Stamp unit_of(std::size_t digits) {
  if (digits <= 10) return kSecond;
  switch (digits) {
    case 13:
      return 1000000;
    case 16:
      return 1000;
    case 19:
      return 1;
    default:
      return 0;
  }
}

}  // namespace

std::optional<Stamp> parse_stamp(const std::string& text) {
  const std::size_t point = std::min(text.find('.'), text.size());
  if (text.empty() || text == "." || text.find_first_not_of("0123456789.") != std::string::npos ||
      text.find('.', point + 1) != std::string::npos) {
    return std::nullopt;
  }
  const std::string whole = text.substr(0, point);
  const std::size_t zeros = std::min(whole.find_first_not_of('0'), whole.size());
  const bool is_whole = point == text.size();
  const Stamp unit = is_whole ? unit_of(whole.size() - zeros) : kSecond;
  if (unit == 0 || whole.size() - zeros > 19) return std::nullopt;
  Stamp value = 0;
  for (const char digit : whole.substr(zeros)) {
    if (value > (std::numeric_limits<Stamp>::max() - 9) / 10) return std::nullopt;
    value = value * 10 + (digit - '0');
  }
  if (value / (kSecond / unit) > kMostSeconds) return std::nullopt;
  Stamp nanoseconds = value * unit;
  Stamp place = kSecond / 10;
  for (std::size_t i = point + 1; i < text.size(); ++i, place /= 10) {
    nanoseconds += (text[i] - '0') * place;
  }
  return nanoseconds;
}

std::string format_stamp(Stamp stamp) {
  char text[32];
  std::snprintf(text, sizeof text, "%lld.%09lld", static_cast<long long>(stamp / kSecond),
                static_cast<long long>(stamp % kSecond));
  return text;
}

Result<TextList<StampedFile>> read_file_list(const std::string& path, const IsFile& is_file) {
  TextList<StampedFile> list;
  const auto remark = for_each_line(path, "stamp file", [&](const Words& words) {
    const auto stamp = words.size() >= 2 ? parse_stamp(words[0]) : std::nullopt;
    if (!stamp) return false;
    list.entries.push_back({*stamp, file_name(words, 1, words.size(), is_file)});
    return true;
  });
  if (!remark) return Error{remark.reason()};
  list.remark = *remark;
  return list;
}

Result<TextList<AssociatedFiles>> read_associations(const std::string& path,
                                                    const IsFile& is_file) {
  TextList<AssociatedFiles> list;
  const auto remark =
      for_each_line(path, "stamp colour-file stamp depth-file", [&](const Words& words) {
        const std::size_t second = second_stamp(words);
        const auto stamp = second > 0 ? parse_stamp(words[0]) : std::nullopt;
        if (!stamp) return false;
        AssociatedFiles files{
            {*stamp, file_name(words, 1, second, is_file)},
            {*parse_stamp(words[second]), file_name(words, second + 1, words.size(), is_file)}};
        if (says_depth(files.colour.file) && !says_depth(files.depth.file)) {
          std::swap(files.colour, files.depth);
        }
        list.entries.push_back(files);
        return true;
      });
  if (!remark) return Error{remark.reason()};
  list.remark = *remark;
  return list;
}

Result<TextList<StampedPose>> read_poses(const std::string& path) {
  TextList<StampedPose> list;
  bool real_first = false;
  bool is_matrix = false;
  const auto remark = for_each_line(
      path, "stamp tx ty tz qx qy qz qw (finite, unit quaternion)",
      [&](const Words& words) {
        is_matrix = is_matrix || is_kitti_matrix(words);
        const auto stamp =
            !is_matrix && words.size() >= kPoseColumns ? parse_stamp(words[0]) : std::nullopt;
        const auto pose = stamp ? parse_pose(words, real_first) : std::nullopt;
        if (!pose) return false;
        list.entries.push_back({*stamp, *pose});
        return true;
      },
      [&](const std::string& line) { real_first = real_first || names_real_first(line); });
  if (!remark) {
    return Error{remark.reason() + (is_matrix ? ". The twelve columns are KITTI's matrices, which "
                                                "have no stamps: convert them first"
                                              : "")};
  }
  list.remark = *remark;
  std::stable_sort(list.entries.begin(), list.entries.end(),
                   [](const StampedPose& a, const StampedPose& b) { return a.stamp < b.stamp; });
  return list;
}

}  // namespace rprr
