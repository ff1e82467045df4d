// SPDX-License-Identifier: BSD-3-Clause
// Recorded frames with ground truth: a floor under the quality of what is predicted.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <sstream>

#include "rprr_view/view_synthesis.hpp"

namespace rprr {
namespace {

const Camera kCamera{640, 480, 528, 528, 318.75, 239.75};

struct Frame {
  cv::Mat bgr;
  DepthFrame depth;
  Pose to_world;
};

std::string kitchen() {
  const char* folder = std::getenv("RPRR_DATA");
  return std::string(folder != nullptr ? folder : RPRR_DATA_DIR) + "/kitchen/";
}

// Entry `index` of associations.txt, which names the same instants as groundtruth.txt.
Frame load(int index) {
  std::ifstream associations(kitchen() + "associations.txt");
  std::string line;
  for (int i = -1; i < index; ++i) std::getline(associations, line);
  std::string stamp;
  std::string rgb;
  std::string depth;
  std::istringstream(line) >> stamp >> rgb >> stamp >> depth;
  Frame frame;
  frame.bgr = cv::imread(kitchen() + rgb);
  frame.depth = {cv::imread(kitchen() + depth, cv::IMREAD_UNCHANGED), 0.001};
  std::ifstream truth(kitchen() + "groundtruth.txt");
  while (std::getline(truth, line)) {
    std::string at;
    Eigen::Vector3d t;
    Eigen::Vector4d q;
    std::istringstream(line) >> at >> t.x() >> t.y() >> t.z() >> q[0] >> q[1] >> q[2] >> q[3];
    if (at == stamp) frame.to_world = make_pose(t, q);
  }
  return frame;
}

double psnr(const cv::Mat& x, const cv::Mat& y, const cv::Mat& mask) {
  cv::Mat difference;
  cv::absdiff(x, y, difference);
  difference.convertTo(difference, CV_32F);
  const cv::Scalar mean = cv::mean(difference.mul(difference), mask);
  return 10 * std::log10(255 * 255 * 3 / (mean[0] + mean[1] + mean[2]));
}

class Kitchen : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Pairs, Kitchen, testing::Values(5, 25, 40));

TEST_P(Kitchen, PredictionIsGoodAndBackwardIsBetter) {
  if (!std::filesystem::exists(kitchen() + "associations.txt")) {
    GTEST_SKIP() << "no recorded frames in " << kitchen() << "; set RPRR_DATA";
  }
  const Frame a = load(GetParam());
  const Frame b = load(GetParam() + 1);
  const Pose b_from_a = b.to_world.inverse() * a.to_world;
  double quality[2] = {0, 0};
  for (const int i : {0, 1}) {
    SynthesisOptions options;
    options.mode = i == 0 ? Synthesis::kForward : Synthesis::kBackward;
    PredictedView view;
    ViewSynthesizer(options).synthesize(a.depth, a.bgr, kCamera, kCamera, b_from_a, view);
    const cv::Mat known = view.provenance != kNothing;
    EXPECT_GT(cv::countNonZero(known), 640 * 480 / 2);
    quality[i] = psnr(view.bgr, b.bgr, known);
    EXPECT_GT(quality[i], 20.0) << "dB over predicted pixels";
  }
  EXPECT_GT(quality[1], quality[0]);
}

}  // namespace
}  // namespace rprr
