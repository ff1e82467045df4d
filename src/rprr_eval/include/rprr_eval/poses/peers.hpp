// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "rprr_geometry/result.hpp"
#include "rprr_pose/registration.hpp"

namespace rprr {

/// Well-known methods to compare with, in a library of their own (rprr_eval_methods): both robots'
/// whole images are taken for granted, and none verifies its result. Errors: the peer was not built
/// in, and which package it wants.
using PeerResult = Result<std::unique_ptr<Registration>>;

/// PCL's IterativeClosestPointWithNormals, point-to-plane, every fourth row and column of both
/// clouds, correspondences within 0.3 m, at most 50 iterations.
PeerResult make_pcl_point_to_plane();

/// PCL's generalised ICP on the same clouds, as PCL sets it up otherwise.
PeerResult make_pcl_gicp();

/// 500 ORB features a frame (OpenCV), brute-force matching with cross-check, PnP by RANSAC with a's
/// depth (3 pixels), refined on the inliers. Needs colour; converged from 12 inliers on. The
/// residual is in pixels; bytes are b's features: 32 of a descriptor and 4 of a position each.
PeerResult make_orb_pnp();

/// Open3D's fast global registration of FPFH features, voxels of 5 cm. It ignores the start.
PeerResult make_open3d_fgr();

}  // namespace rprr
