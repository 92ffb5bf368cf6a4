#pragma once

/// Single points of a stored map as an evaluation takes them.

#include <cstddef>
#include <deque>
#include <memory>
#include <optional>
#include <unordered_map>

#include "core/metrology/height_field.hpp"
#include "daemon/evaluation/evaluation_context.hpp"
#include "daemon/surface_files/map_rows.hpp"

namespace fvd {

/// The surface "measured" of an evaluation: a point without a usable standard error is a hole where there are standard
/// errors, and heights are divided by alpha_z of the calibration. Made in tiles as points of them are asked for, so
/// that a line across a large map takes a small part of its memory. context: one thread at a time.
class MeasuredPoints {
 public:
  /// sigmas: null = there are none; of the heights' size.
  MeasuredPoints(std::shared_ptr<const MapRows> heights, std::shared_ptr<const MapRows> sigmas,
                 const std::optional<Calibration>& calibration);

  /// NaN = hole; the point is in the map. Both throw Error kSurfaceFile.
  [[nodiscard]] double height_um(int column, int row);
  /// NaN where it is not known too.
  [[nodiscard]] double sigma_um(int column, int row);

 private:
  struct Place {
    const metrology::HeightField& tile;
    int column;  ///< in the tile
    int row;
  };
  [[nodiscard]] Place place(int column, int row);
  [[nodiscard]] const metrology::HeightField& tile(int index);
  [[nodiscard]] metrology::HeightField made(int index) const;

  const std::shared_ptr<const MapRows> heights_;
  const std::shared_ptr<const MapRows> sigmas_;
  EvaluationContext context_;
  int tiles_across_ = 1;
  std::size_t most_tiles_ = 1;  ///< as many as lines across and along the whole map touch
  std::unordered_map<int, metrology::HeightField> tiles_;
  std::deque<int> oldest_first_;
  int last_index_ = -1;
  const metrology::HeightField* last_ = nullptr;
};

}  // namespace fvd
