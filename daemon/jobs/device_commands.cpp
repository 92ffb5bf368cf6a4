#include "daemon/jobs/device_commands.hpp"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <ctime>
#include <exception>
#include <sstream>
#include <stop_token>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

#include "core/focus/grey_statistics.hpp"
#include "core/scan/still.hpp"
#include "daemon/export/durable_file.hpp"
#include "daemon/export/file_calls.hpp"
#include "daemon/export/image_png.hpp"
#include "daemon/export/preview_hub.hpp"
#include "daemon/export/storage_error.hpp"
#include "daemon/jobs/objective_limits.hpp"

namespace fvd {

namespace {

using nlohmann::ordered_json;
namespace fs = std::filesystem;

constexpr std::size_t kSnapsKept = 100;

struct Shot {
  Frame frame;
  CameraSettings settings;  ///< in force
  double z_um = 0.0;
};

/// Puts the camera's settings back, however the work ends; not once it is stopped, because a camera that holds up what
/// was stopped would hold up this as well. Whatever uses the camera next sets it up anyway.
class RestoredSettings {
 public:
  RestoredSettings(Camera& camera, const CameraSettings& settings, std::stop_token stop)
      : camera_(camera), settings_(settings), stop_(std::move(stop)) {}
  ~RestoredSettings() {
    if (stop_.stop_requested()) return;
    try {
      (void)camera_.configure(settings_);
    } catch (const std::exception& error) {
      spdlog::warn("the camera's settings could not be put back: {}", error.what());
    }
  }
  RestoredSettings(const RestoredSettings&) = delete;
  RestoredSettings& operator=(const RestoredSettings&) = delete;

 private:
  Camera& camera_;
  CameraSettings settings_;
  std::stop_token stop_;
};

/// A frame exposed from now on.
Shot shoot(const Devices& devices, const CameraSettings& settings, const std::stop_token& stop) {
  Still still = take_still(devices.camera, devices.clock, settings, stop);
  Shot shot{std::move(still.frame), std::move(still.settings)};
  shot.z_um = devices.stage.mean_position(shot.frame.exposure_start, shot.frame.exposure_end).mean.value;
  return shot;
}

ordered_json grey_json(const GreyStatistics& grey) {
  return {{"min", grey.min}, {"max", grey.max}, {"mean", grey.mean}, {"p01", grey.p01},
          {"p50", grey.p50}, {"p99", grey.p99}, {"p999", grey.p999}, {"saturated_fraction", grey.saturated_fraction}};
}

/// <folder>/20261124T050102Z-<n>.png, n counting within the second.
fs::path new_snap(const fs::path& folder) {
  (void)make_directories(folder);
  std::error_code error;
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  ::gmtime_r(&now, &utc);
  char stem[32];
  std::strftime(stem, sizeof stem, "%Y%m%dT%H%M%SZ", &utc);
  for (int i = 1;; ++i) {
    fs::path path = folder / (std::string(stem) + "-" + std::to_string(i) + ".png");
    if (!fs::exists(path, error)) return path;
  }
}

/// What cannot be removed stays: the new picture is there all the same.
void drop_oldest(const fs::path& folder) {
  std::vector<fs::path> snaps;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    std::error_code ignored;
    if (entry->path().extension() == ".png" && entry->is_regular_file(ignored)) snaps.push_back(entry->path());
  }
  if (snaps.size() <= kSnapsKept) return;
  const auto before = [](const fs::path& a, const fs::path& b) {  // by time, "..Z-10" after "..Z-2"
    const auto key = [](const fs::path& path) { return std::pair(path.string().size(), path.string()); };
    return key(a) < key(b);
  };
  std::sort(snaps.begin(), snaps.end(), before);
  for (std::size_t i = 0; i + kSnapsKept < snaps.size(); ++i) {
    if (file_calls().unlink(snaps[i]) == 0) continue;
    spdlog::warn("there are more than {} pictures: {}", kSnapsKept, storage_error(errno, "remove", snaps[i]).what());
  }
}

void require_target(Micrometers target, const StageInfo& stage) {
  if (target >= stage.min && target <= stage.max) return;
  std::ostringstream message;
  message << "a target of " << target.value << " um is outside " << stage.min.value << ".." << stage.max.value
          << " um; nothing was moved";
  throw Error(ErrorCode::kStageLimit, message.str());
}

}  // namespace

DeviceTask::Work snap_work(const CameraSettings& settings) {
  return [settings](const Devices& devices, const std::stop_token& stop) {
    const Shot shot = shoot(devices, settings, stop);
    if (devices.pictures != nullptr) devices.pictures->take(shot.frame.image, shot.z_um);
    const fs::path folder = devices.state_dir / "snaps";
    const fs::path path = new_snap(folder);
    write_new_file(path, encode_image_png(shot.frame.image));
    drop_oldest(folder);
    return ordered_json{{"path", fs::absolute(path).string()},
                        {"width_px", shot.frame.image.width},
                        {"height_px", shot.frame.image.height},
                        {"bits", significant_bits(shot.frame.image.format)},
                        {"exposure_us", shot.settings.exposure_us},
                        {"gain_db", shot.settings.gain_db},
                        {"z_um", shot.z_um},
                        {"grey", grey_json(grey_statistics(shot.frame.image))}}
        .dump();
  };
}

DeviceTask::Work preview_work(const CameraSettings& settings) {
  return [settings](const Devices& devices, const std::stop_token& stop) {
    const Shot shot = shoot(devices, settings, stop);
    if (devices.pictures != nullptr) return preview_json(*devices.pictures->take(shot.frame.image, shot.z_um));
    PreviewPicture picture = make_preview(shot.frame.image, shot.z_um);
    picture.seq = shot.frame.id;
    return preview_json(picture);
  };
}

DeviceTask::Work exposure_work(const CameraSettings& asked, double target) {
  return [asked, target](const Devices& devices, const std::stop_token& stop) {
    const RestoredSettings restored(devices.camera, asked, stop);
    const ExposureFound found = find_exposure(devices.camera, devices.clock, asked, target, stop);
    return ordered_json{{"exposure_us", found.exposure_us},
                        {"reached", found.reached},
                        {"looks", found.looks},
                        {"grey", grey_json(found.grey)}}
        .dump();
  };
}

DeviceTask::Work autofocus_work(const CameraSettings& settings, const AutofocusPlan& plan) {
  return [settings, plan](const Devices& devices, const std::stop_token& stop) {
    check_limits(devices.objective, devices.stage.info(), [&plan](const StageInfo& stage) { check_plan(plan, stage); });
    (void)devices.camera.configure(settings);
    const AutofocusResult found = autofocus(devices.camera, devices.stage, devices.clock, plan, stop);
    ordered_json curve = ordered_json::array();
    for (const FocusSample& sample : found.curve) curve.push_back({sample.z_um, sample.focus});
    return ordered_json{{"z_um", found.z_um}, {"focus", found.focus}, {"curve_um_focus", std::move(curve)}}.dump();
  };
}

DeviceTask::Work home_work() {
  return [](const Devices& devices, const std::stop_token& stop) {
    devices.stage.home(stop);
    return ordered_json{{"z_um", devices.stage.status().position.value}, {"homed", true}}.dump();
  };
}

DeviceTask::Work reset_work() {
  return [](const Devices& devices, const std::stop_token& stop) {
    devices.stage.reset_alarm(stop);
    const StageStatus stage = devices.stage.status();
    if (stage.alarm || stage.state == AxisState::kAlarm) {
      throw Error(ErrorCode::kStageAlarm, stage.alarm ? "the drive still has its alarm: " + stage.alarm_text
                                                      : "the drive's emergency stop is on: release it, then reset");
    }
    return ordered_json{{"z_um", stage.position.value}, {"homed", stage.homed}}.dump();
  };
}

DeviceTask::Work move_work(Micrometers target) {
  return [target](const Devices& devices, const std::stop_token& stop) {
    check_limits(devices.objective, devices.stage.info(),
                 [target](const StageInfo& stage) { require_target(target, stage); });
    const MoveRecord move = devices.stage.move_to(target, SettleCriterion{}, stop);
    return ordered_json{{"z_um", move.position.value}}.dump();
  };
}

}  // namespace fvd
