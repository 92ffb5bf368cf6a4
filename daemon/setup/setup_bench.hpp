#pragma once

/// The devices while a station is set up: opened as the draft says, closed where it says otherwise, and moved only
/// while an answer permits it.

#include <filesystem>
#include <memory>
#include <stop_token>
#include <string>
#include <utility>

#include "core/base/clock.hpp"
#include "core/scan/still.hpp"
#include "daemon/setup/setup_draft.hpp"

namespace fvd {

/// context: one thread.
class SetupBench {
 public:
  /// folder: existing, where pictures are put.
  explicit SetupBench(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// The camera of this configuration, opened where it is not open already. Throws as open_camera().
  [[nodiscard]] Camera& camera(const CameraConfig& config);
  /// The stage likewise, to be read. Opening it halts an axis that moves, and nothing else: it gets torque before its
  /// first motion. Throws as open_stage().
  [[nodiscard]] Axis& stage(const StageConfig& config);
  /// The stage, to be moved. Throws Error kInternal where no answer has permitted that.
  [[nodiscard]] Axis& moving_stage(const StageConfig& config);
  void close_stage() noexcept { stage_.reset(); }

  void permit_motion(bool permitted) noexcept { motion_permitted_ = permitted; }

  /// Takes a picture and writes it as a PNG: the first under a name that is free, then over the one before. Returns
  /// what it shows: sharpness and brightness.
  struct Picture {
    double focus = 0.0;  ///< mean modified Laplacian of the central region, grey levels
    GreyStatistics grey;
    int width_px = 0;
    int height_px = 0;
  };
  [[nodiscard]] Picture take_picture(const SetupDraft& draft, std::stop_token stop);
  [[nodiscard]] const std::filesystem::path& picture() const { return picture_; }  ///< empty = none yet

  [[nodiscard]] Clock& clock() { return clock_; }

 private:
  const std::filesystem::path folder_;
  SystemClock clock_;
  CameraConfig camera_config_;
  StageConfig stage_config_;
  std::unique_ptr<Camera> camera_;
  std::unique_ptr<Axis> stage_;
  std::filesystem::path picture_;
  bool motion_permitted_ = false;
};

}  // namespace fvd
