#include "core/focus/map_finish.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>
#include <vector>

#include "core/focus/five_sample_fit.hpp"
#include "core/focus/peak_tiles.hpp"
#include "core/focus/sharpness_rows.hpp"

namespace fvd {

namespace {

/// The texture of a window has its weight not quite in the middle; on a slope that is an error of height: so many
/// windows beside the middle, standard deviation. Measured on the chapter's ramp.
constexpr float kWeightOffset = 0.038F;

/// About how many points are looked at more closely: how wide the curves are, and where the stage was off.
constexpr double kSpotChecks = 10000.0;

/// The share of the full window that is left about a pixel near the border: its sums are smaller by as much, their
/// noise by its root.
double window_share(int centre, int window, int size) {
  const WindowReach reach(centre, window / 2, size);
  return static_cast<double>(reach.last - reach.first + 1) / window;
}

/// What a row's points are judged by: the same for all rows of a tile, but near the upper and the lower border.
class Limits {
 public:
  Limits(const NoiseProbe& noise, PeakTiles tiles, int width, int height, int window)
      : noise_(noise),
        tiles_(std::move(tiles)),
        width_(width),
        height_(height),
        window_(window),
        noise_grey_(static_cast<std::size_t>(width)),
        least_(static_cast<std::size_t>(width)) {}

  /// For row y; cheapest from top to bottom. Returns whether that changes anything.
  bool move_to(int y) {
    const Key key{noise_.tile_row(y), tiles_.tile_row(y), window_share(y, window_, height_)};
    if (key == key_) return false;
    key_ = key;
    noise_.noise_row(key.noise_row, noise_grey_.data());
    tiles_.least_amplitude(key.peak_row, least_.data());
    const int inner = key.share < 1.0 ? width_ : std::min(window_ / 2, width_);  // all columns, or those at the ends
    for (int x = 0; x < inner; ++x) shrink(x);
    for (int x = std::max(inner, width_ - window_ / 2); x < width_; ++x) shrink(x);
    return true;
  }
  /// Standard deviation of a pixel, and the least amplitude that is no bleeding. Shape [width] each.
  [[nodiscard]] const float* noise_grey() const noexcept { return noise_grey_.data(); }
  [[nodiscard]] const float* least() const noexcept { return least_.data(); }

 private:
  struct Key {
    int noise_row = -1;
    int peak_row = -1;
    double share = 0.0;  // of a full window's rows
    bool operator==(const Key&) const = default;
  };

  void shrink(int x) {
    const double share = key_.share * window_share(x, window_, width_);
    noise_grey_[static_cast<std::size_t>(x)] *= static_cast<float>(std::sqrt(share));
    least_[static_cast<std::size_t>(x)] *= static_cast<float>(share);
  }

  const NoiseProbe& noise_;
  PeakTiles tiles_;
  int width_;
  int height_;
  int window_;
  Key key_;
  std::vector<float> noise_grey_;
  std::vector<float> least_;
};

double median(std::vector<float>& values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return static_cast<double>(*middle);
}

/// What a band of rows gives beside its part of the map.
struct BandFigures {
  std::vector<float> widths_um;
  std::vector<CurveTuple> tuples;
};

CurveTuple tuple_of(const RowFit& fit, const CurveRow& row, int x, float noise, float height_m) {
  const double floor = static_cast<double>(kFloorShare) * fit.share(row.minimum[x]);
  const double amplitude = fit.share(row.peak[x]) - floor;
  const auto share = [&](std::uint16_t code) {
    return static_cast<float>(std::max(0.0, (fit.share(code) - floor) / amplitude));
  };
  CurveTuple tuple;
  tuple.index = row.peak_index[x];
  tuple.share = {share(row.left2[x]), share(row.left[x]), 1.0F, share(row.right[x]), share(row.right2[x])};
  tuple.noise = static_cast<float>(static_cast<double>(noise) / amplitude);
  tuple.height_um = height_m * 1e6F;
  return tuple;
}

/// One pass over the image.
class Pass {
 public:
  Pass(const CurveSource& curves, const FocusSettings& settings, const NoiseProbe& noise, WorkerPool& pool,
       HeightMap& map)
      : curves_(curves),
        settings_(settings),
        noise_(noise),
        pool_(pool),
        map_(map),
        width_(map.height_m.width()),
        height_(map.height_m.height()),
        check_every_(std::max(1, static_cast<int>(std::sqrt(static_cast<double>(width_) * height_ / kSpotChecks)))) {}

  /// All planes. One entry a band, in the order of rows.
  std::vector<BandFigures> fit(const RowFit& fit, bool with_tuples) {
    const int bands = pool_.threads();
    const int reach = settings_.window_px / 2;
    std::vector<BandFigures> figures(static_cast<std::size_t>(bands));
    pool_.run(bands, [&](int band) {
      const int first = height_ * band / bands;
      const int end = height_ * (band + 1) / bands;
      Limits limits(noise_, peak_tiles(band), width_, height_, settings_.window_px);
      std::vector<float> noise_row(static_cast<std::size_t>(width_));  // of a sample, as shares
      for (int y = first; y < end; ++y) {
        const bool other_limits = limits.move_to(y);
        const CurveRow row = curves_(band, y, map_.texture.row(y));
        if (other_limits || fit.noise_follows_sharpness()) {
          fit.find_noise(row, limits.noise_grey(), width_, noise_row.data());
        }
        fit.fit(row, noise_row.data(), limits.least(), width_,
                {map_.height_m.row(y), map_.sigma_m.row(y), map_.prominence.row(y), map_.mask.row(y)});
        if (y % check_every_ == 0)
          spot_check(fit, row, y, noise_row, with_tuples, figures[static_cast<std::size_t>(band)]);
        if (y - 2 * reach >= first) add_slope_error(y - reach);  // while the rows are in the cache
      }
    });
    pool_.run(bands, [&](int band) {  // where the slope reaches into the next band
      const int first = height_ * band / bands;
      const int end = height_ * (band + 1) / bands;
      for (int y = first; y < end; ++y) {
        if (y - reach < first || y + reach >= end) add_slope_error(y);
      }
    });
    return figures;
  }

 private:
  [[nodiscard]] PeakTiles peak_tiles(int band) const {
    return {width_, height_, settings_.window_px + settings_.distance_px,
            sharpness_code(settings_, map_.texture_format).root,
            [this, band](int y) { return curves_(band, y, nullptr); }};
  }

  /// Of row y, from the heights of the rows a window's half above and below.
  void add_slope_error(int y) {
    const int reach = settings_.window_px / 2;
    if (reach == 0 || y < reach || y >= height_ - reach) return;
    focus_kernels().add_slope_error(map_.height_m.row(y), map_.height_m.row(y - reach), map_.height_m.row(y + reach),
                                    reach, kWeightOffset * static_cast<float>(settings_.window_px), width_,
                                    map_.sigma_m.row(y));
  }

  void spot_check(const RowFit& fit, const CurveRow& row, int y, const std::vector<float>& noise, bool with_tuples,
                  BandFigures& figures) const {
    for (int x = 0; x < width_; x += check_every_) {
      if (map_.mask.at(x, y) != 0) continue;
      const auto curve_width = fit.curve_width_um(row, x);
      if (curve_width) figures.widths_um.push_back(static_cast<float>(*curve_width));
      if (!with_tuples) continue;
      figures.tuples.push_back(tuple_of(fit, row, x, noise[static_cast<std::size_t>(x)], map_.height_m.at(x, y)));
    }
  }

  const CurveSource& curves_;
  const FocusSettings& settings_;
  const NoiseProbe& noise_;
  WorkerPool& pool_;
  HeightMap& map_;
  int width_;
  int height_;
  int check_every_;  // row and column
};

template <typename Values>
Values joined(const std::vector<BandFigures>& figures, Values BandFigures::*member) {
  Values all;
  for (const BandFigures& band : figures) all.insert(all.end(), (band.*member).begin(), (band.*member).end());
  return all;
}

}  // namespace

void finish_map(const CurveSource& curves, const std::vector<double>& z_um, const FocusSettings& settings,
                PeakMethod method, const NoiseProbe& noise, WorkerPool& pool, HeightMap& map) {
  Pass pass(curves, settings, noise, pool, map);
  const bool correct = settings.stage_correction && method == PeakMethod::kFiveSample;
  auto figures = pass.fit(RowFit(z_um, settings, map.texture_format, method), correct);
  if (correct) {
    map.stage = solve_stage_correction(joined(figures, &BandFigures::tuples), z_um, pool);
  } else {
    map.stage.reason = "not asked for";
  }
  if (map.stage.applied) {
    std::vector<double> corrected = z_um;
    for (std::size_t k = 0; k < corrected.size(); ++k) corrected[k] += map.stage.offsets_um[k];
    figures = pass.fit(RowFit(corrected, settings, map.texture_format, method), false);
  }
  map.noise_grey = noise.median();
  auto widths = joined(figures, &BandFigures::widths_um);
  map.curve_width_um = median(widths);
}

}  // namespace fvd
