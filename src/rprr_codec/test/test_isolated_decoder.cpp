// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>
#include <thread>

#include "rprr_codec/colour_codec.hpp"
#include "rprr_synthetic/coded_images.hpp"
#include "rprr_wire/bytes.hpp"

namespace rprr {
namespace {

namespace fs = std::filesystem;

// Names another worker for the life of the object.
class OtherWorker {
 public:
  explicit OtherWorker(const std::string& path) { ::setenv("RPRR_COLOUR_WORKER", path.c_str(), 1); }
  ~OtherWorker() { ::unsetenv("RPRR_COLOUR_WORKER"); }
  OtherWorker(const OtherWorker&) = delete;
  OtherWorker& operator=(const OtherWorker&) = delete;
};

fs::path script(const std::string& name, const std::string& body) {
  const fs::path path =
      fs::temp_directory_path() / ("rprr_" + std::to_string(::getpid()) + "_" + name);
  std::ofstream(path) << "#!/bin/sh\n" << body << "\n";
  ::chmod(path.c_str(), 0755);
  return path;
}

std::size_t open_descriptors() {
  return static_cast<std::size_t>(
      std::distance(fs::directory_iterator("/proc/self/fd"), fs::directory_iterator()));
}

class IsolatedDecoder : public ::testing::Test {
 protected:
  IsolatedDecoder() : image_(synthetic::colourful(160, 120)) { payload_ = payload_of("pgf", 4); }
  Bytes payload_of(const std::string& codec, int quality) const {
    return *(*make_colour_encoder(codec))->encode(image_, quality);
  }
  void expect_good(ColourDecoder& decoder) {
    const Result<cv::Mat> isolated = decoder.decode("pgf", payload_, image_.size());
    ASSERT_TRUE(isolated) << isolated.reason();
    const Result<cv::Mat> local =
        make_local_colour_decoder()->decode("pgf", payload_, image_.size());
    EXPECT_TRUE(synthetic::same(*isolated, *local));
  }

  cv::Mat image_;
  Bytes payload_;
};

TEST_F(IsolatedDecoder, DecodesAsTheLocalOneDoes) {
  const auto decoder = make_isolated_colour_decoder();
  for (int i = 0; i < 5; ++i) expect_good(*decoder);
  for (const std::string& codec : colour_codecs()) {
    const Bytes payload = payload_of(codec, 20);
    const Result<cv::Mat> isolated = decoder->decode(codec, payload, image_.size());
    ASSERT_TRUE(isolated) << codec << ": " << isolated.reason();
    EXPECT_TRUE(synthetic::same(
        *isolated, *make_local_colour_decoder()->decode(codec, payload, image_.size())));
    for (const std::string& other : colour_codecs()) {
      EXPECT_EQ(static_cast<bool>(decoder->decode(other, payload, image_.size())), other == codec);
    }
  }
  EXPECT_FALSE(decoder->decode("pgf", payload_, cv::Size(120, 160)));
  EXPECT_FALSE(decoder->decode("pgf", {}, image_.size()));
  EXPECT_FALSE(decoder->decode("pgf", payload_, cv::Size(0, 0)));
  EXPECT_FALSE(decoder->decode("pgf", payload_, cv::Size(100000, 100000)));
  EXPECT_FALSE(decoder->decode(std::string(300, 'x'), payload_, image_.size()));
  expect_good(*decoder);
}

TEST_F(IsolatedDecoder, HostilePayloadsCostOneErrorEach) {
  const auto decoder = make_isolated_colour_decoder({0.5, std::size_t{512} << 20});
  std::mt19937 random(8);
  for (const std::string& codec : colour_codecs()) {
    const Bytes payload = payload_of(codec, 10);
    int errors = 0;
    for (int trial = 0; trial < 200; ++trial) {
      Bytes hostile(payload.begin(), payload.end() - 4);
      // Half of them in the headers, where decoders are weakest.
      const std::size_t reach = trial % 2 == 0 ? 40 : hostile.size();
      for (std::uint32_t i = 0; i <= random() % 4; ++i) {
        hostile[random() % reach] = static_cast<std::uint8_t>(random());
      }
      if (trial % 7 == 0) hostile.resize(random() % hostile.size());
      seal(hostile);
      const Result<cv::Mat> image = decoder->decode(codec, hostile, image_.size());
      errors += image ? 0 : 1;
      if (image) {
        EXPECT_EQ(image->size(), image_.size());
      }
      if (trial % 20 == 0) expect_good(*decoder);
    }
    EXPECT_GT(errors, 20) << codec << ": the mutations were too tame";
  }
  expect_good(*decoder);
}

TEST_F(IsolatedDecoder, AMissingWorkerIsNamedInTheError) {
  const OtherWorker other("/nowhere/rprr_colour_worker");
  const Result<cv::Mat> image =
      make_isolated_colour_decoder()->decode("pgf", payload_, image_.size());
  ASSERT_FALSE(image);
  EXPECT_NE(image.reason().find("/nowhere/rprr_colour_worker"), std::string::npos)
      << image.reason();
}

TEST_F(IsolatedDecoder, AWorkerThatHangsIsKilledInTime) {
  const fs::path hang = script("hang", "exec sleep 600");
  const auto decoder = make_isolated_colour_decoder({0.2, std::size_t{512} << 20});
  {
    const OtherWorker other(hang.string());
    const auto start = std::chrono::steady_clock::now();
    EXPECT_FALSE(decoder->decode("pgf", payload_, image_.size()));
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(20));
  }
  fs::remove(hang);
  expect_good(*decoder);
}

TEST_F(IsolatedDecoder, AWorkerThatDiesTalksNonsenseOrEchoesIsAnError) {
  const fs::path die = script("die", "exit 3");
  const fs::path garbage = script("garbage", "exec 1>&0; head -c 100000 /dev/zero | tr '\\0' 'x'");
  const fs::path liar = script("liar", "exec 1>&0; printf '\\000\\377\\377aaaa'");
  for (const fs::path& path : {die, garbage, liar, fs::path("/bin/cat"), fs::path("/bin/true")}) {
    const auto decoder = make_isolated_colour_decoder({0.5, std::size_t{512} << 20});
    {
      const OtherWorker other(path.string());
      for (int i = 0; i < 3; ++i) {
        EXPECT_FALSE(decoder->decode("pgf", payload_, image_.size())) << path;
      }
    }
    expect_good(*decoder);
  }
  for (const fs::path& path : {die, garbage, liar}) fs::remove(path);
}

TEST_F(IsolatedDecoder, AWorkerKilledBetweenImagesIsReplaced) {
  const auto decoder = make_isolated_colour_decoder();
  expect_good(*decoder);
  // Our only child is the decoder's worker.
  const std::string children = "/proc/self/task/" + std::to_string(::getpid()) + "/children";
  std::ifstream list(children);
  pid_t child = 0;
  if (!(list >> child)) GTEST_SKIP() << "this kernel does not list children";
  ::kill(child, SIGKILL);
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  expect_good(*decoder);
}

TEST_F(IsolatedDecoder, NoDescriptorAndNoProcessIsLeftBehind) {
  const std::size_t before = open_descriptors();
  for (int i = 0; i < 10; ++i) {
    const auto decoder = make_isolated_colour_decoder();
    expect_good(*decoder);
  }
  {
    const OtherWorker other("/nowhere");
    make_isolated_colour_decoder()->decode("pgf", payload_, image_.size());
  }
  EXPECT_EQ(open_descriptors(), before);
  EXPECT_EQ(::waitpid(-1, nullptr, WNOHANG), -1) << "a child is left";
  EXPECT_EQ(errno, ECHILD);
}

}  // namespace
}  // namespace rprr
