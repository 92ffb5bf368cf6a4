#pragma once

/// A simulated world as plain values.

#include <cstdint>
#include <filesystem>
#include <string>

#include "sim/artefact/artefact_parameters.hpp"

namespace fvd::sim {

enum class SurfaceKind {
  kChapter,
  kTilted,
  kSphere,
  kRough,
  kHeightMap,
  kLayered,
  kFlat,
  kGroove,
  kStairs,
  kSinusoid,
  kStar,
  kCrossGrid,
  kLetterF,
  kEdge
};

/// The surfaces of sim/artefact.
[[nodiscard]] constexpr bool is_artefact(SurfaceKind kind) { return kind >= SurfaceKind::kFlat; }

enum class TextureKind {
  kGranite,  ///< grains of 0.6, 1.2, 3 and 8 pixels
  kFine,     ///< grains of 0.6 pixels
  kWhite,    ///< every pixel is independent
};

/// One of two planes, 8-bit grey levels.
struct Layer {
  double grey = 128.0;     ///< mean
  double contrast = 28.0;  ///< standard deviation of its texture; 0: none
};

struct WorldParameters {
  SurfaceKind surface = SurfaceKind::kChapter;
  int width_px = 480;  ///< sensor; the chapter's surface needs exactly 480 x 360, a height map brings its own size
  int height_px = 360;

  double tilt_x_um_per_px = 0.05;  ///< kTilted: rise per pixel
  double tilt_y_um_per_px = 0.0;
  double base_um = 50.0;         ///< kTilted: height of the centre; kSphere: of the plane it stands on; kRough: mean;
                                 ///< kLayered: of the far plane; artefacts: their height 0 in the middle
  double radius_um = 1000.0;     ///< kSphere
  double cap_height_um = 80.0;   ///< kSphere: apex above the plane
  double pixel_pitch_um = 1.0;   ///< lateral scale of sphere and artefacts
  double sq_um = 3.0;            ///< kRough: root mean square height, exact
  double correlation_px = 12.0;  ///< kRough: standard deviation of the smoothing
  std::filesystem::path height_map_file;  ///< kHeightMap: GSF

  Artefacts artefacts;  ///< of one, what `surface` names; tilt: not of kChapter, kTilted, kLayered; contrast: not of
                        ///< kChapter, kLayered

  double layer_gap_um = 300.0;  ///< kLayered: from the far plane up to the near one
  double edge_radius_px = 0.0;  ///< kLayered: 0: the near plane is the left half; else a disc in the middle
  Layer near;                   ///< kLayered
  Layer far;                    ///< kLayered

  double defocus_px_per_um = 0.04;  ///< sigma of the blur per um of defocus
  double readout_noise = 1.5;       ///< standard deviation in 8-bit grey levels
  TextureKind texture = TextureKind::kGranite;
  double contrast = 28.0;       ///< standard deviation of the texture in 8-bit grey levels
  double poor_contrast = 0.03;  ///< of the texture-poor patch, as a fraction
  bool mirror_x = false;        ///< the camera shows left and right exchanged
  bool mirror_y = false;        ///< and top and bottom
  std::uint64_t seed = 1;       ///< of texture, surface and noise
};

}  // namespace fvd::sim
