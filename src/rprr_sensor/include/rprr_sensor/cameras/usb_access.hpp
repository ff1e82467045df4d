// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace rprr {

/// A USB device's vendor and product.
struct UsbId {
  std::uint16_t vendor = 0;
  std::uint16_t product = 0;
};

struct UsbDevice {
  UsbId id;
  std::string node;         // /dev/bus/usb/001/004
  bool accessible = false;  // we may read and write it
};

/// Devices of these kinds that are plugged in, as Linux lists them. `sysfs` and `dev` are the
/// system's folders; others serve tests.
std::vector<UsbDevice> find_usb_devices(const std::vector<UsbId>& wanted,
                                        const std::string& sysfs = "/sys/bus/usb/devices",
                                        const std::string& dev = "/dev/bus/usb");

/// Why a camera may not open, and the remedy, for a person: none plugged in, no permission, or
/// somebody else has it. `rules` is the Debian package that brings its udev rules, `kernel_module`
/// one that is known to take such cameras (may be empty).
std::string why_not_open(const std::vector<UsbDevice>& devices, const std::string& rules,
                         const std::string& kernel_module);

}  // namespace rprr
