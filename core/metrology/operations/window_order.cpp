#include "core/metrology/operations/window_order.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>

namespace fvd::metrology {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kHole = std::numeric_limits<double>::quiet_NaN();

// The scans below are written in lanes, which the compiler turns into vector code; comparisons with a hole's NaN are
// false, so holes drop out by themselves.
constexpr std::size_t kLanes = 8;
using Lanes = std::array<double, kLanes>;

double next_above(const std::vector<double>& values, double pivot) {
  Lanes best;
  best.fill(kInfinity);
  for (std::size_t i = 0; i < values.size(); i += kLanes) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const double value = values[i + lane];
      const double candidate = value > pivot ? value : kInfinity;
      best[lane] = candidate < best[lane] ? candidate : best[lane];
    }
  }
  return *std::min_element(best.begin(), best.end());
}

double next_below(const std::vector<double>& values, double pivot) {
  Lanes best;
  best.fill(-kInfinity);
  for (std::size_t i = 0; i < values.size(); i += kLanes) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const double value = values[i + lane];
      const double candidate = value < pivot ? value : -kInfinity;
      best[lane] = candidate > best[lane] ? candidate : best[lane];
    }
  }
  return *std::max_element(best.begin(), best.end());
}

int total(const Lanes& counts) {
  double sum = 0.0;
  for (const double count : counts) sum += count;
  return static_cast<int>(sum);
}

int count_equal(const std::vector<double>& values, double pivot) {
  Lanes counts{};
  for (std::size_t i = 0; i < values.size(); i += kLanes) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) counts[lane] += values[i + lane] == pivot ? 1.0 : 0.0;
  }
  return total(counts);
}

}  // namespace

WindowOrder::WindowOrder(int window) : window_(window), pivot_(-kInfinity) {
  const std::size_t points = static_cast<std::size_t>(window) * static_cast<std::size_t>(window);
  values_.resize((points + kLanes - 1) / kLanes * kLanes);
  scratch_.reserve(points);
  clear();
}

void WindowOrder::clear() {
  std::fill(values_.begin(), values_.end(), kHole);
  valid_ = 0;
  pivot_ = -kInfinity;
  below_ = 0;
  at_pivot_ = 0;
}

void WindowOrder::replace_column(int slot, const double* values) {
  double* column = values_.data() + static_cast<std::ptrdiff_t>(slot) * window_;
  for (int i = 0; i < window_; ++i) {
    const double old = column[i];
    const double next = values[i];
    valid_ += static_cast<int>(next == next) - static_cast<int>(old == old);
    below_ += static_cast<int>(next < pivot_) - static_cast<int>(old < pivot_);
    at_pivot_ += static_cast<int>(next == pivot_) - static_cast<int>(old == pivot_);
    column[i] = next;
  }
}

/// Moves the pivot to the value that `rank` others precede.
void WindowOrder::seek(int rank) {
  while (below_ > rank) {
    pivot_ = next_below(values_, pivot_);
    at_pivot_ = count_equal(values_, pivot_);
    below_ -= at_pivot_;
  }
  while (below_ + at_pivot_ <= rank) {
    below_ += at_pivot_;
    pivot_ = next_above(values_, pivot_);
    at_pivot_ = count_equal(values_, pivot_);
  }
}

double WindowOrder::median() {
  assert(valid_ > 0);
  const int rank = (valid_ - 1) / 2;
  seek(rank);
  if (valid_ % 2 == 1 || rank + 1 < below_ + at_pivot_) return pivot_;
  return 0.5 * (pivot_ + next_above(values_, pivot_));
}

int WindowOrder::count_within(double centre, double reach) const {
  Lanes counts{};
  for (std::size_t i = 0; i < values_.size(); i += kLanes) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      counts[lane] += std::abs(values_[i + lane] - centre) < reach ? 1.0 : 0.0;
    }
  }
  return total(counts);
}

double WindowOrder::median_distance(double centre) {
  assert(valid_ > 0);
  scratch_.clear();
  for (const double value : values_) {
    if (!std::isnan(value)) scratch_.push_back(std::abs(value - centre));
  }
  std::sort(scratch_.begin(), scratch_.end());
  const std::size_t lower = (scratch_.size() - 1) / 2;
  const std::size_t upper = scratch_.size() / 2;
  return 0.5 * (scratch_[lower] + scratch_[upper]);
}

}  // namespace fvd::metrology
