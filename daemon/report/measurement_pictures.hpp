#pragma once

/// Pictures of single measurements, and of the all-in-focus image: PNG. The same surface and result give the same
/// bytes. Throw Error kInternal. context: pure.

#include <cstdint>
#include <string>

#include "daemon/report/picture_surface.hpp"
#include "daemon/result/evaluation_result.hpp"

namespace fvd {

/// Where a measurement looked: heights along its cross section, its regions, what was not measured hatched, and its
/// main value. name: of the measurement, which has a cross section.
[[nodiscard]] std::string profile_png(const PictureSurface& surface, const std::string& name,
                                      const EvaluatedMeasurement& measurement);

/// True for a measurement that edge_png() shows something of.
[[nodiscard]] bool is_cutting_edge(const EvaluatedMeasurement& measurement);

/// Of each cutting edge the radius of its sections along the edge, the notches of its line at their places with depth
/// and width, and hatched what was not measured.
[[nodiscard]] std::string edge_png(const PictureSurface& surface, const Evaluation& evaluation);

/// The all-in-focus image. Planes without data are not known.
struct PictureTexture {
  PlaneView<const std::uint16_t> grey;   ///< 0..max_grey
  PlaneView<const std::uint8_t> colour;  ///< [height][3 * width]: blue, green, red
  int max_grey = 255;
};

/// With axes and a scale bar. texture: grey or colour of the surface's size.
[[nodiscard]] std::string texture_view_png(const PictureSurface& surface, const PictureTexture& texture);

}  // namespace fvd
