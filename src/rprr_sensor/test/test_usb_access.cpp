// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_sensor/cameras/usb_access.hpp"

#include <gtest/gtest.h>

#include "rprr_synthetic/temporary_folder.hpp"

namespace rprr {
namespace {

const std::vector<UsbId> kKinect = {{0x045e, 0x02ae}};

void plug_in(const TemporaryFolder& folder, const std::string& port, const std::string& vendor,
             const std::string& product) {
  std::filesystem::create_directories(folder.path(port));
  folder.write(port + "/idVendor", vendor + "\n");
  folder.write(port + "/idProduct", product + "\n");
  folder.write(port + "/busnum", "1\n");
  folder.write(port + "/devnum", "7\n");
}

TEST(UsbAccess, FindsOnlyWhatIsWanted) {
  const TemporaryFolder folder;
  plug_in(folder, "1-1", "045e", "02ae");
  plug_in(folder, "1-2", "045e", "02b0");
  std::filesystem::create_directories(folder.path("1-2:1.0"));
  folder.write("1-3", "no folder");
  const auto found = find_usb_devices(kKinect, folder.path(), folder.path("dev"));
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].node, folder.path("dev") + "/001/007");
  EXPECT_FALSE(found[0].accessible) << "there is no such node";
  std::filesystem::create_directories(folder.path("dev/001"));
  folder.write("dev/001/007", "");
  EXPECT_TRUE(find_usb_devices(kKinect, folder.path(), folder.path("dev"))[0].accessible);
}

TEST(UsbAccess, NoSysfsIsNoDevice) {
  EXPECT_TRUE(find_usb_devices(kKinect, "/no/such/folder").empty());
}

TEST(UsbAccess, EachCauseHasItsRemedy) {
  const auto says = [](const std::vector<UsbDevice>& devices, const std::string& what) {
    return why_not_open(devices, "some-rules", "some_module").find(what) != std::string::npos;
  };
  EXPECT_TRUE(says({}, "plugged in"));
  EXPECT_TRUE(
      says({{kKinect[0], "/dev/bus/usb/001/007", false}}, "udev rules of package some-rules"));
  EXPECT_TRUE(says({{kKinect[0], "/dev/bus/usb/001/007", true}}, "modprobe -r some_module"));
}

}  // namespace
}  // namespace rprr
