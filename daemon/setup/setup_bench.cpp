#include "daemon/setup/setup_bench.hpp"

#include <string>
#include <system_error>
#include <utility>

#include "core/base/error.hpp"
#include "core/scan/autofocus.hpp"
#include "daemon/export/durable_file.hpp"
#include "daemon/export/file_calls.hpp"
#include "daemon/export/image_png.hpp"

namespace fvd {

Camera& SetupBench::camera(const CameraConfig& config) {
  if (camera_ && (!(camera_config_ == config) || !camera_->connected())) camera_.reset();
  if (!camera_) {
    camera_ = open_camera(config);
    camera_config_ = config;
  }
  return *camera_;
}

Axis& SetupBench::stage(const StageConfig& config) {
  if (stage_ && (!(stage_config_ == config) || !stage_->connected())) stage_.reset();
  if (!stage_) {
    stage_ = open_stage(config);
    stage_config_ = config;
  }
  return *stage_;
}

Axis& SetupBench::moving_stage(const StageConfig& config) {
  if (!motion_permitted_)
    throw Error(ErrorCode::kInternal, "the setup was about to move the axis without being told to");
  return stage(config);
}

SetupBench::Picture SetupBench::take_picture(const SetupDraft& draft, std::stop_token stop) {
  const Still still = take_still(camera(draft.devices.camera), clock_, draft.picture, std::move(stop));
  const ImageView& image = still.frame.image;
  std::error_code none_there;
  if (picture_.empty()) {
    // A picture that somebody else put there stays.
    std::filesystem::path file = folder_ / "setup.png";
    for (int i = 2; std::filesystem::exists(std::filesystem::symlink_status(file, none_there)); ++i) {
      file = folder_ / ("setup-" + std::to_string(i) + ".png");
    }
    write_new_file(file, encode_image_png(image));
    picture_ = file;
  } else {
    remove_file(picture_);
    write_new_file(picture_, encode_image_png(image));
  }
  return {mean_focus(image, central_region(image.width, image.height)), grey_statistics(image), image.width,
          image.height};
}

}  // namespace fvd
