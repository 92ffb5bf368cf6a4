#include "daemon/views/line_profile.hpp"

#include <cmath>
#include <cstddef>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "daemon/views/measured_points.hpp"

namespace fvd {

namespace {

/// The heights, of the size that the result tells.
OpenedMap heights_of(ResultMaps& maps, const Result& result) {
  std::optional<OpenedMap> heights = maps.find(MapKind::kHeight);
  if (!heights) refuse(maps.folder(), "folder", "it has no file of heights");
  const GridSize size = heights->rows->size();
  const Result::Focus& focus = result.focus;
  if (size.width != focus.width_px || size.height != focus.height_px) {
    refuse(maps.folder(), "size",
           "the file of heights has " + std::to_string(size.width) + " x " + std::to_string(size.height) +
               " points, the result " + std::to_string(focus.width_px) + " x " + std::to_string(focus.height_px));
  }
  return *std::move(heights);
}

}  // namespace

LineProfile line_profile(ResultMaps& maps, const Result& result, const metrology::ProfileLine& line) {
  const OpenedMap heights = heights_of(maps, result);
  const std::optional<OpenedMap> sigmas = maps.find(MapKind::kSigma);
  const std::filesystem::path json = maps.folder() / "result.json";
  const Result::Focus& focus = result.focus;
  MeasuredPoints points(heights.rows, sigmas ? sigmas->rows : nullptr, result.calibration);
  metrology::PointField field;
  field.width = heights.rows->size().width;
  field.height = heights.rows->size().height;
  field.pitch_x_um = pitch_of(json, "/focus/pixel_pitch_x_um", focus.pixel_pitch_x_um, std::nullopt);
  field.pitch_y_um = pitch_of(json, "/focus/pixel_pitch_y_um", focus.pixel_pitch_y_um, std::nullopt);
  field.z_um = [&points](int column, int row) { return points.height_um(column, row); };
  metrology::Profile made = metrology::extract_profile(field, line);

  LineProfile profile;
  profile.height_um = std::move(made.z_um);
  for (std::size_t i = 0; i < profile.height_um.size(); ++i) {
    profile.distance_um.push_back((static_cast<double>(i) + 0.5) * made.pitch_um);
  }
  constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  profile.sigma_um.assign(profile.height_um.size(), kUnknown);
  if (!sigmas) return profile;
  field.z_um = [&points](int column, int row) { return points.sigma_um(column, row); };
  profile.sigma_um = metrology::extract_profile(field, line).z_um;
  for (std::size_t i = 0; i < profile.height_um.size(); ++i) {
    if (std::isnan(profile.height_um[i])) profile.sigma_um[i] = kUnknown;
  }
  return profile;
}

}  // namespace fvd
