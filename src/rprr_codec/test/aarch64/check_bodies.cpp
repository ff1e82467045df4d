// SPDX-License-Identifier: BSD-3-Clause
// For another processor, where OpenCV and zlib may be missing: decodes the bodies of payloads of
// whole frames and encodes them anew, which must give the same bytes.
//   check_bodies PAYLOAD...
#include <cstdio>
#include <fstream>
#include <iterator>

#include "dhcm/body_decoder.hpp"
#include "dhcm/body_encoder.hpp"
#include "rprr_wire/bytes.hpp"

namespace {

using rprr::Bytes;
using rprr::ByteView;

constexpr std::size_t kHead = 14;  // of a payload whose unit is a float
constexpr std::size_t kTail = 4;   // the checksum

bool comes_back(const Bytes& payload) {
  if (payload.size() < kHead + kTail || payload[0] != rprr::dhcm::kVersion) return false;
  const int width = payload[2] | payload[3] << 8;
  const int height = payload[4] | payload[5] << 8;
  const auto kind = static_cast<rprr::dhcm::Body>(payload[1] & 3);
  const auto mode = static_cast<rprr::DhcmMode>(payload[1] >> 6);
  const ByteView body(payload.data() + kHead, payload.size() - kHead - kTail);
  std::vector<std::uint16_t> counts(static_cast<std::size_t>(width) *
                                    static_cast<std::size_t>(height));
  const auto stride = static_cast<std::size_t>(width);
  rprr::dhcm::BodyDecoder decoder;
  if (!decoder.decode(kind, body, nullptr, {counts.data(), stride, width, height})) return false;
  rprr::dhcm::BodyEncoder encoder;
  Bytes again;
  return encoder.encode({counts.data(), stride, width, height}, nullptr, mode, again) == kind &&
         again == Bytes(body.data, body.data + body.size);
}

}  // namespace

int main(int argc, char** argv) {
  bool good = argc > 1;
  for (int i = 1; i < argc; ++i) {
    std::ifstream file(argv[i], std::ios::binary);
    const Bytes payload((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
    const bool same = comes_back(payload);
    std::printf("%s: %s\n", argv[i], same ? "the same" : "not the same");
    good = good && same;
  }
  return good ? 0 : 1;
}
