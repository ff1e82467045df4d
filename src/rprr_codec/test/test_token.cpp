// SPDX-License-Identifier: BSD-3-Clause
#include "dhcm/token.hpp"

#include <gtest/gtest.h>

namespace rprr::dhcm {
namespace {

TEST(Token, EveryResidualHasASymbolOfItsKindAndComesBack) {
  for (std::uint32_t residual = 0; residual < 65536; ++residual) {
    const Split split = split_number(fold(static_cast<std::uint16_t>(residual)));
    ASSERT_LT(split.symbol, kResidualSymbols) << residual << ": that symbol is a hole's";
    ASSERT_EQ(split.extra_bits, extra_bits_of(split.symbol));
    ASSERT_EQ(unfold(base_of(split.symbol) + split.extra), residual);
  }
}

TEST(Token, SmallResidualsHaveSmallNumbersWhateverTheirSign) {
  EXPECT_EQ(fold(0), 0u);
  EXPECT_EQ(fold(1), 1u);
  EXPECT_EQ(fold(65535), 2u);
  EXPECT_EQ(fold(32768), 65535u);
}

}  // namespace
}  // namespace rprr::dhcm
