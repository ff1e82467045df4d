// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_sensor/cameras/usb_access.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>

namespace rprr {
namespace {

/// The number in a file of sysfs; -1 if there is none.
int read_number(const std::filesystem::path& path, int base) {
  std::string text;
  if (!(std::ifstream(path) >> text)) return -1;
  try {
    return std::stoi(text, nullptr, base);
  } catch (const std::exception&) {
    return -1;
  }
}

std::string node_path(const std::string& dev, int bus, int number) {
  char name[32];
  std::snprintf(name, sizeof name, "/%03d/%03d", bus, number);
  return dev + name;
}

}  // namespace

std::vector<UsbDevice> find_usb_devices(const std::vector<UsbId>& wanted, const std::string& sysfs,
                                        const std::string& dev) {
  std::vector<UsbDevice> found;
  std::error_code failed;
  for (std::filesystem::directory_iterator entry(sysfs, failed), end; !failed && entry != end;
       entry.increment(failed)) {
    const std::filesystem::path path = entry->path();
    const int vendor = read_number(path / "idVendor", 16);
    const int product = read_number(path / "idProduct", 16);
    const bool is_wanted = std::any_of(wanted.begin(), wanted.end(), [&](const UsbId& id) {
      return id.vendor == vendor && id.product == product;
    });
    const int bus = read_number(path / "busnum", 10);
    const int number = read_number(path / "devnum", 10);
    if (!is_wanted || bus < 0 || number < 0) continue;
    const std::string node = node_path(dev, bus, number);
    found.push_back({{static_cast<std::uint16_t>(vendor), static_cast<std::uint16_t>(product)},
                     node,
                     access(node.c_str(), R_OK | W_OK) == 0});
  }
  return found;
}

std::string why_not_open(const std::vector<UsbDevice>& devices, const std::string& rules,
                         const std::string& kernel_module) {
  if (devices.empty()) {
    return "no camera is plugged in: check its cable and, of a Kinect, its power supply (its "
           "motor shows up in lsusb without it, its camera does not)";
  }
  for (const UsbDevice& device : devices) {
    if (device.accessible) continue;
    return "no permission for the camera at " + device.node + ": the udev rules of package " +
           rules +
           " give it; install that, join group plugdev (sudo adduser $USER plugdev, log in "
           "again), unplug the camera and plug it in again";
  }
  std::string text = "the camera at " + devices.front().node + " is there but does not open: ";
  text += "another program may have it";
  if (!kernel_module.empty()) {
    text += ", or the kernel's own driver (sudo modprobe -r " + kernel_module + ")";
  }
  return text;
}

}  // namespace rprr
