// SPDX-License-Identifier: BSD-3-Clause
// Seeds for the fuzzers, from synthetic frames:
//   make_corpus FOLDER
// writes FOLDER/decode, round_trip, mask, preview, container, colour, chunks and station.
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <opencv2/core.hpp>

#include "rprr_codec/colour_codec.hpp"
#include "rprr_codec/dhcm.hpp"
#include "rprr_codec/encoded_frame.hpp"
#include "rprr_radio/frame_chunk.hpp"
#include "rprr_synthetic/coded_images.hpp"
#include "rprr_wire/bytes.hpp"
#include "rprr_wire/mask_wire.hpp"
#include "rprr_wire/preview.hpp"

namespace {

namespace fs = std::filesystem;
using namespace rprr;

class Folder {
 public:
  explicit Folder(const fs::path& path) : path_(path) { fs::create_directories(path); }
  void add(const Bytes& bytes) {
    std::ofstream(path_ / std::to_string(count_++), std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
  }

 private:
  fs::path path_;
  int count_ = 0;
};

Bytes without_seal(Bytes bytes) {
  bytes.resize(bytes.size() - 4);
  return bytes;
}

void depth(const fs::path& root) {
  Folder decode(root / "decode");
  Folder round_trip(root / "round_trip");
  for (const DepthFrame& frame : {synthetic::kinect_like(64, 48), synthetic::kinect_like(45, 30),
                                  synthetic::noise(9, 9), synthetic::constant(100, 70, 900)}) {
    const BlockMask mask(BlockGrid(frame.width(), frame.height()), true);
    cv::Mat metres;
    frame.counts.convertTo(metres, CV_32F, 0.0009);  // within 65535 mm
    for (const DhcmMode mode : {DhcmMode::kFast, DhcmMode::kDefault, DhcmMode::kSmall}) {
      DhcmEncoder encoder(mode);
      decode.add(without_seal(encoder.encode(frame)));
      decode.add(without_seal(encoder.encode(frame, mask)));
      for (const double step : {0.0, 0.001}) {
        const Result<Bytes> payload = encoder.encode_float(metres, step);
        if (payload)
          decode.add(without_seal(*payload));  // not where a reading is below half a step
      }
      Bytes image = {static_cast<std::uint8_t>(mode), static_cast<std::uint8_t>(frame.width() - 1)};
      image.insert(image.end(), frame.counts.data, frame.counts.data + 2 * frame.counts.total());
      round_trip.add(image);
    }
  }
}

void masks(const fs::path& root) {
  Folder folder(root / "mask");
  const BlockGrid grid(1 + 60 * 5, 1 + 70 * 3);
  for (const double share : {0.0, 0.1, 0.5, 1.0}) {
    const BlockMask outer = synthetic::some_blocks(grid, share);
    const BlockMask inner = synthetic::region(grid, share / 2);
    for (const Bytes& bytes : {encode_mask(outer), encode_mask_pair({outer, outer}),
                               encode_mask_pair({BlockMask(grid, true), inner})}) {
      Bytes seed = {60, 70};
      const Bytes content = without_seal(bytes);
      seed.insert(seed.end(), content.begin(), content.end());
      folder.add(seed);
    }
  }
}

void previews(const fs::path& root) {
  Folder folder(root / "preview");
  const cv::Mat bgr = synthetic::colourful(160, 120);
  const DepthFrame frame = synthetic::kinect_like(160, 120);
  for (const int quality : {0, 50}) {
    folder.add(without_seal(encode_preview(make_preview(frame, bgr), quality)));
    folder.add(without_seal(encode_preview(make_exact_preview(frame, bgr), quality)));
  }
}

void containers(const fs::path& root) {
  Folder folder(root / "container");
  EncodedFrame frame;
  frame.camera = Camera{64, 48, 60.0, 60.0, 32.0, 24.0};
  frame.colour_codec = "pgf";
  frame.colour = {1, 2, 3};
  const DepthFrame image = synthetic::kinect_like(64, 48);
  frame.depth = DhcmEncoder().encode(image);
  folder.add(without_seal(serialise(frame)));
  frame.sparse = true;
  frame.reference = "a";
  frame.mask = synthetic::some_blocks(BlockGrid(64, 48), 0.5);
  frame.depth = DhcmEncoder(DhcmMode::kFast).encode(image, frame.mask);
  folder.add(without_seal(serialise(frame)));
  frame.colour_layout = ColourLayout::kCompact;
  frame.base_codec = "webp";
  frame.base = {4, 5, 6};
  frame.base_reduction = 4;
  folder.add(without_seal(serialise(frame)));
}

void colours(const fs::path& root) {
  Folder folder(root / "colour");
  const cv::Mat bgr = synthetic::colourful(72, 48);
  for (const std::string& codec : colour_codecs()) {
    folder.add(without_seal(*(*make_colour_encoder(codec))->encode(bgr, 10)));
  }
}

Bytes small_frame(bool sparse) {
  EncodedFrame frame;
  frame.camera = Camera{64, 48, 60.0, 60.0, 32.0, 24.0};
  frame.colour_codec = "webp";
  frame.colour = {1, 2, 3};
  const DepthFrame image = synthetic::kinect_like(64, 48);
  if (!sparse) {
    frame.depth = DhcmEncoder().encode(image);
    return serialise(frame);
  }
  frame.sparse = true;
  frame.reference = "a";
  frame.reference_stamp = 1;
  frame.mask = synthetic::some_blocks(BlockGrid(64, 48), 0.3);
  frame.depth = DhcmEncoder().encode(image, frame.mask);
  frame.base_codec = "webp";
  frame.base = {4, 5, 6};
  frame.base_reduction = 4;
  return serialise(frame);
}

std::vector<Bytes> in_chunks(const Bytes& data, std::size_t piece) {
  std::vector<Bytes> chunks;
  const auto count = static_cast<std::uint16_t>((data.size() + piece - 1) / piece);
  for (std::uint16_t i = 0; i < count; ++i) {
    const ByteView rest = ByteView(data).from(i * piece);
    chunks.push_back(serialise(FrameChunk{9, i, count, rest.first(std::min(piece, rest.size))}));
  }
  return chunks;
}

void chunks(const fs::path& root) {
  Folder folder(root / "chunks");
  Bytes seed;
  for (const Bytes& chunk : in_chunks(Bytes(500, 7), 120)) {
    seed.push_back(1);
    seed.push_back(static_cast<std::uint8_t>(chunk.size() - 4));
    seed.insert(seed.end(), chunk.begin(), chunk.end() - 4);
  }
  folder.add(seed);
}

void stations(const fs::path& root) {
  Folder folder(root / "station");
  const auto append = [](Bytes& seed, std::uint8_t head, const Bytes& message) {
    const std::size_t length = message.size() - 4;
    seed.push_back(head);
    seed.push_back(static_cast<std::uint8_t>(length));
    seed.push_back(static_cast<std::uint8_t>(length >> 8));
    seed.insert(seed.end(), message.begin(), message.end() - 4);
  };
  constexpr std::uint8_t kA = 1 | 2 | 1 << 2;  // sealed, robot a, stamp 1
  constexpr std::uint8_t kB = 1 | 1 << 2;
  Bytes in_order;
  append(in_order, kA, small_frame(false));
  append(in_order, kB, small_frame(true));
  folder.add(in_order);
  Bytes waits;
  append(waits, kB, small_frame(true));
  append(waits, kA, small_frame(false));
  folder.add(waits);
  Bytes pieces;
  for (const Bytes& chunk : in_chunks(small_frame(false), 700)) append(pieces, kA, chunk);
  append(pieces, kB, small_frame(true));
  folder.add(pieces);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: make_corpus FOLDER\n");
    return 2;
  }
  depth(argv[1]);
  masks(argv[1]);
  previews(argv[1]);
  containers(argv[1]);
  colours(argv[1]);
  chunks(argv[1]);
  stations(argv[1]);
  return 0;
}
