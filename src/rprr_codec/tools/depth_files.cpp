// SPDX-License-Identifier: BSD-3-Clause
#include "depth_files.hpp"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <opencv2/imgcodecs.hpp>

#include "rprr_geometry/camera.hpp"
#include "rprr_wire/bytes.hpp"

namespace fs = std::filesystem;

namespace rprr {
namespace {

std::string ending(const fs::path& path) {
  std::string text = path.extension().string();
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

// Raw files are little-endian on every machine.
void swap_if_big_endian([[maybe_unused]] Bytes& bytes, [[maybe_unused]] std::size_t width) {
#if __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__
  for (std::size_t at = 0; at + width <= bytes.size(); at += width) {
    std::reverse(bytes.begin() + static_cast<std::ptrdiff_t>(at),
                 bytes.begin() + static_cast<std::ptrdiff_t>(at + width));
  }
#endif
}

Result<cv::Mat> read_raw(const fs::path& path, const RawLayout& layout) {
  cv::Mat pixels(layout.size, layout.metres ? CV_32FC1 : CV_16UC1);
  const std::size_t expected = pixels.total() * pixels.elemSize();
  Result<Bytes> bytes = read_file(path, expected);
  if (!bytes || bytes->size() != expected) {
    if (!bytes && bytes.reason().find("larger") == std::string::npos) return Error{bytes.reason()};
    return Error{"not the " + std::to_string(expected) + " bytes of " +
                 std::to_string(layout.size.width) + "x" + std::to_string(layout.size.height) +
                 (layout.metres ? " float32" : " uint16") + " pixels; see --raw and --metres"};
  }
  swap_if_big_endian(*bytes, pixels.elemSize());
  std::memcpy(pixels.data, bytes->data(), expected);
  return pixels;
}

Result<cv::Mat> read_image(const fs::path& path) {
  cv::Mat pixels;
  try {
    pixels = cv::imread(path.string(), cv::IMREAD_UNCHANGED);
  } catch (const cv::Exception& error) {
    return Error{"not readable as an image: " + error.err};
  }
  if (pixels.empty()) return Error{"not readable as an image"};
  if (pixels.type() != CV_16UC1 && pixels.type() != CV_32FC1) {
    return Error{"not a depth image: that has one channel of 16 bits (counts) or float (metres)"};
  }
  if (pixels.cols > kMaxImageSide || pixels.rows > kMaxImageSide) {
    return Error{"more than " + std::to_string(kMaxImageSide) + " pixels a side"};
  }
  return pixels;
}

fs::path beside(const fs::path& path) {
  fs::path part = path;
  return part.replace_filename("." + path.stem().string() + ".part" + path.extension().string());
}

Result<bool> put_in_place(const fs::path& part, const fs::path& path) {
  std::error_code error;
  fs::rename(part, path, error);
  if (!error) return true;
  std::error_code ignored;
  fs::remove(part, ignored);
  return Error{"cannot write " + path.string() + ": " + error.message()};
}

}  // namespace

bool is_image_name(const fs::path& path) {
  const std::string name = ending(path);
  return name == ".png" || name == ".tif" || name == ".tiff" || name == ".pgm";
}

Result<cv::Mat> read_depth(const fs::path& path, const std::optional<RawLayout>& layout) {
  std::error_code error;
  if (!fs::is_regular_file(path, error)) return Error{"no such file"};
  if (is_image_name(path)) return read_image(path);
  if (!layout) return Error{"no PNG, TIFF or PGM; a raw file wants --raw WIDTHxHEIGHT"};
  return read_raw(path, *layout);
}

Result<bool> write_depth(const fs::path& path, const cv::Mat& pixels) {
  if (!is_image_name(path)) {
    const std::size_t count = pixels.total() * pixels.elemSize();
    Bytes bytes(pixels.data, pixels.data + count);
    swap_if_big_endian(bytes, pixels.elemSize());
    return write_file(path, bytes);
  }
  const std::string name = ending(path);
  if (pixels.type() == CV_32FC1 && name != ".tif" && name != ".tiff") {
    return Error{"metres (float32) do not fit into " + name + "; write .tiff or .raw"};
  }
  const fs::path part = beside(path);
  try {
    if (!cv::imwrite(part.string(), pixels)) return Error{"cannot write " + part.string()};
  } catch (const cv::Exception& error) {
    return Error{"cannot write " + part.string() + ": " + error.err};
  }
  return put_in_place(part, path);
}

Result<Bytes> read_file(const fs::path& path, std::size_t limit) {
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  if (!file) return Error{std::string("cannot read: ") + std::strerror(errno)};
  const std::streamoff size = file.tellg();
  if (size < 0) return Error{"cannot read: no ordinary file"};
  if (static_cast<std::size_t>(size) > limit) return Error{"larger than any such file"};
  Bytes bytes(static_cast<std::size_t>(size));
  file.seekg(0);
  file.read(reinterpret_cast<char*>(bytes.data()), size);
  if (!file) return Error{"cannot read to the end"};
  return bytes;
}

Result<bool> write_file(const fs::path& path, ByteView bytes) {
  const fs::path part = beside(path);
  std::ofstream file(part, std::ios::binary);
  file.write(reinterpret_cast<const char*>(bytes.data), static_cast<std::streamsize>(bytes.size));
  file.close();
  if (!file) return Error{"cannot write " + part.string() + ": " + std::strerror(errno)};
  return put_in_place(part, path);
}

}  // namespace rprr
