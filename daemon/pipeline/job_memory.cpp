#include "daemon/pipeline/job_memory.hpp"

#include <algorithm>
#include <cstdint>
#include <sstream>
#include <string_view>

#include "core/base/error.hpp"
#include "core/focus/streaming_focus_stack.hpp"
#include "core/scan/focus_worker.hpp"
#include "daemon/evaluation/evaluate_surface.hpp"
#include "daemon/pipeline/scan_average.hpp"

namespace fvd {

namespace {

/// A map beside the first: heights, errors, prominence, reasons, texture.
constexpr std::size_t kMapBytesPerPixel = 3 * sizeof(float) + sizeof(MaskReasons) + sizeof(std::uint16_t);
/// Heights, errors, reasons and image as files: their bytes are kept until the digests are made of them.
constexpr std::size_t kEncodingBytesPerPixel = 2 * sizeof(float) + sizeof(MaskReasons) + sizeof(std::uint16_t);

/// A surface that was read for its evaluation, with reasons; a job's is among its maps.
constexpr std::size_t kStoredSurfaceBytesPerPixel = 2 * sizeof(float) + sizeof(MaskReasons);
constexpr std::size_t kReferenceBytesPerPixel = sizeof(double) + sizeof(float);
constexpr std::size_t kSurfaceBytesPerPixel = sizeof(double) + sizeof(float);
/// While one measurement is made: regions, weights, sorted heights, draws of noise (41 bytes); with filters their
/// moments; with the autocorrelation the transforms of three times the region (400 MiB for 5 Mpx were measured).
constexpr std::size_t kMeasurementBytesPerPixel = 80;
constexpr std::size_t kFilterBytesPerPixel = 100;
constexpr std::size_t kAutocorrelationBytesPerPixel = 90;

bool has_step(const EvaluationPlan& plan, std::string_view op) {
  return std::any_of(plan.surfaces.begin(), plan.surfaces.end(), [op](const auto& surface) {
    return std::any_of(surface.second.steps.begin(), surface.second.steps.end(),
                       [op](const PlannedOperation& step) { return step.op == op; });
  });
}

bool has_autocorrelation(const EvaluationPlan& plan) {
  return std::any_of(plan.measurements.begin(), plan.measurements.end(), [](const auto& measurement) {
    const auto& names = measurement.second.parameters;
    return std::any_of(names.begin(), names.end(),
                       [](const std::string& name) { return name == "Sal" || name == "Str" || name == "Std"; });
  });
}

/// Levels keep a map of weights for each pair of regions.
std::size_t weight_map_bytes(const EvaluationPlan& plan) {
  std::size_t most = 0;
  for (const auto& [name, measurement] : plan.measurements) {
    const std::size_t regions = measurement.kind == "levels" ? measurement.regions.size() : 0;
    if (regions > 1) most = std::max(most, regions * (regions - 1) / 2);
  }
  return most * sizeof(double);
}

std::size_t evaluation_bytes(const EvaluationPlan& plan, std::size_t pixels) {
  if (plan.empty()) return 0;
  std::size_t bytes = kSurfaceBytesPerPixel * (1 + plan.surfaces.size());  // the measured one too
  std::size_t working = kMeasurementBytesPerPixel + weight_map_bytes(plan);
  if (has_autocorrelation(plan)) working = std::max(working, kMeasurementBytesPerPixel + kAutocorrelationBytesPerPixel);
  if (plan.measurements.size() > 1) working *= static_cast<std::size_t>(kMeasurementsAtOnce);
  if (has_step(plan, "filter")) working = std::max(working, kFilterBytesPerPixel);
  bytes += working + plan.masks.size();                                            // a byte a point each
  if (has_step(plan, "flatness_reference")) bytes += 2 * kReferenceBytesPerPixel;  // as kept, and divided by alpha_z
  if (has_step(plan, "mask_reasons")) bytes += sizeof(MaskReasons) * (1 + plan.surfaces.size());
  return bytes * pixels;
}

std::size_t mebibytes(std::size_t bytes) { return bytes >> 20U; }

}  // namespace

JobMemory job_memory(const Recipe& recipe, int width, int height, int threads) {
  const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  const PixelFormat format = recipe.camera.slice_format();
  FocusSettings focus = focus_settings(recipe);
  if (learns_bins(recipe)) focus.bin_slices = std::max(focus.bin_slices, 2);  // they may be known when it begins
  const std::size_t stack = StreamingFocusStack::memory_bytes(width, height, format, focus, threads);
  JobMemory needed;
  needed.state_bytes = stack - pixels * kMapBytesPerPixel;
  needed.maps_bytes = (1 + recipe.extra_peaks.size()) * pixels * kMapBytesPerPixel;
  if (recipe.repeat > 1) needed.maps_bytes += pixels * ScanAverage::kBytesPerPixel;
  if (recipe.smooth_px) needed.maps_bytes += 2 * pixels * sizeof(float);
  needed.frames_bytes =
      pixels * static_cast<std::size_t>(bytes_per_pixel(format)) * static_cast<std::size_t>(recipe.camera.pool_frames);
  if (recipe.drift_px_per_um_x != 0.0 || recipe.drift_px_per_um_y != 0.0) {
    // Shifted copies of a batch, and of the frames that were held back.
    needed.frames_bytes += pixels * static_cast<std::size_t>(bytes_per_pixel(format)) *
                           static_cast<std::size_t>(StreamingFocusStack::kMaxBatch + FocusWorker::kHeldBack);
  }
  needed.encoding_bytes = pixels * (kEncodingBytesPerPixel + recipe.extra_peaks.size() * sizeof(float));
  if (recipe.smooth_px) needed.encoding_bytes += 2 * pixels * sizeof(float);
  needed.evaluation_bytes = evaluation_bytes(recipe.evaluation, pixels);
  return needed;
}

void require_memory(const JobMemory& needed, int width, int height, std::size_t budget_bytes, KeptPages* pages) {
  if (needed.total_bytes() > budget_bytes) {
    std::ostringstream message;
    message << "the job needs " << mebibytes(needed.total_bytes()) << " MiB for " << width << " x " << height
            << " pixels (state " << mebibytes(needed.state_bytes) << ", maps " << mebibytes(needed.maps_bytes)
            << ", frames " << mebibytes(needed.frames_bytes) << ", files " << mebibytes(needed.encoding_bytes)
            << ", evaluation " << mebibytes(needed.evaluation_bytes) << "), the budget is " << mebibytes(budget_bytes)
            << " MiB: use a smaller region, fewer extra_peaks, frames or surfaces, or raise compute.memory_budget_mib";
    throw Error(ErrorCode::kMemoryBudget, message.str());
  }
  if (pages != nullptr && needed.total_bytes() + pages->kept_bytes() > budget_bytes) pages->release();
}

void require_evaluation_memory(const Recipe& recipe, int width, int height, std::size_t budget_bytes) {
  const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  const std::size_t needed = evaluation_bytes(recipe.evaluation, pixels) +
                             pixels * (kStoredSurfaceBytesPerPixel + sizeof(MaskReasons) + kEncodingBytesPerPixel);
  if (needed <= budget_bytes) return;
  std::ostringstream message;
  message << "the evaluation by recipe " << recipe.id << " needs " << mebibytes(needed) << " MiB for " << width << " x "
          << height << " points, the budget is " << mebibytes(budget_bytes)
          << " MiB: use fewer surfaces, or raise compute.memory_budget_mib";
  throw Error(ErrorCode::kMemoryBudget, message.str());
}

}  // namespace fvd
