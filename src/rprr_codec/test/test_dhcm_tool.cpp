// SPDX-License-Identifier: BSD-3-Clause
// The command line tool, as a user runs it.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <opencv2/imgcodecs.hpp>

#include "rprr_codec/dhcm.hpp"
#include "rprr_synthetic/coded_images.hpp"

namespace rprr {
namespace {

namespace fs = std::filesystem;

struct Outcome {
  int code = -1;
  std::string text;  // both streams
};

Outcome run(const std::string& arguments) {
  Outcome outcome;
  FILE* pipe = ::popen((std::string(RPRR_DHCM_TOOL) + " " + arguments + " 2>&1").c_str(), "r");
  if (pipe == nullptr) return outcome;
  std::array<char, 512> part{};
  while (std::fgets(part.data(), part.size(), pipe) != nullptr) outcome.text += part.data();
  const int status = ::pclose(pipe);
  outcome.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return outcome;
}

class DhcmTool : public ::testing::Test {
 protected:
  DhcmTool() {
    std::string name = (fs::temp_directory_path() / "rprr_dhcm_XXXXXX").string();
    folder_ = ::mkdtemp(name.data());
  }
  ~DhcmTool() override { fs::remove_all(folder_); }

  std::string at(const std::string& name) const { return (folder_ / name).string(); }
  void write(const std::string& name, const std::string& bytes) const {
    std::ofstream(at(name), std::ios::binary) << bytes;
  }
  std::string read(const std::string& name) const {
    std::ifstream file(at(name), std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  cv::Mat image(const std::string& name) const {
    return cv::imread(at(name), cv::IMREAD_UNCHANGED);
  }

  const cv::Mat counts_ = synthetic::kinect_like(100, 60).counts;
  fs::path folder_;
};

std::string bytes_of(const cv::Mat& pixels) {
  return {reinterpret_cast<const char*>(pixels.data), pixels.total() * pixels.elemSize()};
}

TEST_F(DhcmTool, ExplainsItself) {
  const Outcome help = run("--help");
  EXPECT_EQ(help.code, 0);
  for (const char* word : {"encode", "decode", "info"}) {
    EXPECT_NE(help.text.find(word), std::string::npos) << help.text;
    EXPECT_EQ(run(std::string(word) + " --help").code, 0);
  }
  EXPECT_NE(run("").code, 0);
  EXPECT_NE(run("explode").code, 0);
}

TEST_F(DhcmTool, TakesAPngThereAndBackInEveryMode) {
  cv::imwrite(at("depth.png"), counts_);
  for (const std::string mode : {"fast", "default", "small"}) {
    const Outcome encoded =
        run("encode --verify -f --unit 0.0002 -m " + mode + " " + at("depth.png"));
    ASSERT_EQ(encoded.code, 0) << encoded.text;
    EXPECT_NE(encoded.text.find("1 file encoded"), std::string::npos) << encoded.text;
    const Outcome info = run("info " + at("depth.dhcm"));
    EXPECT_EQ(info.code, 0);
    EXPECT_NE(info.text.find("100x60"), std::string::npos) << info.text;
    EXPECT_NE(info.text.find("counts of 0.0002 m"), std::string::npos) << info.text;
    const Outcome decoded = run("decode -f " + at("depth.dhcm") + " -o " + at("back.png"));
    ASSERT_EQ(decoded.code, 0) << decoded.text;
    EXPECT_TRUE(synthetic::same(image("back.png"), counts_)) << mode;
  }
}

TEST_F(DhcmTool, TakesRawFilesThereAndBack) {
  cv::Mat metres = to_float_image({counts_, 0.001});
  metres.at<float>(0, 0) = -1.5f;
  write("counts.raw", bytes_of(counts_));
  write("metres.raw", bytes_of(metres));
  ASSERT_EQ(run("encode --raw 100x60 " + at("counts.raw")).code, 0);
  ASSERT_EQ(run("encode --verify --raw 100x60 --metres " + at("metres.raw")).code, 0);
  ASSERT_EQ(
      run("decode --raw -o " + at("out") + "/ " + at("counts.dhcm") + " " + at("metres.dhcm")).code,
      0);
  EXPECT_EQ(read("out/counts.raw"), bytes_of(counts_));
  EXPECT_EQ(read("out/metres.raw"), bytes_of(metres));
}

TEST_F(DhcmTool, KeepsFloatImagesAndSaysAStep) {
  const cv::Mat metres = to_float_image({counts_, 0.001});
  ASSERT_TRUE(cv::imwrite(at("metres.tiff"), metres));
  ASSERT_EQ(run("encode --verify " + at("metres.tiff")).code, 0);
  ASSERT_EQ(run("decode " + at("metres.dhcm") + " -o " + at("back")).code, 0);
  EXPECT_EQ(read("back").size(), bytes_of(metres).size());
  const Outcome rough =
      run("encode --verify --step 0.01 " + at("metres.tiff") + " -o " + at("rough.dhcm"));
  ASSERT_EQ(rough.code, 0) << rough.text;
  EXPECT_LT(fs::file_size(at("rough.dhcm")), fs::file_size(at("metres.dhcm")));
  const Outcome info = run("info " + at("metres.dhcm") + " " + at("rough.dhcm"));
  EXPECT_NE(info.text.find("float32, lossless"), std::string::npos) << info.text;
  EXPECT_NE(info.text.find("steps of 0.01 m"), std::string::npos) << info.text;
  ASSERT_EQ(run("decode -f " + at("metres.dhcm")).code, 0);
  EXPECT_EQ(bytes_of(image("metres.tiff")), bytes_of(metres));
}

TEST_F(DhcmTool, WalksFoldersAndKeepsTheirShape) {
  fs::create_directories(at("in/more"));
  for (const char* name : {"in/a.png", "in/b.png", "in/more/a.png"}) {
    cv::imwrite(at(name), counts_);
  }
  write("in/notes.txt", "not an image");
  const Outcome encoded = run("encode " + at("in") + " -o " + at("coded"));
  ASSERT_EQ(encoded.code, 0) << encoded.text;
  EXPECT_NE(encoded.text.find("3 files encoded"), std::string::npos) << encoded.text;
  ASSERT_EQ(run("decode " + at("coded") + " -o " + at("back")).code, 0);
  EXPECT_TRUE(synthetic::same(image("back/more/a.png"), counts_));
  EXPECT_NE(run("info " + at("coded")).text.find("3 files"), std::string::npos);
}

TEST_F(DhcmTool, GoesOnAfterABadFileAndNamesIt) {
  fs::create_directories(at("in"));
  cv::imwrite(at("in/a.png"), counts_);
  cv::imwrite(at("in/c.png"), counts_);
  write("in/b.png", "no image");
  cv::imwrite(at("in/colour.png"), synthetic::colourful(32, 32));
  const Outcome encoded = run("encode " + at("in"));
  EXPECT_EQ(encoded.code, 1);
  EXPECT_NE(encoded.text.find("b.png: not readable"), std::string::npos) << encoded.text;
  EXPECT_NE(encoded.text.find("colour.png: not a depth image"), std::string::npos);
  EXPECT_NE(encoded.text.find("2 files encoded"), std::string::npos) << encoded.text;
  EXPECT_TRUE(fs::exists(at("in/c.dhcm")));
  EXPECT_FALSE(fs::exists(at("in/b.dhcm")));
}

TEST_F(DhcmTool, RefusesWhatIsDamagedOrMissing) {
  cv::imwrite(at("a.png"), counts_);
  ASSERT_EQ(run("encode " + at("a.png")).code, 0);
  std::string bytes = read("a.dhcm");
  bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 1);
  write("damaged.dhcm", bytes);
  EXPECT_EQ(run("decode " + at("damaged.dhcm")).code, 1);
  EXPECT_EQ(run("info " + at("damaged.dhcm")).code, 1);
  EXPECT_FALSE(fs::exists(at("damaged.png")));
  EXPECT_EQ(run("decode " + at("nothing.dhcm")).code, 1);
  EXPECT_EQ(run("encode " + at("empty_folder_that_is_not_there")).code, 1);
  write("short.raw", "xx");
  EXPECT_EQ(run("encode --raw 100x60 " + at("short.raw")).code, 1);
  EXPECT_EQ(run("encode " + at("short.raw")).code, 1);
  EXPECT_EQ(run("encode --raw 0x60 " + at("short.raw")).code, 1);
}

TEST_F(DhcmTool, ReplacesNothingUnasked) {
  cv::imwrite(at("a.png"), counts_);
  ASSERT_EQ(run("encode " + at("a.png")).code, 0);
  const Outcome again = run("encode " + at("a.png"));
  EXPECT_EQ(again.code, 1);
  EXPECT_NE(again.text.find("--force"), std::string::npos) << again.text;
  EXPECT_EQ(run("decode " + at("a.dhcm")).code, 1);  // a.png is there
  EXPECT_TRUE(synthetic::same(image("a.png"), counts_));
  cv::imwrite(at("a.tiff"), counts_);
  EXPECT_EQ(run("encode -f " + at("a.png") + " " + at("a.tiff")).code, 1);  // both a.dhcm
}

}  // namespace
}  // namespace rprr
