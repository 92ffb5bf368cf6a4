#pragma once

/// A surface seen from the front at an angle.

#include "daemon/report/picture_surface.hpp"
#include "daemon/report/raster.hpp"
#include "daemon/report/scalar_image.hpp"

namespace fvd {

/// A parallel view from above the front left: x goes right and back, y (of the image, downwards) comes to the front, z
/// goes up. Own definition.
struct ViewFrame {
  double scale = 1.0;  ///< pixels per um
  double offset_x = 0.0;
  double offset_y = 0.0;
  double exaggeration = 1.0;  ///< of heights; 1, 2, 5 times a power of ten
  double low_um = 0.0;        ///< height of the base

  struct Place {
    double x = 0.0;      ///< pixels of the picture, right
    double y = 0.0;      ///< down
    double depth = 0.0;  ///< towards the observer
  };
  /// x, y from the outer corner of the first pixel.
  [[nodiscard]] Place at(double x_um, double y_um, double z_um) const;
};

struct ShadedView {
  Raster raster;
  ViewFrame frame;
  ValueRange range;  ///< of the colours, and of the heights that are shown: what lies further out is drawn at its ends
};

/// Coloured as the height map is, lit from the left; holes are gaps, and the front and left borders stand on the base.
/// width, height: of the picture in pixels. Where the pitch is not known a pixel is taken for 1 um. Heights are
/// exaggerated until they are about a quarter of the longer side, never reduced.
[[nodiscard]] ShadedView shaded_view(const PictureSurface& surface, int width, int height);

}  // namespace fvd
