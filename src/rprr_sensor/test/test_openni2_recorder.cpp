// SPDX-License-Identifier: BSD-3-Clause
//
// test_openni2_recorder FILE.oni FRAMES: records the first camera of OpenNI2, without loss.
#include <OpenNI.h>

#include <cstdlib>
#include <iostream>

int main(int argc, char** argv) {
  if (argc != 3 || openni::OpenNI::initialize() != openni::STATUS_OK) return 2;
  const auto check = [](openni::Status status) {
    if (status == openni::STATUS_OK) return;
    std::cerr << openni::OpenNI::getExtendedError() << std::endl;
    std::exit(1);
  };
  openni::Device device;
  check(device.open(openni::ANY_DEVICE));
  openni::VideoStream colour, depth;
  check(colour.create(device, openni::SENSOR_COLOR));
  check(depth.create(device, openni::SENSOR_DEPTH));
  openni::Recorder recorder;
  check(recorder.create(argv[1]));
  check(recorder.attach(colour, false));
  check(recorder.attach(depth, false));
  check(colour.start());
  check(depth.start());
  check(recorder.start());
  openni::VideoFrameRef frame;
  for (int k = 0; k < std::atoi(argv[2]); ++k) {
    check(colour.readFrame(&frame));
    check(depth.readFrame(&frame));
  }
  recorder.stop();
  recorder.destroy();
  colour.destroy();
  depth.destroy();
  device.close();
  openni::OpenNI::shutdown();
  return 0;
}
