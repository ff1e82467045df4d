// SPDX-License-Identifier: BSD-3-Clause
// The coders built for another processor, whose lanes are other instructions: golden payloads
// decode there, and what is encoded there is the same bytes.
#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

TEST(DhcmAarch64, GoldenPayloadsComeBackWithTheSameBytes) {
  const std::string emulator = RPRR_AARCH64_EMULATOR;
  const std::string checker = RPRR_AARCH64_CHECKER;
  if (emulator.empty() || checker.empty()) {
    GTEST_SKIP() << "g++-aarch64-linux-gnu or qemu-user was missing when this was configured";
  }
  std::string command = "'" + emulator + "' '" + checker + "'";
  for (const char* name : {"fast", "fast_large", "default", "small", "ranked", "stored"}) {
    command += std::string(" '") + RPRR_GOLDEN_FOLDER + "/" + name + ".dhcm'";
  }
  EXPECT_EQ(std::system(command.c_str()), 0) << command;
}
