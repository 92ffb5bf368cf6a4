#include "core/focus/judge/slice_judge.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace fvd {

namespace {

/// Flicker of 20 % (standard deviation) stays within; its slices are only noisier, and their sharpness is corrected.
constexpr double kLeastLight = 0.4;
constexpr double kMostLight = 2.5;
/// Smaller differences are not corrected: they change a height by less than its noise, and a clean stack stays as it
/// is.
constexpr double kLeastFlicker = 0.002;
/// Share by which the reference follows the scene.
constexpr double kFollow = 0.25;
/// Share of a tile's samples at full scale with which the tile says nothing of the light.
constexpr double kMostClipped = 0.005;

}  // namespace

void SliceJudge::add(SliceFigures figures, int index, double z_um, bool constant,
                     const std::function<bool()>& identical) {
  Waiting slice;
  slice.slice.index = index;
  slice.slice.z_um = z_um;
  const auto condemn = [&slice](SuspectReason reason, double figure) {
    slice.suspect = true;
    slice.slice.reason = reason;
    slice.slice.figure = figure;
  };
  if (figures.tiles() > 0) {
    if (constant) {
      condemn(SuspectReason::kConstant, figures.samples.front() / figures.full_scale);
    } else if (same_samples(figures, last_added_) && identical()) {
      condemn(SuspectReason::kRepeated, 1.0);
    } else {
      note_noise(figures);
    }
    if (last_added_.tiles() > 0) rows_.compare(last_added_, figures);
    last_added_ = figures;
  }
  slice.figures = std::move(figures);
  waiting_.push_back(std::move(slice));
}

void SliceJudge::note_noise(const SliceFigures& figures) {
  const auto tiles = static_cast<std::size_t>(figures.tiles());
  least_.resize(tiles, std::numeric_limits<double>::infinity());
  second_least_.resize(tiles, std::numeric_limits<double>::infinity());
  for (std::size_t tile = 0; tile < tiles; ++tile) {
    const double sharpness = figures.sharpness(static_cast<int>(tile));
    if (sharpness < least_[tile]) {
      second_least_[tile] = std::exchange(least_[tile], sharpness);
    } else {
      second_least_[tile] = std::min(second_least_[tile], sharpness);
    }
  }
}

std::vector<const SliceFigures*> SliceJudge::next_believed() const {
  std::vector<const SliceFigures*> next;
  for (std::size_t i = 1; i < waiting_.size(); ++i) {
    if (!waiting_[i].suspect) next.push_back(&waiting_[i].figures);
  }
  return next;
}

/// Brightness over that of the slices before, or over that of those that follow the first.
double SliceJudge::light_of(const SliceFigures& figures, std::vector<const SliceFigures*>& next) const {
  if (!light_.empty()) return brightness_ratio(figures, light_) / level_;
  if (next.empty()) return 1.0;
  std::vector<double> mean(figures.means.size());
  const std::size_t count = std::min<std::size_t>(2, next.size());
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t tile = 0; tile < mean.size(); ++tile)
      mean[tile] += next[i]->means[tile] / static_cast<double>(count);
  }
  return brightness_ratio(figures, mean);
}

void SliceJudge::doubt_order(const Neighbours& next) {
  if (!last_believed_ || !before_last_ || next.size() < 3) return;
  const SliceFigures& oldest = waiting_.front().figures;
  if (!exchanged(*before_last_, *last_believed_, oldest, *next[0], *next[1], *next[2])) return;
  // A slice that was moved resembles its neighbours less, as if it were out of order.
  if (motion_of(*last_believed_, oldest, *next[0], second_least_).turned()) return;
  if (motion_of(oldest, *next[0], *next[1], second_least_).turned()) return;
  const double figure = order_of(*last_believed_, oldest, *next[0], *next[1]).correlation;
  for (Waiting& slice : waiting_) {
    if (&slice != &waiting_.front() && &slice.figures != next[0]) continue;
    slice.suspect = true;
    slice.slice.reason = SuspectReason::kExchanged;
    slice.slice.figure = figure;
  }
}

/// Shows what the slice before shows, but for noise: the stage did not move, or the camera sent what it had.
void SliceJudge::doubt_standstill(Waiting& oldest, const Neighbours& next) const {
  if (!last_believed_ || !before_last_ || next.empty()) return;
  const StandstillFigure figure = standstill_of(*before_last_, *last_believed_, oldest.figures, *next[0]);
  if (!figure.stood_still()) return;
  oldest.suspect = true;
  oldest.slice.reason = SuspectReason::kStandstill;
  oldest.slice.figure = figure.change;
}

void SliceJudge::doubt_motion(Waiting& oldest, const Neighbours& next) {
  if (!last_believed_ || next.empty()) return;
  const MotionFigure motion = motion_of(*last_believed_, oldest.figures, *next[0], second_least_);
  if (!motion.moved()) return;
  // A neighbour that was moved makes this one look odd by half as much.
  if (next.size() >= 2) {
    const MotionFigure of_next = motion_of(oldest.figures, *next[0], *next[1], second_least_);
    if (of_next.moved() && of_next.strength() > motion.strength()) return;
    if (next.size() >= 3 && order_of(oldest.figures, *next[0], *next[1], *next[2]).reversed()) return;
  }
  oldest.suspect = true;
  oldest.slice.reason = SuspectReason::kVibration;
  oldest.slice.figure = motion.direction >= -motion.sharpness ? motion.direction : motion.sharpness;
}

/// Beside a slice that is not believed the others are not evenly spaced: their order and sharpness say nothing.
SliceJudge::Neighbours SliceJudge::evenly_spaced_next() const {
  Neighbours next;
  int index = waiting_.front().slice.index;
  if (last_believed_index_ != index - 1) return next;
  for (std::size_t i = 1; i < waiting_.size(); ++i) {
    const Waiting& slice = waiting_[i];
    if (slice.suspect || slice.slice.index != ++index) break;
    const double light = brightness_ratio(slice.figures, waiting_.front().figures.means);
    const bool lit = !(light > 0.0 && light < kLeastLight) && light <= kMostLight;
    if (!lit || missing_share(slice.figures, waiting_.front().figures, rows_) > 0.0) break;
    next.push_back(&slice.figures);
  }
  return next;
}

std::optional<SuspectSlice> SliceJudge::doubt(Waiting& oldest) {
  if (oldest.suspect) return oldest.slice;
  std::vector<const SliceFigures*> next = next_believed();
  const auto condemned = [&oldest](SuspectReason reason, double figure) {
    oldest.slice.reason = reason;
    oldest.slice.figure = figure;
    return oldest.slice;
  };
  const SliceFigures* const near = last_believed_ ? &*last_believed_ : next.empty() ? nullptr : next[0];
  if (near != nullptr) {
    const double missing = missing_share(oldest.figures, *near, rows_);
    if (missing > 0.0) return condemned(SuspectReason::kPartial, missing);
  }
  const double light = light_of(oldest.figures, next);
  if (light > 0.0 && light < kLeastLight) return condemned(SuspectReason::kDark, light);
  if (light > kMostLight) return condemned(SuspectReason::kBrighter, light);
  const Neighbours even = evenly_spaced_next();
  doubt_order(even);
  if (!oldest.suspect) doubt_standstill(oldest, even);
  if (!oldest.suspect) doubt_motion(oldest, even);
  return oldest.suspect ? std::optional(oldest.slice) : std::nullopt;
}

void SliceJudge::note_flicker(double ratio) {
  ratios_.push_back(ratio);
  if (ratios_.size() > 3) ratios_.erase(ratios_.begin());
  if (ratios_.size() < 3) return;
  const double mean = (ratios_[0] + ratios_[1] + ratios_[2]) / 3.0;
  const double bend = (ratios_[1] - 0.5 * (ratios_[0] + ratios_[2])) / mean;
  flicker_squares_ += bend * bend / 1.5;  // of independent ratios
  ++flicker_count_;
}

double SliceJudge::flicker_percent() const noexcept {
  return flicker_count_ == 0 ? 0.0 : 100.0 * std::sqrt(flicker_squares_ / flicker_count_);
}

/// The reference without the tiles that are clipped in places: there the mean changes with the focus, as light that was
/// cut off in focus is spread over pixels that show it.
std::vector<double> SliceJudge::unclipped_light(const SliceFigures& figures) {
  std::vector<double> light = light_;
  clipped_.resize(light.size());
  for (std::size_t tile = 0; tile < light.size(); ++tile) {
    const std::uint16_t* const samples = figures.tile_samples(static_cast<int>(tile));
    const auto full = std::count(samples, samples + figures.samples_per_tile, figures.full_scale);
    if (static_cast<double>(full) > kMostClipped * figures.samples_per_tile) clipped_[tile] = true;
    if (clipped_[tile]) light[tile] = figures.full_scale;
  }
  return light;
}

double SliceJudge::accept(SliceFigures figures, int index) {
  double gain = 1.0;
  if (light_.empty()) {
    light_ = figures.means;
    (void)unclipped_light(figures);
    note_flicker(1.0);
  } else {
    const double unclipped = brightness_ratio(figures, unclipped_light(figures));
    const double ratio = unclipped > 0.0 ? unclipped : brightness_ratio(figures, light_);
    if (ratio > 0.0) {
      note_flicker(ratio);
      level_ += kFollow * (ratio - level_);
      for (std::size_t tile = 0; tile < light_.size(); ++tile) {
        light_[tile] += kFollow * (figures.means[tile] / ratio - light_[tile]);
      }
      if (unclipped > 0.0 && std::abs(ratio - 1.0) >= kLeastFlicker) gain = 1.0 / ratio;
    }
  }
  before_last_ = last_believed_index_ == index - 1 ? std::exchange(last_believed_, std::nullopt) : std::nullopt;
  last_believed_ = std::move(figures);
  last_believed_index_ = index;
  return gain;
}

std::optional<SliceDecision> SliceJudge::decide() {
  if (waiting_.empty()) return std::nullopt;
  const bool decided = waiting_.front().suspect || waiting_.front().figures.tiles() == 0;
  const bool enough = static_cast<int>(waiting_.size()) > kHeldBack;
  if (!decided && !enough && !closed_) return std::nullopt;
  SliceDecision decision;
  if (waiting_.front().figures.tiles() > 0) decision.suspect = doubt(waiting_.front());
  if (!decision.suspect && waiting_.front().figures.tiles() > 0)
    decision.gain = accept(std::move(waiting_.front().figures), waiting_.front().slice.index);
  waiting_.pop_front();
  return decision;
}

}  // namespace fvd
