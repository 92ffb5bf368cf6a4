#include "daemon/views/line_profile.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "core/base/error.hpp"
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

/// About so many heights are looked up, which takes a second at most.
constexpr double kMostSamples = 2e6;

/// By the smaller pitch, before anything is read.
void require_few_samples(const metrology::PointField& field, const metrology::ProfileLine& line) {
  const double pitch_um = std::min(field.pitch_x_um, field.pitch_y_um);
  const double along = std::hypot(line.to_x_um - line.from_x_um, line.to_y_um - line.from_y_um) / pitch_um;
  const double samples = along * std::max(1.0, line.band_width_um / pitch_um);
  if (!(samples > kMostSamples)) return;
  throw Error(ErrorCode::kBadInput, "profile: line and band have about " + std::to_string(std::llround(samples)) +
                                        " samples, " + std::to_string(std::llround(kMostSamples)) +
                                        " at most are taken: give a narrower band (width_um) or a shorter line");
}

}  // namespace

LineProfile line_profile(ResultMaps& maps, const Result& result, const metrology::ProfileLine& line) {
  const OpenedMap heights = heights_of(maps, result);
  const std::filesystem::path json = maps.folder() / "result.json";
  const Result::Focus& focus = result.focus;
  metrology::PointField field;
  field.width = heights.rows->size().width;
  field.height = heights.rows->size().height;
  field.pitch_x_um = pitch_of(json, "/focus/pixel_pitch_x_um", focus.pixel_pitch_x_um, std::nullopt);
  field.pitch_y_um = pitch_of(json, "/focus/pixel_pitch_y_um", focus.pixel_pitch_y_um, std::nullopt);
  require_few_samples(field, line);
  const std::optional<OpenedMap> sigmas = maps.find(MapKind::kSigma);
  MeasuredPoints points(heights.rows, sigmas ? sigmas->rows : nullptr, result.calibration);
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
