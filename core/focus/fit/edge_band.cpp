#include "core/focus/fit/edge_band.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <limits>

namespace fvd {

namespace {

constexpr int kApart = 2;  // px, of the points that are compared
constexpr int kLeastTile_px = 64;
constexpr double kLeastRatio = 1.5;  // of sharpness; sides that are more alike reach across by a pixel or two
constexpr int kAlikeReach_px = 2;
/// Reasons of points whose height says nothing of the surface.
constexpr MaskReasons kNoPoint = mask_reason::kInsignificant | mask_reason::kSaturated | mask_reason::kNarrowCurve;
constexpr std::uint16_t kHighest = std::numeric_limits<std::uint16_t>::max();

/// A square of values about a tile.
template <typename T>
struct Square {
  explicit Square(int size) : side(size), values(static_cast<std::size_t>(size) * static_cast<std::size_t>(size)) {}
  [[nodiscard]] T& at(int x, int y) {
    return values[static_cast<std::size_t>(y) * side_t() + static_cast<std::size_t>(x)];
  }
  [[nodiscard]] T* row(int y) { return values.data() + static_cast<std::size_t>(y) * side_t(); }
  void fill(T value) { std::fill(values.begin(), values.end(), value); }
  [[nodiscard]] std::size_t side_t() const { return static_cast<std::size_t>(side); }

  /// Each value becomes the extreme one of those from it to `count` - 1 further, along rows and columns.
  template <typename Pick>
  void gather(int count, Pick pick) {
    for (int covered = 1; covered < count;) {
      const int further = std::min(covered, count - covered);
      for (int y = 0; y < side; ++y) {
        T* const line = row(y);
        for (int x = 0; x + further < side; ++x) line[x] = pick(line[x], line[x + further]);
      }
      for (int y = 0; y + further < side; ++y) {
        T* const line = row(y);
        const T* const below = row(y + further);
        for (int x = 0; x < side; ++x) line[x] = pick(line[x], below[x]);
      }
      covered += further;
    }
  }

  int side;
  std::vector<T> values;
};

constexpr auto kLarger = [](auto a, auto b) { return a > b ? a : b; };
constexpr auto kSmaller = [](auto a, auto b) { return a < b ? a : b; };

/// One tile with what its strips hang on: walls up to `reach` about it, and the points as far about those.
class Surroundings {
 public:
  Surroundings(int tile, const EdgeBandLimits& limits)
      : tile_(tile),
        reach_(limits.reach_px),
        most_(limits.most_samples),
        least_ratio_(limits.root_code ? std::sqrt(kLeastRatio) : kLeastRatio),
        margin_(2 * limits.reach_px + kApart),
        points_(tile + 2 * margin_),
        above_(tile + 2 * margin_),
        below_(tile + 2 * margin_),
        alike_(tile + 2 * margin_) {}

  [[nodiscard]] int side() const { return points_.side; }
  [[nodiscard]] int margin() const { return margin_; }
  /// Line by line, each point's peak << 16 and the number of its sample; 0 for no point.
  [[nodiscard]] std::uint32_t* row(int line) { return points_.row(line); }

  /// Returns whether any point of the tile lies in a strip.
  bool find(std::vector<std::uint8_t>& marks) {
    above_.fill(kHighest);
    below_.fill(0);
    alike_.fill(0);
    for (int y = reach_; y < side() - reach_ - kApart; ++y) {
      for (int x = reach_; x < side() - reach_ - kApart; ++x) {
        compare(x, y, 1, 0);
        compare(x, y, 0, 1);
      }
    }
    above_.gather(2 * reach_ + 1, kSmaller);
    below_.gather(2 * reach_ + 1, kLarger);
    alike_.gather(2 * kAlikeReach_px + 1, kLarger);
    bool any = false;
    marks.assign(static_cast<std::size_t>(tile_) * static_cast<std::size_t>(tile_), 0);
    for (int y = 0; y < tile_; ++y) {
      for (int x = 0; x < tile_; ++x) {
        const std::uint32_t point = points_.at(x + margin_, y + margin_);
        const int corner = margin_ - reach_;  // what was gathered reaches from there on
        const int index = index_of(point);
        const bool inside = index > above_.at(x + corner, y + corner) || index < below_.at(x + corner, y + corner) ||
                            alike_.at(x + margin_ - kAlikeReach_px, y + margin_ - kAlikeReach_px) != 0;
        if (point == 0 || !inside) continue;
        marks[static_cast<std::size_t>(y) * static_cast<std::size_t>(tile_) + static_cast<std::size_t>(x)] = 1;
        any = true;
      }
    }
    return any;
  }

 private:
  static int index_of(std::uint32_t point) { return static_cast<int>(point & kHighest); }

  /// The highest peak from (x, y) on in a direction, of the points nearer to the height of `index` than to `other`.
  double highest(int x, int y, int along_x, int along_y, int index, int other) {
    std::uint32_t peak = 0;
    for (int i = 0; i < reach_; ++i) {
      const std::uint32_t point = points_.at(x + i * along_x, y + i * along_y);
      if (std::abs(index_of(point) - index) < std::abs(index_of(point) - other)) peak = std::max(peak, point >> 16U);
    }
    return peak;
  }

  void compare(int x, int y, int along_x, int along_y) {
    const int u = x + kApart * along_x;
    const int v = y + kApart * along_y;
    const std::uint32_t one = points_.at(x, y);
    const std::uint32_t other = points_.at(u, v);
    const int first = index_of(one);
    const int second = index_of(other);
    if (one == 0 || other == 0 || std::abs(first - second) <= most_) return;
    const double before = highest(x, y, -along_x, -along_y, first, second);
    const double behind = highest(u, v, along_x, along_y, second, first);
    const int strong = before > behind ? first : second;
    if (std::max(before, behind) < least_ratio_ * std::min(before, behind)) {
      alike_.at(x + along_x, y + along_y) = 1;
      return;
    }
    const int between = (first + second) / 2;
    if (strong > between) {
      std::uint16_t& limit = above_.at(x + along_x, y + along_y);
      limit = std::min(limit, static_cast<std::uint16_t>(between));
    } else {
      std::uint16_t& limit = below_.at(x + along_x, y + along_y);
      limit = std::max(limit, static_cast<std::uint16_t>(between + 1));
    }
  }

  int tile_;
  int reach_;
  int most_;
  double least_ratio_;
  int margin_;
  Square<std::uint32_t> points_;
  Square<std::uint16_t> above_;  // points above this number lie in a strip
  Square<std::uint16_t> below_;
  Square<std::uint8_t> alike_;  // 1 at walls between sides of nearly the same sharpness
};

}  // namespace

int window_reach_px(const FocusSettings& settings) noexcept {
  const int distance = settings.focus_operator == FocusOperator::kIntensity ? 0 : settings.distance_px;
  return settings.window_px / 2 + distance;
}

JumpTiles::JumpTiles(int width, int height, const EdgeBandLimits& limits)
    : width_(width),
      tile_(std::max(kLeastTile_px, 4 * limits.reach_px)),
      columns_((width + tile_ - 1) / tile_),
      rows_((height + tile_ - 1) / tile_),
      most_(static_cast<std::uint16_t>(std::min(limits.most_samples, int{kHighest}))),
      jumps_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_)) {
  for (auto& row : last_index_) row.resize(static_cast<std::size_t>(width));
}

void JumpTiles::mark(int x, int y, int count, const std::uint16_t* one, const std::uint16_t* other,
                     const MaskReasons* one_mask, const MaskReasons* other_mask) {
  std::uint8_t& jump = jumps_[static_cast<std::size_t>(y / tile_) * static_cast<std::size_t>(columns_) +
                              static_cast<std::size_t>(x / tile_)];
  if (jump != 0 || count <= 0) return;
  jump = focus_kernels().any_apart(one + x, other + x, one_mask + x, other_mask + x, count, most_) ? 1 : 0;
}

void JumpTiles::compare(int y, const std::uint16_t* upper, const std::uint16_t* lower, const MaskReasons* upper_mask,
                        const MaskReasons* lower_mask) {
  for (int x = 0; x < width_; x += tile_) mark(x, y, std::min(tile_, width_ - x), upper, lower, upper_mask, lower_mask);
}

void JumpTiles::look_at(int y, const std::uint16_t* peak_index, const MaskReasons* mask,
                        const MaskReasons* upper_mask) {
  for (int x = 0; x < width_; x += tile_) {
    mark(x, y, std::min(tile_, width_ - kApart - x), peak_index, peak_index + kApart, mask, mask + kApart);
  }
  auto& upper = last_index_[y % kApart];
  if (shown_ >= kApart) compare(y, upper.data(), peak_index, upper_mask, mask);
  std::copy_n(peak_index, width_, upper.begin());
  ++shown_;
}

void JumpTiles::join(const JumpTiles& other) {
  for (std::size_t i = 0; i < jumps_.size(); ++i) jumps_[i] = static_cast<std::uint8_t>(jumps_[i] | other.jumps_[i]);
}

bool JumpTiles::near(int column, int row) const noexcept {
  for (int v = std::max(0, row - 1); v <= std::min(rows_ - 1, row + 1); ++v) {
    for (int u = std::max(0, column - 1); u <= std::min(columns_ - 1, column + 1); ++u) {
      if (jumps_[static_cast<std::size_t>(v) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(u)] != 0) {
        return true;
      }
    }
  }
  return false;
}

EdgeBands::EdgeBands(const JumpTiles& tiles, const EdgeBandLimits& limits, const Plane<MaskReasons>& mask,
                     const CurvesOfRow& curves, WorkerPool& pool)
    : side_(tiles.tile_px()) {
  for (int row = 0; row < tiles.rows(); ++row) {
    for (int column = 0; column < tiles.columns(); ++column) {
      if (tiles.near(column, row)) tiles_.push_back({column * side_, row * side_, {}});
    }
  }
  const int width = mask.width();
  const int height = mask.height();
  const int threads = pool.threads();
  pool.run(tiles_.empty() ? 0 : threads, [&](int thread) {
    Surroundings about(side_, limits);
    for (std::size_t i = static_cast<std::size_t>(thread); i < tiles_.size(); i += static_cast<std::size_t>(threads)) {
      Tile& tile = tiles_[i];
      const int left = tile.x - about.margin();
      for (int line = 0; line < about.side(); ++line) {
        std::uint32_t* const row = about.row(line);
        std::fill_n(row, about.side(), 0U);
        const int y = tile.y - about.margin() + line;
        if (y < 0 || y >= height) continue;
        const CurveRow curve = curves(thread, y);
        const MaskReasons* const reasons = mask.row(y);
        for (int x = std::max(0, left); x < std::min(width, left + about.side()); ++x) {
          if ((reasons[x] & kNoPoint) != 0) continue;
          row[x - left] = static_cast<std::uint32_t>(curve.peak[x]) << 16U | curve.peak_index[x];
        }
      }
      if (!about.find(tile.marks)) tile.marks.clear();
    }
  });
}

void EdgeBands::apply(Plane<float>& height_m, Plane<float>& sigma_m, Plane<MaskReasons>& mask, WorkerPool& pool) const {
  pool.run(static_cast<int>(tiles_.size()), [&](int number) {
    const Tile& tile = tiles_[static_cast<std::size_t>(number)];
    if (tile.marks.empty()) return;
    for (int y = tile.y; y < std::min(mask.height(), tile.y + side_); ++y) {
      for (int x = tile.x; x < std::min(mask.width(), tile.x + side_); ++x) {
        const auto place = static_cast<std::size_t>(y - tile.y) * static_cast<std::size_t>(side_) +
                           static_cast<std::size_t>(x - tile.x);
        if (tile.marks[place] == 0) continue;
        mask.at(x, y) |= mask_reason::kEdgeBand;
        height_m.at(x, y) = std::numeric_limits<float>::quiet_NaN();
        sigma_m.at(x, y) = std::numeric_limits<float>::quiet_NaN();
      }
    }
  });
}

}  // namespace fvd
