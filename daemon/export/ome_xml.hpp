#pragma once

/// The description of a focus stack in an OME-TIFF.

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "core/image/image.hpp"

namespace fvd {

/// What is told of a stack beside its pixels. Slices follow each other as they were recorded.
struct OmeStack {
  std::string name;         ///< for people
  std::string description;  ///< empty = none
  std::string software;
  std::chrono::system_clock::time_point acquired;
  PixelFormat format = PixelFormat::kMono8;
  int width = 0;
  int height = 0;
  std::optional<double> pitch_x_um;  ///< of pixels on the object; absent = not known
  std::optional<double> pitch_y_um;
  std::optional<double> step_um;      ///< commanded, whatever its sign; absent = not known
  std::optional<double> exposure_us;  ///< of each slice; absent = not known
  std::vector<double> z_um;           ///< where each slice was taken; need not be evenly spaced

  [[nodiscard]] int slices() const { return static_cast<int>(z_um.size()); }
};

/// OME-XML in UTF-8 (schema 2016-06, Open Microscopy Environment): dimension order XYZCT, one channel, one time,
/// lengths in µm. PhysicalSizeZ is the commanded step's amount; PositionZ of each plane is the measured place, in the
/// shortest text that reads back equal. What is not known is left out. context: pure.
[[nodiscard]] std::string ome_xml(const OmeStack& stack);

}  // namespace fvd
