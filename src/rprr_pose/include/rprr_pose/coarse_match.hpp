// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "rprr_geometry/se3.hpp"
#include "rprr_pose/pinhole.hpp"
#include "rprr_pose/preview_view.hpp"

namespace rprr {

/// How two very coarse views match under a motion, judged thousands of times in a search.
struct CoarseScore {
  float colour = 0.0f;   // correlation of luma and colour differences where the views meet, up to 2
  float depth = 0.0f;    // how far depths agree there, up to 1
  float overlap = 0.0f;  // share of the moving view's cells that land in the fixed one
};

/// A fixed and a moving view, laid out for that.
class CoarseMatch {
 public:
  CoarseMatch(const PreviewView& moving, const PreviewView& fixed);

  /// `fixed_from_moving` maps points of the moving view into the fixed one; `tolerance` is the
  /// relative depth difference from which on depths do not agree at all.
  CoarseScore judge(const Eigen::Matrix3f& rotation, const Eigen::Vector3f& translation,
                    float tolerance) const;

  /// Mean point, in the fixed view's frame, of what lands in the fixed view; 2 m ahead if nothing
  /// does.
  Eigen::Vector3d middle(const Pose& fixed_from_moving) const;

  /// Median depth of the moving view, metres: what cells without a reading are taken for.
  float typical_depth() const { return typical_depth_; }

 private:
  // Luma, blue and red difference, inverse depth (0: none): one cell in four lanes.
  using Lane = Eigen::Array<float, 4, 1>;
  static constexpr std::size_t kChunk = 64;
  struct Place {
    int point, cell;
    float depth;  // of the moved point
  };
  using Landed = std::array<Place, kChunk + 1>;  // the last one for what landed nowhere

  std::size_t land(const Eigen::Matrix3f& rotation, const Eigen::Vector3f& translation,
                   std::size_t begin, Landed& out) const;

  Pinhole fixed_camera_;
  float typical_depth_ = 2.0f;
  std::vector<float> x_, y_, z_;  // the moving view's points, at the typical depth where it is
                                  // not known
  std::vector<Lane, Eigen::aligned_allocator<Lane>> moving_, fixed_;  // fixed_: with a rim
  std::vector<std::uint8_t> inside_;  // of fixed_: 1, or 0 on the rim
};

}  // namespace rprr
