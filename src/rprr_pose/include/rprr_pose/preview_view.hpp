// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "rprr_geometry/camera.hpp"
#include "rprr_wire/preview.hpp"

namespace rprr {

/// A block preview as a small RGB-D camera: what pose search works on. Arrays hold one entry a
/// cell, row by row.
struct PreviewView {
  Camera camera;                  // of the cells: pixel (c, r) is the centre of cell (c, r)
  std::vector<float> z;           // [m]; 0 = no reading
  std::vector<float> x, y;        // the cell's point, metres, optical frame
  std::vector<float> nx, ny, nz;  // surface normal towards the camera; 0 0 0 where there is none
  std::vector<float> luma;        // 0 to 255
  std::vector<float> blue, red;   // colour differences to the luma
  std::vector<float> sigma;  // of depth, metres, from the sensor's noise and the preview's rounding

  int width() const { return camera.width; }
  int height() const { return camera.height; }
  std::size_t size() const { return z.size(); }
  int valid_count() const;
};

/// The view at full block resolution. camera is that of the full image.
PreviewView make_view(const BlockPreview& preview, const Camera& camera);

/// Half the resolution: a cell's depth is the mean of 1/z of the cells of its four that share a
/// surface.
PreviewView half_view(const PreviewView& view);

}  // namespace rprr
