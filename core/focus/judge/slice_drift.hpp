#pragma once

/// Lateral drift and change of scale over a stack, measured from its slices.

#include <optional>
#include <vector>

#include "core/focus/judge/patch_shift.hpp"

namespace fvd {

/// Where the image of the object lies in each slice.
class DriftPath {
 public:
  DriftPath() = default;
  /// The image moves by so many pixels right and down while z rises by 1 um; it is where it should be at middle_um.
  DriftPath(double x_px_per_um, double y_px_per_um, double middle_um);

  void add(double z_um, double x_px, double y_px) { places_.push_back({z_um, x_px, y_px}); }
  /// Moves the path so that the slice at index has its image where it should be. index: below places().
  void centre(std::size_t index);

  struct Place {
    double z_um;
    double x_px;
    double y_px;
  };
  /// Of the slice nearest to this z, or of the straight line.
  [[nodiscard]] Place at(double z_um) const noexcept;
  [[nodiscard]] bool empty() const noexcept { return places_.empty() && !line_; }
  [[nodiscard]] std::size_t places() const noexcept { return places_.size(); }

 private:
  std::vector<Place> places_;
  std::optional<Place> line_;  // pixels per um, and the z where it is zero
};

struct DriftFigures {
  double x_px = 0.0;         ///< the image moved right by so much from the first slice to the last
  double y_px = 0.0;         ///< and down
  double x_px_per_um = 0.0;  ///< of z
  double y_px_per_um = 0.0;
  double error_px_per_um = 0.0;        ///< standard error of either
  std::optional<double> scale_per_um;  ///< growth of the image over its size; nothing where a single patch tells
  double scale_error_per_um = 0.0;     ///< its standard error
};

/// context: one thread.
class DriftMeter {
 public:
  /// Takes the next slice in. A slice without texture, as one that moved by more than kMaxPatchShift_px, counts as
  /// moved as far as the others did.
  void add(SlicePatches patches, double z_um);

  /// Nothing where no two successive slices can be compared.
  [[nodiscard]] std::optional<DriftFigures> figures() const;

  /// Of all slices, with the middle one where it should be; empty where figures() tells nothing.
  [[nodiscard]] DriftPath path() const;

 private:
  struct Step {
    double rise_um = 0.0;
    bool known = false;
    double x_px = 0.0;
    double y_px = 0.0;
    std::optional<double> scale = {};
  };
  [[nodiscard]] Step compare(const SlicePatches& patches, double rise_um) const;

  SlicePatches last_;
  std::vector<double> z_um_;
  std::vector<Step> steps_;
  int guess_x_ = 0;
  int guess_y_ = 0;
};

}  // namespace fvd
