#include "daemon/pipeline/job_memory.hpp"

#include <algorithm>
#include <cstdint>
#include <sstream>

#include "core/base/error.hpp"
#include "core/focus/streaming_focus_stack.hpp"
#include "core/scan/focus_worker.hpp"

namespace fvd {

namespace {

/// A map beside the first: heights, errors, prominence, reasons, texture.
constexpr std::size_t kMapBytesPerPixel = 3 * sizeof(float) + sizeof(MaskReasons) + sizeof(std::uint16_t);
/// The preview's picture is drawn and encoded while the largest file of four bytes a point is made beside it.
constexpr std::size_t kEncodingBytesPerPixel = 12;

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
  if (recipe.smooth_px) needed.maps_bytes += 2 * pixels * sizeof(float);
  needed.frames_bytes =
      pixels * static_cast<std::size_t>(bytes_per_pixel(format)) * static_cast<std::size_t>(recipe.camera.pool_frames);
  if (recipe.drift_px_per_um_x != 0.0 || recipe.drift_px_per_um_y != 0.0) {
    // Shifted copies of a batch, and of the frames that were held back.
    needed.frames_bytes += pixels * static_cast<std::size_t>(bytes_per_pixel(format)) *
                           static_cast<std::size_t>(StreamingFocusStack::kMaxBatch + FocusWorker::kHeldBack);
  }
  needed.encoding_bytes = pixels * kEncodingBytesPerPixel;
  return needed;
}

void require_memory(const JobMemory& needed, int width, int height, std::size_t budget_bytes, KeptPages* pages) {
  if (needed.total_bytes() > budget_bytes) {
    std::ostringstream message;
    message << "the job needs " << mebibytes(needed.total_bytes()) << " MiB for " << width << " x " << height
            << " pixels (state " << mebibytes(needed.state_bytes) << ", maps " << mebibytes(needed.maps_bytes)
            << ", frames " << mebibytes(needed.frames_bytes) << ", files " << mebibytes(needed.encoding_bytes)
            << "), the budget is " << mebibytes(budget_bytes)
            << " MiB: use a smaller region, fewer extra_peaks or frames, or raise compute.memory_budget_mib";
    throw Error(ErrorCode::kMemoryBudget, message.str());
  }
  if (pages != nullptr && needed.total_bytes() + pages->kept_bytes() > budget_bytes) pages->release();
}

}  // namespace fvd
