// SPDX-License-Identifier: BSD-3-Clause
#include "colour/jpeg.hpp"

#include <csetjmp>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <opencv2/core.hpp>

#include "colour/checks.hpp"
#include "rprr_wire/bytes.hpp"

// After what it needs.
#include <jpeglib.h>

namespace rprr {
namespace {

// libjpeg reports errors by a call that must not return: we jump back to where it was called. The
// functions that it jumps over hold nothing that has a destructor.
struct ErrorTrap {
  jpeg_error_mgr manager;  // first: libjpeg knows the whole by this member
  std::jmp_buf back;
  char reason[JMSG_LENGTH_MAX] = {};
};

[[noreturn]] void jump_back(j_common_ptr image) {
  auto* trap = reinterpret_cast<ErrorTrap*>(image->err);
  trap->manager.format_message(image, trap->reason);
  std::longjmp(trap->back, 1);
}

void arm(ErrorTrap& trap) {
  jpeg_std_error(&trap.manager);
  trap.manager.error_exit = jump_back;
  trap.manager.output_message = [](j_common_ptr) {};  // not to stderr: warnings are counted
}

struct Compressor {
  jpeg_compress_struct state = {};
  ErrorTrap trap;
  unsigned char* bytes = nullptr;
  unsigned long count = 0;

  Compressor() { arm(trap); }
  ~Compressor() {
    jpeg_destroy_compress(&state);
    std::free(bytes);
  }
  Compressor(const Compressor&) = delete;
  Compressor& operator=(const Compressor&) = delete;
};

bool compress(Compressor& to, const cv::Mat& bgr, int quality) {
  to.state.err = &to.trap.manager;
  if (setjmp(to.trap.back) != 0) return false;
  jpeg_create_compress(&to.state);
  jpeg_mem_dest(&to.state, &to.bytes, &to.count);
  to.state.image_width = static_cast<JDIMENSION>(bgr.cols);
  to.state.image_height = static_cast<JDIMENSION>(bgr.rows);
  to.state.input_components = 3;
  to.state.in_color_space = JCS_EXT_BGR;
  jpeg_set_defaults(&to.state);
  jpeg_set_quality(&to.state, quality, TRUE);
  to.state.optimize_coding = TRUE;
  to.state.write_JFIF_header = FALSE;  // its 18 bytes say nothing that we do not know
  jpeg_start_compress(&to.state, TRUE);
  while (to.state.next_scanline < to.state.image_height) {
    // libjpeg only reads, though it takes a pointer to non-const.
    auto* row = const_cast<JSAMPLE*>(bgr.ptr<JSAMPLE>(static_cast<int>(to.state.next_scanline)));
    jpeg_write_scanlines(&to.state, &row, 1);
  }
  jpeg_finish_compress(&to.state);
  return true;
}

struct Decompressor {
  jpeg_decompress_struct state = {};
  ErrorTrap trap;

  Decompressor() { arm(trap); }
  ~Decompressor() { jpeg_destroy_decompress(&state); }
  Decompressor(const Decompressor&) = delete;
  Decompressor& operator=(const Decompressor&) = delete;
};

// Into an image of the size that the payload must have.
bool decompress(Decompressor& from, ByteView jpeg, cv::Mat& bgr) {
  from.state.err = &from.trap.manager;
  if (setjmp(from.trap.back) != 0) return false;
  jpeg_create_decompress(&from.state);
  jpeg_mem_src(&from.state, jpeg.data, static_cast<unsigned long>(jpeg.size));
  jpeg_read_header(&from.state, TRUE);
  if (from.state.image_width != static_cast<JDIMENSION>(bgr.cols) ||
      from.state.image_height != static_cast<JDIMENSION>(bgr.rows) ||
      from.state.num_components != 3) {
    return false;
  }
  from.state.out_color_space = JCS_EXT_BGR;
  jpeg_start_decompress(&from.state);
  while (from.state.output_scanline < from.state.output_height) {
    auto* row = bgr.ptr<JSAMPLE>(static_cast<int>(from.state.output_scanline));
    jpeg_read_scanlines(&from.state, &row, 1);
  }
  jpeg_finish_decompress(&from.state);
  return from.state.err->num_warnings == 0;  // what it could only guess at
}

std::uint16_t big_endian(ByteView bytes) {
  return static_cast<std::uint16_t>(bytes.data[0] << 8 | bytes.data[1]);
}

// Walks the segments to the frame header of a baseline or progressive image (ITU-T T.81, B.1).
Result<cv::Size> stated_size(ByteView jpeg) {
  ByteReader reader(jpeg);
  const auto marker = [&] {
    return reader.get<std::uint8_t>() == 0xFF ? reader.get<std::uint8_t>() : 0;
  };
  if (marker() != 0xD8) return Error{"colour payload damaged or cut short"};
  while (reader.ok()) {
    const int kind = marker();
    const ByteView length = reader.get_view(2);
    if (kind == 0 || length.size == 0 || big_endian(length) < 2) break;
    const ByteView segment = reader.get_view(big_endian(length) - 2u);
    if (kind < 0xC0 || kind > 0xC2) continue;
    if (segment.size < 6 || segment.data[0] != 8 || segment.data[5] != 3) break;
    return possible_size(big_endian(segment.from(3)), big_endian(segment.from(1)));
  }
  return Error{"colour payload is no JPEG image in 8-bit colours"};
}

}  // namespace

Result<Bytes> JpegEncoder::encode(const cv::Mat& bgr, int quality) {
  const std::string wrong = unencodable(bgr, quality, info());
  if (!wrong.empty()) return Error{wrong};
  Compressor compressor;
  if (!compress(compressor, bgr, quality)) {
    return Error{std::string("encoding JPEG: ") + compressor.trap.reason};
  }
  Bytes payload;
  payload.reserve(compressor.count + 4);
  payload.assign(compressor.bytes, compressor.bytes + compressor.count);
  seal(payload);
  return payload;
}

Result<cv::Size> jpeg_payload_size(ByteView payload) {
  return stated_size(unseal(payload));
}

Result<cv::Mat> decode_jpeg(ByteView payload, cv::Size expected) {
  const ByteView jpeg = unseal(payload);
  const Result<cv::Size> size = stated_size(jpeg);
  if (!size) return Error{size.reason()};
  if (*size != expected) return Error{"colour payload is of another size than expected"};
  cv::Mat bgr(expected, CV_8UC3);
  Decompressor decompressor;
  if (!decompress(decompressor, jpeg, bgr)) {
    return Error{std::string("decoding JPEG: ") + decompressor.trap.reason};
  }
  return bgr;
}

}  // namespace rprr
