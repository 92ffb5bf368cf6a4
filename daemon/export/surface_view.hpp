#pragma once

/// What the writers of surface files write.

#include <chrono>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/surface/surface.hpp"
#include "daemon/result/result_data.hpp"

namespace fvd {

struct ExportInput;

/// Where a surface comes from. Empty = not known.
struct SurfaceOrigin {
  std::string title;
  std::string part_id;
  std::string job_id;
  std::string recipe_id;
  std::string recipe_sha256;
  std::string peak;
  std::string software_version;
  std::string source;
  bool simulated = false;
  std::optional<std::chrono::system_clock::time_point> created;

  /// "PartId", "JobId" and so on with their values, those that are known.
  [[nodiscard]] std::vector<std::pair<std::string, std::string>> facts() const;
};

/// A surface, and what of it some formats show. Owns no pixels. Planes without data are not known.
struct SurfaceView {
  PlaneView<const float> height_m;  ///< NaN = hole
  PlaneView<const float> sigma_m;
  PlaneView<const std::uint16_t> grey;   ///< all-in-focus image, 0..max_grey
  PlaneView<const std::uint8_t> colour;  ///< [height][3 * width]: blue, green, red
  int max_grey = 0;
  std::optional<double> pitch_x_um;  ///< both absent: not known
  std::optional<double> pitch_y_um;
  SurfaceOrigin origin;

  [[nodiscard]] bool is_metric() const noexcept { return pitch_x_um && pitch_y_um; }
};

[[nodiscard]] SurfaceView surface_view(const ExportInput& input);
[[nodiscard]] SurfaceView surface_view(const Surface& surface, SurfaceOrigin origin);

[[nodiscard]] SurfaceOrigin surface_origin(const ResultData& data);
/// Of a result that was read back. title: as surface_origin(ResultData) makes it.
[[nodiscard]] SurfaceOrigin surface_origin(const Result& result);

/// Line breaks and control characters become blanks.
[[nodiscard]] std::string one_line(std::string text);

}  // namespace fvd
