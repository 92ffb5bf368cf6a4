#pragma once

/// Scans with known truth for bench_accuracy: of a simulated world on an ideal axis, and of the generated stacks.

#include <array>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "core/focus/streaming_focus_stack.hpp"
#include "core/runtime/worker_pool.hpp"
#include "sim/axis/axis_model.hpp"
#include "sim/world/sim_world.hpp"

namespace fvd::bench {

/// Mean and RMS of height minus truth, and RMS of the predicted standard errors. Unit: that of the errors added.
struct ErrorSum {
  double sum = 0.0;
  double squares = 0.0;
  double predicted = 0.0;
  double count = 0.0;
  double largest = 0.0;

  void add(double error, double sigma) {
    sum += error;
    squares += error * error;
    predicted += sigma * sigma;
    count += 1.0;
    largest = std::max(largest, std::abs(error));
  }
  void add(const ErrorSum& other) {
    sum += other.sum;
    squares += other.squares;
    predicted += other.predicted;
    count += other.count;
    largest = std::max(largest, other.largest);
  }
  [[nodiscard]] double rms() const { return std::sqrt(squares / count); }
  [[nodiscard]] double bias() const { return sum / count; }
  [[nodiscard]] double sigma_ratio() const { return std::sqrt(predicted / squares); }
};

/// Slices of a world at given heights, on an ideal axis.
class WorldScan {
 public:
  explicit WorldScan(const sim::WorldParameters& parameters) : world_(parameters, axis_) {}

  [[nodiscard]] const sim::Surface& surface() const { return world_.surface(); }

  /// One Mono8 slice; z is rounded to the axis' step, 0.01 um.
  [[nodiscard]] std::vector<std::byte> slice(double z_um, std::uint64_t index) {
    time_ += std::chrono::seconds(5);
    axis_.move_to(time_, static_cast<std::int32_t>(std::lround(z_um * 100)), 1e6, 1e7, 1e7);
    time_ += std::chrono::seconds(5);
    sim::ExposureRequest request;
    request.width = world_.sensor_width();
    request.height = world_.sensor_height();
    request.start = time_;
    request.end = time_ + std::chrono::milliseconds(5);
    request.exposure_index = index;
    std::vector<std::byte> pixels(static_cast<std::size_t>(request.width) * static_cast<std::size_t>(request.height));
    world_.render(request, pixels);
    return pixels;
  }

  /// A whole scan into a stack, which is told the nominal z. actual(k, z): true z of slice k of nominal height z, um.
  [[nodiscard]] std::unique_ptr<StreamingFocusStack> scan(
      double start_um, double step_um, int slices, const FocusSettings& settings, WorkerPool& pool,
      const std::function<double(int, double)>& actual = [](int, double z) { return z; }) {
    auto stack = std::make_unique<StreamingFocusStack>(world_.sensor_width(), world_.sensor_height(),
                                                       PixelFormat::kMono8, settings, pool);
    for (int k = 0; k < slices; ++k) {
      const double z_um = std::round((start_um + step_um * k) * 100) / 100;
      const auto pixels = slice(actual(k, z_um), static_cast<std::uint64_t>(k));
      stack->push(
          {PixelFormat::kMono8, world_.sensor_width(), world_.sensor_height(), world_.sensor_width(), pixels.data()},
          z_um);
    }
    return stack;
  }

 private:
  static sim::AxisParameters ideal_axis() {
    sim::AxisParameters axis;
    axis.power_on_position_um = 0.0;
    return axis;
  }

  sim::AxisModel axis_{ideal_axis()};
  HostTime time_ = HostClock::now();
  sim::SimWorld world_;
};

struct Reference {
  const char* key;
  const char* folder;
  double slices_per_truth;  ///< slices per unit of truth.tiff
  double first_slice;       ///< value of truth.tiff at the first slice, in slices
};
inline constexpr Reference kReferences[]{{"cou1_rms", "generated-cou1", 1.0, 0.0},
                                         {"cou6_rms", "generated-cou6", 1.0, 0.0},
                                         {"cone31_rms", "generated-cone31", 1 / 0.002, 0.09 / 0.002}};

/// A stack with truth from the folder of reference data; z counts slices.
class ReferenceScan {
 public:
  /// A 16-bit stack is divided by 256 and used as 8 bit. Throws Error for a folder without a stack.
  ReferenceScan(const std::filesystem::path& folder, const Reference& reference, const FocusSettings& settings,
                WorkerPool& pool);

  [[nodiscard]] HeightMap map(PeakMethod method) const { return stack_->finish(method); }
  [[nodiscard]] ErrorSum figures_of(const HeightMap& map) const;
  /// The same for each quarter of the points, from the least to the steepest slope of the truth.
  [[nodiscard]] std::array<ErrorSum, 4> quarters_of(const HeightMap& map) const;
  [[nodiscard]] ErrorSum figures(PeakMethod method) const { return figures_of(map(method)); }
  /// Why the stage's errors were not corrected; empty if they were.
  [[nodiscard]] std::string stage_reason() const { return stack_->finish(PeakMethod::kFiveSample).stage.reason; }
  [[nodiscard]] double truth(int x, int y) const { return truth_slices_.at<double>(y, x); }
  /// Number of points that have a truth.
  [[nodiscard]] double points() const { return points_; }

 private:
  cv::Mat truth_slices_;
  double points_ = 0.0;
  std::unique_ptr<StreamingFocusStack> stack_;
};

}  // namespace fvd::bench
