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
constexpr double kUncertainty = 1.06;  // of the ratio of the sides' sharpness, which varies along a wall
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
  [[nodiscard]] std::size_t side_t() const { return static_cast<std::size_t>(side); }
  void fill(T value) { std::fill(values.begin(), values.end(), value); }

  int side;
  std::vector<T> values;
};

constexpr auto kLarger = [](auto a, auto b) { return a > b ? a : b; };
constexpr auto kSmaller = [](auto a, auto b) { return a < b ? a : b; };

/// Walls about a tile as limits of the samples' numbers, each of which holds as far as the wall's side reaches.
template <typename Pick>
class Reaches {
 public:
  /// none: what limits nothing.
  Reaches(int side, int reach_px, std::uint16_t none, Pick pick)
      : none_(none), pick_(pick), walls_(static_cast<std::size_t>(reach_px) + 1), limits_(side), before_(side) {}

  void add(int x, int y, int reach_px, int limit) {
    walls_[static_cast<std::size_t>(reach_px)].push_back({x, y, static_cast<std::uint16_t>(limit)});
  }
  /// Afterwards each place has the extreme limit of the walls that reach there, and there are no walls. A wall that
  /// reaches n px is spread n times to the places beside, together with those that reach less.
  void spread() {
    limits_.fill(none_);
    bool any = false;
    for (std::size_t reach = walls_.size(); reach-- > 0;) {
      for (const Wall& wall : walls_[reach]) {
        std::uint16_t& limit = limits_.at(wall.x, wall.y);
        limit = pick_(limit, wall.limit);
        any = true;
      }
      walls_[reach].clear();
      if (any && reach > 0) widen();
    }
  }
  [[nodiscard]] int at(int x, int y) { return limits_.at(x, y); }

 private:
  struct Wall {
    int x;
    int y;
    std::uint16_t limit;
  };

  /// By a place to all sides. Walls lie further from the square's rim than they reach.
  void widen() {
    const int side = limits_.side;
    for (int y = 0; y < side; ++y) {
      const std::uint16_t* const line = limits_.row(y);
      std::uint16_t* const wider = before_.row(y);
      wider[0] = line[0];
      for (int x = 1; x + 1 < side; ++x) wider[x] = pick_(line[x], pick_(line[x - 1], line[x + 1]));
      wider[side - 1] = line[side - 1];
    }
    for (int y = 1; y + 1 < side; ++y) {
      const std::uint16_t* const above = before_.row(y - 1);
      const std::uint16_t* const line = before_.row(y);
      const std::uint16_t* const below = before_.row(y + 1);
      std::uint16_t* const wider = limits_.row(y);
      for (int x = 0; x < side; ++x) wider[x] = pick_(line[x], pick_(above[x], below[x]));
    }
  }

  std::uint16_t none_;
  Pick pick_;
  std::vector<std::vector<Wall>> walls_;  // by how far they reach
  Square<std::uint16_t> limits_;
  Square<std::uint16_t> before_;
};

/// One tile with what its strips hang on: walls up to `reach` about it, and the points as far about those.
class Surroundings {
 public:
  Surroundings(int tile, const EdgeBandLimits& limits)
      : tile_(tile),
        limits_(limits),
        reach_(limits.reach_px()),
        margin_(2 * reach_ + kApart),
        points_(tile + 2 * margin_),
        above_(tile + 2 * margin_, reach_, kHighest, kSmaller),
        below_(tile + 2 * margin_, reach_, 0, kLarger) {}

  [[nodiscard]] int side() const { return points_.side; }
  [[nodiscard]] int margin() const { return margin_; }
  /// Line by line, each point's peak << 16 and the number of its sample; 0 for no point.
  [[nodiscard]] std::uint32_t* row(int line) { return points_.row(line); }

  /// Returns whether any point of the tile lies in a strip.
  bool find(std::vector<std::uint8_t>& marks) {
    for (int y = reach_; y < side() - reach_ - kApart; ++y) {
      for (int x = reach_; x < side() - reach_ - kApart; ++x) {
        compare(x, y, 1, 0);
        compare(x, y, 0, 1);
      }
    }
    above_.spread();
    below_.spread();
    bool any = false;
    marks.assign(static_cast<std::size_t>(tile_) * static_cast<std::size_t>(tile_), 0);
    for (int y = 0; y < tile_; ++y) {
      for (int x = 0; x < tile_; ++x) {
        const std::uint32_t point = points_.at(x + margin_, y + margin_);
        const int index = index_of(point);
        const bool inside = index > above_.at(x + margin_, y + margin_) || index < below_.at(x + margin_, y + margin_);
        if (point == 0 || !inside) continue;
        marks[static_cast<std::size_t>(y) * static_cast<std::size_t>(tile_) + static_cast<std::size_t>(x)] = 1;
        any = true;
      }
    }
    return any;
  }

 private:
  static int index_of(std::uint32_t point) { return static_cast<int>(point & kHighest); }

  /// The highest peak from (x, y) half a reach on in a direction and a pixel to either side, because walls have jags;
  /// of the points nearer to the height of `index` than to `other`.
  double highest(int x, int y, int along_x, int along_y, int index, int other) {
    std::uint32_t peak = 0;
    for (int i = 0; i < (reach_ + 1) / 2; ++i) {
      for (int j = -1; j <= 1; ++j) {
        const std::uint32_t point = points_.at(x + i * along_x + j * along_y, y + i * along_y + j * along_x);
        if (std::abs(index_of(point) - index) < std::abs(index_of(point) - other)) peak = std::max(peak, point >> 16U);
      }
    }
    return limits_.root_code ? static_cast<double>(peak) * peak : peak;
  }

  /// How far a side reaches across a wall, px.
  [[nodiscard]] int reach(double own, double others) const {
    int count = 0;
    while (count < reach_ && limits_.spill[static_cast<std::size_t>(count)] * kUncertainty * own >= others) ++count;
    return count;
  }

  void compare(int x, int y, int along_x, int along_y) {
    const int u = x + kApart * along_x;
    const int v = y + kApart * along_y;
    const std::uint32_t one = points_.at(x, y);
    const std::uint32_t other = points_.at(u, v);
    const int first = index_of(one);
    const int second = index_of(other);
    if (one == 0 || other == 0 || std::abs(first - second) <= limits_.most_samples) return;
    const double before = highest(x, y, -along_x, -along_y, first, second);
    const double behind = highest(u, v, along_x, along_y, second, first);
    const int upper_reach = first > second ? reach(before, behind) : reach(behind, before);
    const int lower_reach = first > second ? reach(behind, before) : reach(before, behind);
    const int between = (first + second) / 2;
    if (upper_reach > 0) above_.add(x + along_x, y + along_y, upper_reach, between);
    if (lower_reach > 0) below_.add(x + along_x, y + along_y, lower_reach, between + 1);
  }

  int tile_;
  const EdgeBandLimits& limits_;
  int reach_;
  int margin_;
  Square<std::uint32_t> points_;
  Reaches<decltype(kSmaller)> above_;  // points above a limit lie in a strip
  Reaches<decltype(kLarger)> below_;
};

/// The means over `count` successive values, times count.
std::vector<double> box_sums(const std::vector<double>& values, int count) {
  std::vector<double> sums(values.size() + static_cast<std::size_t>(count) - 1);
  for (std::size_t i = 0; i < values.size(); ++i) {
    for (std::size_t n = 0; n < static_cast<std::size_t>(count); ++n) sums[i + n] += values[i];
  }
  return sums;
}

}  // namespace

std::vector<double> edge_spill(const FocusSettings& settings) {
  const WindowSides sides = window_sides(settings);
  const int distance = settings.focus_operator == FocusOperator::kIntensity ? 0 : settings.distance_px;
  const std::vector<double> response(static_cast<std::size_t>(std::max(2 * distance, 1)), 1.0);
  const std::vector<double> weights = box_sums(box_sums(response, sides.first), sides.second);
  std::vector<double> spill(weights.begin() + static_cast<std::ptrdiff_t>(weights.size() / 2), weights.end());
  const double middle = spill.front();
  for (double& share : spill) share /= middle;
  spill.resize(std::min(spill.size(), static_cast<std::size_t>(settings.window_px / 2 + distance)));
  return spill;
}

JumpTiles::JumpTiles(int width, int height, const EdgeBandLimits& limits)
    : width_(width),
      tile_(std::max(kLeastTile_px, 4 * limits.reach_px())),
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
