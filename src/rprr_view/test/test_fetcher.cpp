// SPDX-License-Identifier: BSD-3-Clause
#include "../src/fetcher.hpp"

#include <gtest/gtest.h>

#include <array>
#include <opencv2/core.hpp>
#include <random>

namespace rprr {
namespace {

// The same in plain numbers: along the columns first, then down, each time rounded.
int bilinear(const cv::Mat& bgr, int x_steps, int y_steps, int channel) {
  const int u = x_steps / Fetcher::kOne, v = y_steps / Fetcher::kOne;
  const auto mix = [](int a, int b, int share) {
    return a + (((b - a) * share + Fetcher::kOne / 2) >> Fetcher::kBits);
  };
  const auto at = [&](int column, int row) {
    return bgr.at<cv::Vec3b>(std::min(row, bgr.rows - 1), std::min(column, bgr.cols - 1))[channel];
  };
  const int across = x_steps % Fetcher::kOne;
  return mix(mix(at(u, v), at(u + 1, v), across), mix(at(u, v + 1), at(u + 1, v + 1), across),
             y_steps % Fetcher::kOne);
}

TEST(Fetcher, BilinearColoursOfAllPlaces) {
  std::mt19937 random(11);
  for (const cv::Size size : {cv::Size(17, 11), cv::Size(2, 3), cv::Size(1, 5), cv::Size(9, 1)}) {
    cv::Mat bgr(size, CV_8UC3);
    for (int i = 0; i < 3 * size.area(); ++i) bgr.data[i] = static_cast<std::uint8_t>(random());
    const DepthFrame depth{cv::Mat::zeros(size, CV_16UC1), 0.001};
    const Fetcher fetcher(depth, bgr, 0.05f);
    constexpr int kCount = 400;
    std::array<float, kCount> x, y;
    for (std::size_t i = 0; i < kCount; ++i) {
      x[i] = static_cast<float>(random() % (128 * static_cast<unsigned>(size.width))) / 128 - 0.5f;
      y[i] = static_cast<float>(random() % (128 * static_cast<unsigned>(size.height))) / 128 - 0.5f;
    }
    std::array<int, kCount> nearest, column, row, across, down;
    const FetchPlaces places{nearest.data(), column.data(), row.data(), across.data(), down.data()};
    fetcher.find_places(x.data(), y.data(), kCount, places);
    for (std::size_t i = 0; i < kCount; ++i) {
      const auto steps = [](float at, int count) {
        return static_cast<int>(
            std::min(std::max(at, 0.0f), static_cast<float>(count - 1)) * Fetcher::kOne + 0.5f);
      };
      ASSERT_GE(nearest[i], 0) << "(" << x[i] << ", " << y[i] << ") is in the image";
      std::array<std::uint8_t, 3> colour{};
      fetcher.fetch(places, static_cast<int>(i), colour.data());
      for (int k = 0; k < 3; ++k) {
        EXPECT_EQ(colour[static_cast<std::size_t>(k)],
                  bilinear(bgr, steps(x[i], size.width), steps(y[i], size.height), k))
            << "at (" << x[i] << ", " << y[i] << ") of " << size;
      }
    }
  }
}

TEST(Fetcher, PlacesOutOfTheImageAndNumbersThatAreNone) {
  const cv::Mat bgr(4, 6, CV_8UC3, cv::Scalar::all(9));
  const DepthFrame depth{cv::Mat(4, 6, CV_16UC1, cv::Scalar(1000)), 0.001};
  const Fetcher fetcher(depth, bgr, 0.05f);
  const std::array<float, 5> x{-0.6f, 5.6f, 2, std::nanf(""), 3};
  const std::array<float, 5> y{1, 1, 3.6f, 1, 2};
  std::array<int, 5> nearest, column, row, across, down;
  fetcher.find_places(x.data(), y.data(), 5,
                      {nearest.data(), column.data(), row.data(), across.data(), down.data()});
  std::array<float, 5> seen;
  std::array<std::uint8_t, 5> shows;
  fetcher.look(nearest.data(), 5, seen.data());
  const std::array<float, 5> z{1, 1, 1, 1, 1.04f};
  fetcher.compare(nearest.data(), seen.data(), z.data(), 5, shows.data());
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(shows[i], 0) << "place " << i;
  EXPECT_EQ(shows[4], 1) << "the same surface";
  const std::array<float, 5> other{1, 1, 1, 1, 1.2f};
  fetcher.compare(nearest.data(), seen.data(), other.data(), 5, shows.data());
  EXPECT_EQ(shows[4], 0) << "another surface";
}

}  // namespace
}  // namespace rprr
