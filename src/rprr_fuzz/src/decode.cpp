// SPDX-License-Identifier: BSD-3-Clause
// Any bytes as a depth payload: as they are, and with version, size, lengths and checksum made good
// so that the fuzzer reaches what lies behind them.
#include "fuzz.hpp"
#include "rprr_codec/dhcm.hpp"
#include "rprr_geometry/block_mask.hpp"
#include "rprr_wire/bytes.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static rprr::DhcmDecoder decoder(rprr::fuzz::kMaxPixels);
  const rprr::ByteView view(data, size);
  decoder.decode(view);
  rprr::dhcm_info(view);
  const rprr::Bytes good = rprr::fuzz::made_good(view);
  decoder.decode(good);
  decoder.decode_float(good);
  const rprr::Result<rprr::DhcmInfo> info = rprr::dhcm_info(good);
  if (!info || std::size_t(info->width) * info->height > rprr::fuzz::kMaxPixels) return 0;
  rprr::BlockMask mask(rprr::BlockGrid(info->width, info->height));
  for (int block = 0; block < mask.grid().count(); ++block) mask.set(block, block % 3 != 0);
  decoder.decode(good, mask);
  return 0;
}
