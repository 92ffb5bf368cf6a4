#include "core/focus/fit/map_finish.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/base/units.hpp"
#include "core/focus/fit/curve_limits.hpp"
#include "core/focus/fit/curve_misfit.hpp"
#include "core/focus/fit/curve_shape.hpp"
#include "core/focus/fit/curve_tuple.hpp"
#include "core/focus/fit/edge_band.hpp"
#include "core/focus/fit/gap_bias.hpp"
#include "core/focus/fit/gap_fit.hpp"
#include "core/focus/kernels/five_sample_fit.hpp"
#include "core/focus/measure/peak_tiles.hpp"
#include "core/focus/measure/sharpness_rows.hpp"

namespace fvd {

namespace {

/// Offset of the texture's centroid from the middle of the window, in windows (standard deviation); on a slope it is an
/// error of height. Measured on ramps of four textures for a box and the modified Laplacian; the diagonals see more of
/// the texture, and a double box gives its rim less weight.
constexpr float kCentroidOffset_windows = 0.038F;
constexpr float kDiagonalsShare = 0.9F;
constexpr float kDoubleBoxShare = 0.76F;

/// How much more a vertex moves than the cubic of the curves' misfit tells: on stacks without noise, in which misfit is
/// all there is.
constexpr double kVertexShare = 1.1;

/// The share of the curves' misfit that moves a vertex where samples are bins, which differ in their tails alone.
constexpr double kBinsShare = 0.5;

float centroid_offset_px(const FocusSettings& settings) {
  return kCentroidOffset_windows * static_cast<float>(settings.window_px) *
         (settings.focus_operator == FocusOperator::kDiagonalLaplacian ? kDiagonalsShare : 1.0F) *
         (settings.window == FocusWindow::kDoubleBox ? kDoubleBoxShare : 1.0F);
}

/// Approximate number of points that are fitted first, to find the shape of the curves and the offsets of the stage.
constexpr double kSubsetPoints = 10000.0;

/// The share of the full window that is left about a pixel near the border: its sums are smaller by as much, their
/// noise by its root.
double window_share(int centre, int window, int size) {
  const WindowReach reach(centre, window / 2, size);
  return static_cast<double>(reach.last - reach.first + 1) / window;
}

/// What a row's points are judged by: the same for all rows of a tile, but near the upper and the lower border.
class Limits {
 public:
  /// Without tiles no point is taken for bleeding.
  Limits(const NoiseProbe& noise, std::optional<PeakTiles> tiles, int width, int height, int window)
      : noise_(noise),
        tiles_(std::move(tiles)),
        width_(width),
        height_(height),
        window_(window),
        noise_grey_(static_cast<std::size_t>(width)),
        least_(static_cast<std::size_t>(width)) {}

  /// For row y; cheapest from top to bottom. Returns whether that changes anything.
  bool move_to(int y) {
    const Key key{noise_.tile_row(y), tiles_ ? tiles_->tile_row(y) : 0, window_share(y, window_, height_)};
    if (key == key_) return false;
    key_ = key;
    noise_.noise_row(key.noise_row, noise_grey_.data());
    if (tiles_) tiles_->least_amplitude(key.peak_row, least_.data());
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
  std::optional<PeakTiles> tiles_;
  int width_;
  int height_;
  int window_;
  Key key_;
  std::vector<float> noise_grey_;
  std::vector<float> least_;
};

CurveTuple tuple_of(const RowFit& fit, const CurveRow& row, int x, float noise, float height_m) {
  const double floor = static_cast<double>(kFloorShare) * fit.share(row.minimum[x]);
  const double amplitude = fit.share(row.peak[x]) - floor;
  CurveTuple tuple;
  tuple.index = row.peak_index[x];
  tuple.share = fit.shares(row, x);
  tuple.noise = static_cast<float>(static_cast<double>(noise) / amplitude);
  tuple.height_um = height_m * 1e6F;
  return tuple;
}

/// Points here and there in a row, as a row of their own.
class SpotRow {
 public:
  SpotRow(int row_width, int every) : every_(every), width_((row_width - every / 2 + every - 1) / every) {
    for (auto& field : fields_) field.resize(static_cast<std::size_t>(width_));
    clipped_.resize(static_cast<std::size_t>(width_));
    noise_grey_.resize(static_cast<std::size_t>(width_));
  }

  [[nodiscard]] int width() const noexcept { return width_; }

  /// noise_grey: of every pixel of the row.
  void gather(const CurveRow& row, const float* noise_grey_row) {
    if (row.second != nullptr) second_.resize(static_cast<std::size_t>(width_));
    const std::array from{row.peak, row.left, row.left2, row.right, row.right2, row.minimum, row.peak_index};
    for (int i = 0; i < width_; ++i) {
      const int x = every_ / 2 + i * every_;
      for (std::size_t field = 0; field < from.size(); ++field) {
        fields_[field][static_cast<std::size_t>(i)] = from[field][x];
      }
      if (row.second != nullptr) second_[static_cast<std::size_t>(i)] = row.second[x];
      clipped_[static_cast<std::size_t>(i)] = row.clipped[x];
      noise_grey_[static_cast<std::size_t>(i)] = noise_grey_row[x];
    }
  }
  [[nodiscard]] CurveRow curves() noexcept {
    auto& [peak, left, left2, right, right2, minimum, peak_index] = fields_;
    return {nullptr,
            nullptr,
            peak.data(),
            left.data(),
            left2.data(),
            right.data(),
            right2.data(),
            minimum.data(),
            peak_index.data(),
            clipped_.data(),
            0,
            second_.empty() ? nullptr : second_.data()};
  }
  [[nodiscard]] const float* noise_grey() const noexcept { return noise_grey_.data(); }

 private:
  int every_;
  int width_;
  std::array<std::vector<std::uint16_t>, 7> fields_;
  std::vector<std::uint16_t> second_;  // empty where no second peak is looked for
  std::vector<std::uint8_t> clipped_;
  std::vector<float> noise_grey_;
};

/// What goes over the image of one map.
class MapFinish {
 public:
  MapFinish(const CurveSource& curves, const FocusSettings& settings, const NoiseProbe& noise, WorkerPool& pool,
            HeightMap& map)
      : curves_(curves),
        settings_(settings),
        noise_(noise),
        pool_(pool),
        map_(map),
        width_(map.height_m.width()),
        height_(map.height_m.height()) {}

  /// The curves of points spread over the image, in the order of rows.
  struct Spots {
    std::vector<CurveTuple> tuples;
    std::size_t looked_at = 0;  ///< points
  };
  Spots look_around(const RowFit& fit) {
    const int every = std::max(1, static_cast<int>(std::sqrt(static_cast<double>(width_) * height_ / kSubsetPoints)));
    const int rows = (height_ - every / 2 + every - 1) / every;
    const int bands = pool_.threads();
    std::vector<std::vector<CurveTuple>> found(static_cast<std::size_t>(bands));
    pool_.run(bands, [&](int band) {
      auto& tuples = found[static_cast<std::size_t>(band)];
      Limits limits(noise_, std::nullopt, width_, height_, settings_.window_px);
      SpotRow spots(width_, every);
      const auto count = static_cast<std::size_t>(spots.width());
      std::vector<float> noise(count);
      std::vector<float> height_m(count);
      std::vector<float> variance_m2(count);
      std::vector<float> prominence(count);
      std::vector<MaskReasons> mask(count);
      const std::vector<float> least(count);
      for (int row = rows * band / bands; row < rows * (band + 1) / bands; ++row) {
        const int y = every / 2 + row * every;
        limits.move_to(y);
        spots.gather(curves_(band, y, nullptr), limits.noise_grey());
        fit.find_noise(spots.curves(), spots.noise_grey(), spots.width(), noise.data());
        fit.fit(spots.curves(), noise.data(), least.data(), spots.width(),
                {height_m.data(), variance_m2.data(), prominence.data(), mask.data()});
        for (int i = 0; i < spots.width(); ++i) {
          const auto n = static_cast<std::size_t>(i);
          if (mask[n] == 0) tuples.push_back(tuple_of(fit, spots.curves(), i, noise[n], height_m[n]));
        }
      }
    });
    Spots all;
    all.looked_at = static_cast<std::size_t>(rows) * static_cast<std::size_t>(SpotRow(width_, every).width());
    for (const auto& tuples : found) all.tuples.insert(all.tuples.end(), tuples.begin(), tuples.end());
    return all;
  }

  /// All planes. most_samples: see edge_band.hpp, 0 for no such test.
  void fit(const RowFit& fit, const GapBias& gaps, const GapFit& beside_gaps, int most_samples) {
    const int bands = pool_.threads();
    const bool jumps_matter = most_samples > 0;
    const EdgeBandLimits strips{edge_spill(settings_), most_samples,
                                sharpness_code(settings_, map_.texture_format).root};
    std::vector<JumpTiles> jumps(jumps_matter ? static_cast<std::size_t>(bands) : 0,
                                 JumpTiles(width_, height_, strips));
    const int reach = settings_.window_px / 2;
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
        gaps.correct(row, width_, map_.height_m.row(y));
        beside_gaps.correct(fit, row, width_, map_.height_m.row(y));
        if (jumps_matter)
          jumps[static_cast<std::size_t>(band)].look_at(y, row.peak_index, map_.mask.row(y),
                                                        map_.mask.row(std::max(0, y - 2)));
        if (y - 2 * reach >= first) finish_sigma(y - reach);  // while the rows are in the cache
      }
    });
    pool_.run(bands, [&](int band) {  // where the slope reaches into the next band
      const int first = height_ * band / bands;
      const int end = height_ * (band + 1) / bands;
      for (int y = first; y < end; ++y) {
        if (y - reach < first || y + reach >= end) finish_sigma(y);
      }
      if (!jumps_matter || first == 0) return;
      for (int y = std::max(first, 2); y < std::min(first + 2, end); ++y) {  // what the bands did not compare
        const CurveRow row = curves_(band, y - 2, nullptr);
        const std::vector<std::uint16_t> upper(row.peak_index, row.peak_index + width_);
        jumps[static_cast<std::size_t>(band)].compare(y, upper.data(), curves_(band, y, nullptr).peak_index,
                                                      map_.mask.row(y - 2), map_.mask.row(y));
      }
    });
    if (!jumps_matter) return;
    for (const JumpTiles& others : std::span(jumps).subspan(1)) jumps.front().join(others);
    const auto curves = [this](int thread, int y) { return curves_(thread, y, nullptr); };
    EdgeBands(jumps.front(), strips, map_.mask, curves, pool_).apply(map_.height_m, map_.sigma_m, map_.mask, pool_);
  }

  /// Points with a larger standard error become holes; last, because the slope at a point is taken from its neighbours.
  void drop_uncertain(double max_sigma_um) {
    const auto most_m = static_cast<float>(max_sigma_um * kMetresPerMicrometer);
    pool_.run(height_, [&](int y) {
      float* const height_m = map_.height_m.row(y);
      float* const sigma_m = map_.sigma_m.row(y);
      MaskReasons* const mask = map_.mask.row(y);
      for (int x = 0; x < width_; ++x) {
        if (!(sigma_m[x] > most_m)) continue;
        mask[x] |= mask_reason::kMaxSigma;
        height_m[x] = std::numeric_limits<float>::quiet_NaN();
        sigma_m[x] = std::numeric_limits<float>::quiet_NaN();
      }
    });
  }

 private:
  [[nodiscard]] PeakTiles peak_tiles(int band) const {
    return {width_, height_, settings_.window_px + settings_.distance_px,
            sharpness_code(settings_, map_.texture_format).root,
            [this, band](int y) { return curves_(band, y, nullptr); }};
  }

  /// Row y of the variances becomes one of standard errors, with what the slope adds to them: from the heights of the
  /// rows a window's half above and below.
  void finish_sigma(int y) {
    const int reach = settings_.window_px / 2;
    const bool inside = reach > 0 && y >= reach && y < height_ - reach;
    focus_kernels().finish_sigma(map_.height_m.row(y), inside ? map_.height_m.row(y - reach) : nullptr,
                                 inside ? map_.height_m.row(y + reach) : nullptr, reach, centroid_offset_px(settings_),
                                 width_, map_.sigma_m.row(y));
  }

  const CurveSource& curves_;
  const FocusSettings& settings_;
  const NoiseProbe& noise_;
  WorkerPool& pool_;
  HeightMap& map_;
  int width_;
  int height_;
};

/// Neighbours whose peaks are so many samples apart are two surfaces; 0 for no such test. Within a curve's width noise
/// alone may part them.
int jump_samples(const FocusSettings& settings, const std::vector<double>& z_um, double curve_width_um) {
  if (settings.tests.edge_band_slices == 0) return 0;
  if (z_um.size() < 2) return settings.tests.edge_band_slices;
  const double step_um = std::abs(z_um.back() - z_um.front()) / static_cast<double>(z_um.size() - 1);
  const double width = step_um > 0.0 ? std::min(std::ceil(curve_width_um / step_um), 65535.0) : 0.0;
  return std::max(settings.tests.edge_band_slices, static_cast<int>(width));
}

}  // namespace

void finish_map(const CurveSource& curves, const std::vector<double>& z_um, const FocusSettings& settings,
                PeakMethod method, const NoiseProbe& noise, WorkerPool& pool, HeightMap& map) {
  MapFinish finish(curves, settings, noise, pool, map);
  const auto spots = finish.look_around(RowFit(z_um, settings, map.texture_format, method));
  std::vector<double> corrected = z_um;
  if (settings.stage_correction && method == PeakMethod::kFiveSample) {
    map.stage = solve_stage_correction(spots.tuples, z_um, pool);
    for (std::size_t k = 0; k < map.stage.offsets_um.size(); ++k) corrected[k] += map.stage.offsets_um[k];
  } else {
    map.stage.reason = "not asked for";
  }
  const bool logarithm = method == PeakMethod::kFiveSample && has_light_tails(settings.focus_operator);
  const CurveShape shape = curve_shape(spots.tuples, corrected, pool, logarithm);
  ScanCurves curves_in_common{shape.bias, kVertexShare * curve_misfit(spots.tuples, corrected, shape.exponent), {}};
  if (settings.bin_slices > 1) curves_in_common.misfit *= kBinsShare;
  curves_in_common.limits = curve_limits(spots.tuples, spots.looked_at, corrected, settings.tests, logarithm);
  // Of a logarithm nothing is taken off beside a gap: it is a parabola wherever the samples lie.
  const CurveShape of_fit = method == PeakMethod::kFiveSample && !logarithm ? shape : CurveShape{};
  finish.fit(RowFit(corrected, settings, map.texture_format, method, curves_in_common), GapBias(corrected, of_fit),
             GapFit(spots.tuples, corrected, of_fit, curves_in_common.limits),
             jump_samples(settings, corrected, shape.width_um));
  if (settings.tests.max_sigma_um > 0.0) finish.drop_uncertain(settings.tests.max_sigma_um);
  map.noise_grey = noise.median();
  map.curve_width_um = shape.width_um;
}

}  // namespace fvd
