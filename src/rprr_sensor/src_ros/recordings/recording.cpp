// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_sensor_ros/recording.hpp"

#include <filesystem>
#include <utility>

#include "recordings/bag_recording.hpp"
#include "rprr_sensor/recordings/tum_folder.hpp"

namespace rprr {
namespace {

class FolderRecording : public Recording {
 public:
  explicit FolderRecording(TumFolder folder) : folder_(std::move(folder)) {}

  const Camera& camera() const override { return folder_.camera; }
  std::size_t size() const override { return folder_.entries.size(); }
  Result<RecordedFrame> load(std::size_t index) override {
    auto image = folder_.load(index);
    if (!image) return Error{image.reason()};
    const RgbdEntry& entry = folder_.entries[index];
    return RecordedFrame{entry.stamp, std::move(*image), entry.world_from_camera,
                         entry.depth_stamp};
  }
  std::string remark() const override { return folder_.remark; }

 private:
  TumFolder folder_;
};

}  // namespace

Result<std::unique_ptr<Recording>> open_recording(const std::string& path,
                                                  const RecordingOptions& options) {
  std::error_code ignored;
  if (!std::filesystem::is_directory(path, ignored)) return open_bag_recording(path, options);
  TumFolderOptions folder_options;
  folder_options.association_window_s = options.association_window_s;
  auto folder = open_tum_folder(path, folder_options);
  if (!folder) return Error{folder.reason()};
  if (options.camera) folder->camera = *options.camera;
  return std::unique_ptr<Recording>(std::make_unique<FolderRecording>(std::move(*folder)));
}

}  // namespace rprr
