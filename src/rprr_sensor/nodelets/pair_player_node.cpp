// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_geometry_ros/standalone.hpp"

int main(int argc, char** argv) {
  return rprr::run_standalone(argc, argv, "rprr_sensor/PairPlayer");
}
