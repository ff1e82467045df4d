// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_sensor/recordings/tum_folder.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "recordings/tum_text.hpp"
#include "rprr_geometry/relative_pose.hpp"
#include "rprr_sensor/recordings/tum_writer.hpp"
#include "rprr_synthetic/random.hpp"
#include "rprr_synthetic/temporary_folder.hpp"
#include "rprr_wire/camera_wire.hpp"

namespace rprr {
namespace {

const Camera kCamera{24, 16, 20.5, 21.25, 11.5, 7.5};
constexpr Stamp kFirstStamp = 1305031790645155001;

RgbdImage random_image(std::uint64_t seed, double unit) {
  Random random(seed);
  RgbdImage image{cv::Mat(16, 24, CV_8UC3), {cv::Mat(16, 24, CV_16UC1), unit}};
  for (int v = 0; v < 16; ++v) {
    for (int u = 0; u < 24; ++u) {
      image.depth.counts.at<std::uint16_t>(v, u) = static_cast<std::uint16_t>(random.bits());
      const auto grey = static_cast<std::uint8_t>(random.bits());
      image.bgr.at<cv::Vec3b>(v, u) = {grey, static_cast<std::uint8_t>(grey / 2), 7};
    }
  }
  return image;
}

Pose random_pose(std::uint64_t seed) {
  Random random(seed);
  Twist twist;
  for (int i = 0; i < 6; ++i) twist[i] = random.between(-1.0, 1.0);
  return exp_se3(twist);
}

/// A folder as TumWriter makes it, `frames` long.
void write_folder(const std::string& path, int frames, double unit) {
  auto writer = TumWriter::create(path, kCamera, unit, true, "test");
  ASSERT_TRUE(writer) << writer.reason();
  for (int k = 0; k < frames; ++k) {
    const auto seed = static_cast<std::uint64_t>(k);
    const auto added =
        writer->add(kFirstStamp + k * 33333333LL, random_image(seed, unit), random_pose(seed));
    ASSERT_TRUE(added) << added.reason();
  }
}

bool same(const cv::Mat& a, const cv::Mat& b) {
  return a.size() == b.size() && a.type() == b.type() && cv::norm(a, b, cv::NORM_INF) == 0.0;
}

TEST(TumFolder, WhatIsWrittenIsRead) {
  for (const double unit : {0.001, 0.0002}) {
    const TemporaryFolder temporary;
    write_folder(temporary.path("walk"), 3, unit);
    const auto folder = open_tum_folder(temporary.path("walk"));
    ASSERT_TRUE(folder) << folder.reason();
    EXPECT_EQ(camera_hash(folder->camera), camera_hash(kCamera));
    EXPECT_EQ(folder->depth_unit, unit);
    ASSERT_EQ(folder->entries.size(), 3u);
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_EQ(folder->entries[k].stamp, kFirstStamp + static_cast<Stamp>(k) * 33333333)
          << "stamps keep their nanoseconds";
      ASSERT_TRUE(folder->entries[k].world_from_camera);
      EXPECT_TRUE(folder->entries[k].world_from_camera->isApprox(random_pose(k), 1e-9));
      const auto image = folder->load(k);
      ASSERT_TRUE(image) << image.reason();
      EXPECT_TRUE(same(image->bgr, random_image(k, unit).bgr));
      EXPECT_TRUE(same(image->depth.counts, random_image(k, unit).depth.counts));
      EXPECT_EQ(image->depth.unit, unit);
    }
    EXPECT_FALSE(folder->load(3)) << "there is no fourth entry";
  }
}

TEST(TumFolder, WriterRefusesWhatItCouldNotReadBack) {
  const TemporaryFolder temporary;
  auto writer = TumWriter::create(temporary.path("walk"), kCamera, 0.001, true, "test");
  ASSERT_TRUE(writer);
  const RgbdImage image = random_image(1, 0.001);
  EXPECT_FALSE(writer->add(1, image, std::nullopt)) << "a pose was promised";
  EXPECT_FALSE(writer->add(1, {image.bgr, {image.depth.counts, 0.0002}}, Pose::Identity()));
  EXPECT_FALSE(writer->add(1, {cv::Mat(3, 3, CV_8UC3), image.depth}, Pose::Identity()));
  EXPECT_TRUE(writer->add(2, image, Pose::Identity()));
  EXPECT_FALSE(writer->add(2, image, Pose::Identity())) << "stamps must ascend";
  EXPECT_FALSE(TumWriter::create(temporary.path("walk"), kCamera, 0.001, true, "test"))
      << "an existing recording must not be overwritten";
}

TEST(TumFolder, OriginalSequenceWithoutOurFiles) {
  const TemporaryFolder temporary;
  const std::string root = temporary.path("rgbd_dataset_freiburg2_desk");
  std::filesystem::create_directories(root);
  cv::imwrite(root + "/c.png", cv::Mat::zeros(480, 640, CV_8UC3));
  cv::imwrite(root + "/d.png", cv::Mat::ones(480, 640, CV_16UC1));
  temporary.write("rgbd_dataset_freiburg2_desk/rgb.txt", "# colour\n1.50 c.png\n2.00 c.png\n");
  temporary.write("rgbd_dataset_freiburg2_desk/depth.txt", "1.515 d.png\n2.03 d.png\n");
  temporary.write("rgbd_dataset_freiburg2_desk/groundtruth.txt",
                  "1.40 9 9 9 0 0 0 1\n1.49 1 2 3 0 0 0 1\n1.60 9 9 9 0 0 0 1\n");
  const auto folder = open_tum_folder(root + "/");
  ASSERT_TRUE(folder) << folder.reason();
  EXPECT_EQ(folder->camera.fx, 520.9) << "freiburg2 is known by the folder's name";
  EXPECT_EQ(folder->depth_unit, 0.0002);
  ASSERT_EQ(folder->entries.size(), 1u) << "the second depth image is 0.03 s away";
  EXPECT_EQ(folder->entries[0].depth_stamp, 1515000000);
  ASSERT_TRUE(folder->entries[0].world_from_camera);
  EXPECT_EQ(folder->entries[0].world_from_camera->translation(), Eigen::Vector3d(1, 2, 3));
  const auto image = folder->load(std::size_t{0});
  ASSERT_TRUE(image) << image.reason();
  EXPECT_DOUBLE_EQ(image->depth.metres(3, 4), 0.0002);
}

TEST(TumFolder, GroundTruthOnlyWhereItIsNearAndWanted) {
  const TemporaryFolder temporary;
  write_folder(temporary.path("walk"), 2, 0.001);
  temporary.write("walk/groundtruth.txt", "1305031790.66 0 0 0 0 0 0 1\n");
  auto folder = open_tum_folder(temporary.path("walk"), {0.02, 0.016});
  ASSERT_TRUE(folder) << folder.reason();
  EXPECT_TRUE(folder->entries[0].world_from_camera);
  EXPECT_FALSE(folder->entries[1].world_from_camera) << "18 ms away";
  temporary.write("walk/camera.yaml",
                  "{width: 24, height: 16, fx: 20, fy: 20, cx: 12, cy: 8, "
                  "depth_units_per_metre: 1000, ground_truth: false, frame_stride: 10}");
  folder = open_tum_folder(temporary.path("walk"));
  ASSERT_TRUE(folder) << folder.reason();
  EXPECT_FALSE(folder->entries[0].world_from_camera);
  EXPECT_EQ(folder->frame_stride, 10);
}

// The same two frames in lists as the field writes them.
struct Dialect {
  const char* name;
  const char* file;
  const char* text;
};
class TumFolderDialect : public testing::TestWithParam<Dialect> {};

TEST_P(TumFolderDialect, IsRead) {
  const TemporaryFolder temporary;
  const std::string root = temporary.path("walk");
  std::filesystem::create_directories(root + "/my rgb");
  std::filesystem::create_directories(root + "/depth");
  for (const char* image : {"1", "2"}) {
    cv::imwrite(root + "/my rgb/" + image + ".png", cv::Mat::zeros(480, 640, CV_8UC3));
    cv::imwrite(root + "/depth/" + image + ".png", cv::Mat::ones(480, 640, CV_16UC1));
  }
  temporary.write("walk/rgb.txt", "1.5 my rgb/1.png\n2.5 my rgb/2.png\n");
  temporary.write("walk/depth.txt", "1.5 depth/1.png\n2.5 depth/2.png\n");
  temporary.write("walk/groundtruth.txt", "1.5 1 2 3 0 0 0.6 0.8\n2.5 4 5 6 0 0 0.6 0.8\n");
  temporary.write(std::string("walk/") + GetParam().file, GetParam().text);
  const auto folder = open_tum_folder(root);
  ASSERT_TRUE(folder) << folder.reason();
  ASSERT_EQ(folder->entries.size(), 2u);
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_EQ(folder->entries[k].stamp, from_seconds(1.5 + static_cast<double>(k)));
    const auto image = folder->load(k);
    EXPECT_TRUE(image) << image.reason();
    ASSERT_TRUE(folder->entries[k].world_from_camera) << folder->remark;
    const Pose& pose = *folder->entries[k].world_from_camera;
    EXPECT_TRUE(pose.translation().isApprox(
        Eigen::Vector3d(1, 2, 3) + 3.0 * static_cast<double>(k) * Eigen::Vector3d::Ones()));
    EXPECT_NEAR(pose.linear()(0, 0), 0.28, 1e-9) << "turned about z by w = 0.8";
  }
}

INSTANTIATE_TEST_SUITE_P(
    All, TumFolderDialect,
    testing::Values(
        Dialect{"Plain", "rgb.txt", "1.5 my rgb/1.png\n2.5 my rgb/2.png\n"},
        Dialect{"ByteOrderMark", "rgb.txt",
                "\xef\xbb\xbf# stamps\n1.5 my rgb/1.png\n2.5 my rgb/2.png\n"},
        Dialect{"ByteOrderMarkBeforeANumber", "depth.txt",
                "\xef\xbb\xbf\x31.5 depth/1.png\n2.5 depth/2.png\n"},
        Dialect{"HeaderRow", "rgb.txt", "timestamp filename\n1.5 my rgb/1.png\n2.5 my rgb/2.png\n"},
        Dialect{"Commas", "rgb.txt", "1.5,my rgb/1.png\n2.5, my rgb/2.png\n"},
        Dialect{"FurtherColumns", "depth.txt",
                "1.5 depth/1.png 640 480\n2.5 depth/2.png 640 480\n"},
        Dialect{"Nanoseconds", "rgb.txt", "1500000000.0 x\n1.5 my rgb/1.png\n2.5 my rgb/2.png\n"},
        Dialect{"LineEndsOfWindows", "rgb.txt", "1.5 my rgb/1.png\r\n2.5 my rgb/2.png\r\n"},
        Dialect{"DepthFirst", "associations.txt",
                "1.5 depth/1.png 1.5 my rgb/1.png\n2.5 depth/2.png 2.5 my rgb/2.png\n"},
        Dialect{"ABadEntry", "associations.txt",
                "1.5 my rgb/1.png 1.5 depth/1.png\noops\n2.5 my rgb/2.png 2.5 depth/2.png\n"},
        Dialect{"NaNRow", "groundtruth.txt",
                "1.4 nan nan nan nan nan nan nan\n1.5 1 2 3 0 0 0.6 0.8\n2.5 4 5 6 0 0 0.6 0.8\n"},
        Dialect{"TwelveColumns", "groundtruth.txt",
                "t,x,y,z,qx,qy,qz,qw,vx,vy,vz,s\n1.5,1,2,3,0,0,0.6,0.8,0,0,0,1\n"
                "2.5,4,5,6,0,0,0.6,0.8,0,0,0,1\n"},
        Dialect{"RealPartFirst", "groundtruth.txt",
                "#timestamp, p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], "
                "q_RS_y [], q_RS_z []\n1.5,1,2,3,0.8,0,0,0.6\n2.5,4,5,6,0.8,0,0,0.6\n"},
        Dialect{"Semicolons", "groundtruth.txt", "1.5;1;2;3;0;0;0.6;0.8\n2.5;4;5;6;0;0;0.6;0.8\n"}),
    [](const testing::TestParamInfo<Dialect>& dialect) { return std::string(dialect.param.name); });

TEST(TumText, WholeNumbersTooLargeForSecondsAreOfASmallerUnit) {
  const Stamp stamp = 1403636579763000000;
  EXPECT_EQ(parse_stamp("1403636579.763"), stamp);
  EXPECT_EQ(parse_stamp("1403636579763"), stamp);
  EXPECT_EQ(parse_stamp("1403636579763000"), stamp);
  EXPECT_EQ(parse_stamp("1403636579763000000"), stamp);
  EXPECT_EQ(parse_stamp("17"), 17 * 1000000000LL) << "ICL-NUIM counts frames";
  for (const char* text : {"", ".", "-1", "1e9", "nan", "1.2.3", "9999999999999999999",
                           "99999999999999999999999", "14036365797"}) {
    EXPECT_FALSE(parse_stamp(text)) << text;
  }
}

TEST(TumFolder, SaysWhatItLeftOut) {
  const TemporaryFolder temporary;
  write_folder(temporary.path("walk"), 2, 0.001);
  EXPECT_EQ(open_tum_folder(temporary.path("walk"))->remark, "");
  temporary.write("walk/groundtruth.txt", "5 0 0 0 0 0 0 1\n6 0 0 nan 0 0 0 1\n7 0 0 0 0 0 0 1\n");
  const auto folder = open_tum_folder(temporary.path("walk"));
  ASSERT_TRUE(folder) << folder.reason();
  EXPECT_NE(folder->remark.find("1 of 3 lines"), std::string::npos) << folder->remark;
  EXPECT_NE(folder->remark.find("groundtruth.txt:2"), std::string::npos) << folder->remark;
  EXPECT_NE(folder->remark.find("none of its 2 poses"), std::string::npos) << folder->remark;
}

TEST(TumFolder, KittisMatricesAreNamed) {
  const TemporaryFolder temporary;
  write_folder(temporary.path("walk"), 1, 0.001);
  temporary.write("walk/groundtruth.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n");
  const auto folder = open_tum_folder(temporary.path("walk"));
  ASSERT_FALSE(folder);
  EXPECT_NE(folder.reason().find("KITTI"), std::string::npos) << folder.reason();
}

TEST(TumFolder, ANegativeFocalLengthIsTurnedRoundAndTold) {
  const TemporaryFolder temporary;
  write_folder(temporary.path("walk"), 1, 0.001);
  temporary.write("walk/camera.yaml",
                  "{width: 24, height: 16, fx: 481.2, fy: -480, cx: 12, cy: 8, "
                  "depth_units_per_metre: 1000}");
  const auto folder = open_tum_folder(temporary.path("walk"));
  ASSERT_TRUE(folder) << folder.reason();
  EXPECT_EQ(folder->camera.fy, 480.0);
  EXPECT_NE(folder->remark.find("fy"), std::string::npos) << folder->remark;
}

TEST(TumFolder, AJpegThatIsCutOffIsRefused) {
  const TemporaryFolder temporary;
  write_folder(temporary.path("walk"), 1, 0.001);
  const auto folder = open_tum_folder(temporary.path("walk"));
  ASSERT_TRUE(folder);
  const std::string path = folder->entries[0].colour_path;
  std::vector<std::uint8_t> jpeg;
  cv::imencode(".jpg", random_image(1, 0.001).bgr, jpeg);
  const auto write = [&](std::size_t size) {
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(jpeg.data()), static_cast<std::streamsize>(size));
  };
  write(jpeg.size());
  EXPECT_TRUE(folder->load(std::size_t{0}));
  write(jpeg.size() - 30);
  const auto image = folder->load(std::size_t{0});
  ASSERT_FALSE(image);
  EXPECT_NE(image.reason().find("cut off"), std::string::npos) << image.reason();
}

struct Fault {
  const char* file;
  const char* text;
  const char* named;  // what the error must name
};

class TumFolderFault : public testing::TestWithParam<Fault> {};

TEST_P(TumFolderFault, IsAnErrorThatNamesTheFile) {
  const TemporaryFolder temporary;
  write_folder(temporary.path("walk"), 1, 0.001);
  temporary.write(std::string("walk/") + GetParam().file, GetParam().text);
  const auto folder = open_tum_folder(temporary.path("walk"));
  ASSERT_FALSE(folder) << GetParam().text;
  EXPECT_NE(folder.reason().find(GetParam().named), std::string::npos) << folder.reason();
}

INSTANTIATE_TEST_SUITE_P(
    All, TumFolderFault,
    testing::Values(
        Fault{"associations.txt", "1.0 rgb/a.png 1.0\n", "associations.txt:1"},
        Fault{"associations.txt", "# fine\n\nnan rgb/a.png 1.0 depth/a.png\n",
              "associations.txt:3"},
        Fault{"associations.txt", "-1.0 a 1.0 b\n", "associations.txt:1"},
        Fault{"associations.txt", "99999999999999999999 a 1.0 b\n", "associations.txt:1"},
        Fault{"associations.txt", "", "no colour image"},
        Fault{"groundtruth.txt", "1.0 0 0 nan 0 0 0 1\n", "groundtruth.txt:1"},
        Fault{"groundtruth.txt", "1.0 0 0 inf 0 0 0 1\n", "groundtruth.txt:1"},
        Fault{"groundtruth.txt", "1.0 0 0 0 0 0 0\n", "groundtruth.txt:1"},
        Fault{"groundtruth.txt", "1.0 0 0 0 0 0 0 0\n", "unit quaternion"},
        Fault{"groundtruth.txt", "1.0 0 0 x 0 0 0 1\n", "groundtruth.txt:1"},
        Fault{"camera.yaml", "width: 24\n", "height"}, Fault{"camera.yaml", "][", "camera.yaml"},
        Fault{"camera.yaml", "just words", "camera.yaml"},
        Fault{"camera.yaml",
              "{width: 24, height: 16, fx: .nan, fy: 1, cx: 1, cy: 1, depth_units_per_metre: 1}",
              "camera.yaml"},
        Fault{"camera.yaml",
              "{width: 24, height: 16, fx: 1, fy: 1, cx: 1, cy: 1, depth_units_per_metre: 0}",
              "depth_units_per_metre"},
        Fault{"camera.yaml",
              "{width: 99999, height: 16, fx: 1, fy: 1, cx: 1, cy: 1, depth_units_per_metre: 1}",
              "camera.yaml"},
        Fault{"camera.yaml",
              "{width: wide, height: 16, fx: 1, fy: 1, cx: 1, cy: 1, depth_units_per_metre: 1}",
              "camera.yaml"}));

TEST(TumFolder, NoFolderAndEmptyFolderAreErrors) {
  const TemporaryFolder temporary;
  EXPECT_FALSE(open_tum_folder(temporary.path("nowhere")));
  const auto empty = open_tum_folder(temporary.path());
  ASSERT_FALSE(empty);
  EXPECT_NE(empty.reason().find("associations.txt"), std::string::npos);
}

TEST(TumFolder, BadImagesAreErrorsThatNameThem) {
  const TemporaryFolder temporary;
  write_folder(temporary.path("walk"), 1, 0.001);
  const auto folder = open_tum_folder(temporary.path("walk"));
  ASSERT_TRUE(folder);
  const RgbdEntry entry = folder->entries[0];
  const auto names = [&](const std::string& file) {
    const auto image = folder->load(entry);
    return !image && image.reason().find(file) != std::string::npos;
  };
  cv::imwrite(entry.depth_path, cv::Mat::zeros(16, 24, CV_8UC1));
  EXPECT_TRUE(names(entry.depth_path)) << "8 bits are not depth";
  cv::imwrite(entry.depth_path, cv::Mat::zeros(16, 23, CV_16UC1));
  EXPECT_TRUE(names(entry.depth_path)) << "another size";
  std::ofstream(entry.colour_path) << "not an image";
  EXPECT_TRUE(names(entry.colour_path));
  std::filesystem::remove(entry.colour_path);
  EXPECT_TRUE(names(entry.colour_path));
}

TEST(TumFolder, RealRecordingsOpen) {
  const char* environment = std::getenv("RPRR_DATA");
  const std::string data = environment != nullptr ? environment : RPRR_DATA_FOLDER;
  if (!std::filesystem::exists(data + "/kitchen")) {
    GTEST_SKIP() << "no recordings in " << data << "; set RPRR_DATA";
  }
  for (const char* name : {"kitchen", "office", "freiburg1_360", "household", "tabletop"}) {
    const auto folder = open_tum_folder(data + "/" + name);
    ASSERT_TRUE(folder) << folder.reason();
    const auto image = folder->load(folder->entries.size() - 1);
    EXPECT_TRUE(image) << image.reason();
  }
}

TEST(RelativeMotion, MapsPointsOfAIntoB) {
  const Pose a = random_pose(1);
  const Pose b = random_pose(2);
  const Eigen::Vector3d in_world(0.3, -0.4, 2.0);
  EXPECT_TRUE((relative_pose_of(a, b) * (a.inverse() * in_world)).isApprox(b.inverse() * in_world));
  Pose step = Pose::Identity();
  step.translation().z() = 0.5;  // b stands half a metre before a
  EXPECT_NEAR((relative_pose_of(Pose::Identity(), step) * Eigen::Vector3d(0, 0, 2)).z(), 1.5,
              1e-12);
}

}  // namespace
}  // namespace rprr
