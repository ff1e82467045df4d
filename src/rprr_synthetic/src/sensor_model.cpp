// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_synthetic/sensor_model.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "rprr_synthetic/random.hpp"

namespace rprr {
namespace {

/// Noise of deviation 1 for every pixel, averaged over a window of the given side.
cv::Mat correlated_noise(const cv::Size& size, int side, std::uint64_t seed) {
  cv::Mat noise(size, CV_32FC1);
  std::uint64_t place = mix_bits(seed);
  for (int v = 0; v < size.height; ++v) {
    auto* row = noise.ptr<float>(v);
    for (int u = 0; u < size.width; ++u) row[u] = nearly_gaussian(mix_bits(place++));
  }
  if (side <= 1) return noise;
  // The mean of side^2 independent values has 1/side of their deviation.
  cv::Mat smooth;
  cv::boxFilter(noise, smooth, CV_32F, {side, side}, {-1, -1}, true, cv::BORDER_REFLECT_101);
  smooth *= static_cast<float>(side);
  return smooth;
}

/// The exact depth with its edges shaken: block matching does not know them to the pixel.
cv::Mat shake_edges(const cv::Mat& metres, const cv::Mat& shift_u, const cv::Mat& shift_v,
                    double pixels) {
  cv::Mat shaken(metres.size(), CV_32FC1);
  for (int v = 0; v < metres.rows; ++v) {
    for (int u = 0; u < metres.cols; ++u) {
      const auto shift = [&](const cv::Mat& field) {
        return static_cast<int>(std::lround(pixels * field.at<float>(v, u)));
      };
      const int row = std::clamp(v + shift(shift_v), 0, metres.rows - 1);
      const int column = std::clamp(u + shift(shift_u), 0, metres.cols - 1);
      const float there = metres.at<float>(row, column);
      const float here = metres.at<float>(v, u);
      // Only across edges: on one surface the exact depth stays.
      const bool edge = std::abs(there - here) > 0.04f * here;
      shaken.at<float>(v, u) = edge ? there : here;
    }
  }
  return shaken;
}

/// Clears what the projector, to the right of the camera, cannot light: going leftwards, whatever
/// lies behind the ray that a nearer surface has cut off.
void cast_shadows(cv::Mat& metres, const Camera& camera, double baseline) {
  const double shift = camera.fx * baseline;
  for (int v = 0; v < metres.rows; ++v) {
    auto* row = metres.ptr<float>(v);
    double leftmost = 1e9;  // pixel in the projector's image
    for (int u = metres.cols - 1; u >= 0; --u) {
      if (row[u] <= 0.0f) continue;
      const double lit = u - shift / row[u];
      if (lit > leftmost + 0.5) {
        row[u] = 0.0f;
      } else {
        leftmost = std::min(leftmost, lit);
      }
    }
  }
}

void clear_rim(cv::Mat& metres) {
  // Shares of a registered 640x480 Kinect frame: 8 columns left, 16 right, 5 rows above.
  const int left = metres.cols / 80;
  const int right = metres.cols / 40;
  const int top = metres.rows / 96;
  metres.colRange(0, left).setTo(0.0f);
  metres.colRange(metres.cols - right, metres.cols).setTo(0.0f);
  metres.rowRange(0, top).setTo(0.0f);
}

/// Inverse depth with noise, in even steps, as counts of 1 mm.
std::uint16_t quantised(float metres, float noise, const DepthSensorModel& model) {
  const double inverse = 1.0 / metres + model.noise * noise;
  const double steps = model.step > 0.0 ? std::round(inverse / model.step) * model.step : inverse;
  if (steps <= 0.0) return 0;
  const double z = 1.0 / steps;
  if (z < model.min_metres || z > model.max_metres) return 0;
  return static_cast<std::uint16_t>(std::lround(std::min(z * 1000.0, 65535.0)));
}

std::array<std::uint8_t, 4096> gamma_table() {
  std::array<std::uint8_t, 4096> table{};
  for (std::size_t i = 0; i < table.size(); ++i) {
    const double linear = static_cast<double>(i) / 4095.0;
    table[i] = static_cast<std::uint8_t>(std::lround(255.0 * std::pow(linear, 1.0 / 2.2)));
  }
  return table;
}

std::uint8_t noisy(std::uint8_t value, float noise) {
  // Shot noise grows with light, gamma shrinks it again; what is left is a little more in the dark.
  const float deviation = 1.3f - 0.6f * static_cast<float>(value) / 255.0f;
  return static_cast<std::uint8_t>(
      std::clamp(std::lround(static_cast<float>(value) + deviation * noise), 0L, 255L));
}

}  // namespace

DepthFrame sense_depth(const ExactView& view, const Camera& camera, const DepthSensorModel& model,
                       std::uint32_t seed) {
  const cv::Size size = view.metres.size();
  const std::uint64_t stream = std::uint64_t{seed} << 32;
  cv::Mat metres = view.metres.clone();
  if (model.baseline > 0.0) cast_shadows(metres, camera, model.baseline);
  if (model.edge_jitter > 0.0) {
    metres = shake_edges(metres, correlated_noise(size, 5, stream + 1),
                         correlated_noise(size, 5, stream + 2), model.edge_jitter);
  }
  if (model.rim) clear_rim(metres);
  const cv::Mat noise = correlated_noise(size, model.correlation, stream + 3);
  DepthFrame frame;
  frame.unit = 0.001;
  frame.counts = cv::Mat::zeros(size, CV_16UC1);
  for (int v = 0; v < size.height; ++v) {
    for (int u = 0; u < size.width; ++u) {
      const float z = metres.at<float>(v, u);
      const float n = noise.at<float>(v, u);
      if (z <= 0.0f || view.infrared.at<float>(v, u) + 0.02f * n < model.least_infrared) continue;
      frame.counts.at<std::uint16_t>(v, u) = quantised(z, n, model);
    }
  }
  return frame;
}

cv::Mat sense_colour(const ExactView& view, const ColourSensorModel& model, std::uint32_t seed) {
  static const std::array<std::uint8_t, 4096> kGamma = gamma_table();
  cv::Mat light = view.radiance;
  if (model.blur > 0.0) cv::GaussianBlur(view.radiance, light, {5, 5}, model.blur);
  const float centre_u = 0.5f * static_cast<float>(light.cols - 1);
  const float centre_v = 0.5f * static_cast<float>(light.rows - 1);
  const float corner = centre_u * centre_u + centre_v * centre_v + 1.0f;
  cv::Mat image(light.size(), CV_8UC3);
  std::uint64_t place = mix_bits((std::uint64_t{seed} << 32) + 4);
  for (int v = 0; v < light.rows; ++v) {
    const auto* in = light.ptr<cv::Vec3f>(v);
    auto* out = image.ptr<cv::Vec3b>(v);
    for (int u = 0; u < light.cols; ++u) {
      const float du = static_cast<float>(u) - centre_u;
      const float dv = static_cast<float>(v) - centre_v;
      const double fall = 1.0 - model.vignetting * (du * du + dv * dv) / corner;
      const float all = 0.7f * nearly_gaussian(mix_bits(place++));
      for (int c = 0; c < 3; ++c) {
        const double value =
            in[u][c] * fall * model.exposure * model.gain[static_cast<std::size_t>(c)];
        const auto index = static_cast<std::size_t>(std::clamp(value, 0.0, 1.0) * 4095.0);
        const float own = 0.7f * nearly_gaussian(mix_bits(place++));
        out[u][c] = noisy(kGamma[index], static_cast<float>(model.noise) * (all + own));
      }
    }
  }
  return image;
}

RgbdImage sense(const Scene& scene, const SensorModel& sensor, const Pose& world_from_camera,
                std::uint32_t seed) {
  const ExactView view = scene.render(sensor.camera, world_from_camera);
  return {sense_colour(view, sensor.colour, seed),
          sense_depth(view, sensor.camera, sensor.depth, seed)};
}

SensorModel example_sensor_a(int width, int height) {
  const double scale = width / 640.0;
  SensorModel sensor;
  sensor.camera = {
      width, height, 525.0 * scale, 525.0 * scale, 0.5 * width - 0.5, 0.5 * height - 0.5};
  sensor.colour.exposure = 1.05;
  return sensor;
}

SensorModel example_sensor_b(int width, int height) {
  const double scale = width / 640.0;
  SensorModel sensor;
  sensor.camera = {width,
                   height,
                   531.5 * scale,
                   530.0 * scale,
                   0.5 * width + 3.2 * scale,
                   0.5 * height - 4.7 * scale};
  sensor.colour.exposure = 0.92;
  sensor.colour.gain = {0.95, 1.0, 1.06};
  sensor.colour.vignetting = 0.2;
  return sensor;
}

}  // namespace rprr
