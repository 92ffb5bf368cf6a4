#include "core/metrology/operations/window_order.hpp"

#include <algorithm>
#include <array>
#include <cassert>

namespace fvd::metrology {
namespace {

// The scans below are loops over whole lanes of 16-bit numbers, eight of which the compiler puts into one register.
constexpr int kLanes = 8;
using Codes = std::vector<std::int16_t>;

using Lanes = std::array<std::int16_t, kLanes>;

/// The smallest code above the pivot.
std::int16_t next_above(const Codes& codes, std::int16_t pivot) {
  Lanes best;
  best.fill(32767);
  for (std::size_t i = 0; i < codes.size(); i += kLanes) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const std::int16_t code = codes[i + lane];
      const auto counts = static_cast<std::int16_t>(-static_cast<std::int16_t>(code > pivot));  // all bits or none
      const auto candidate = static_cast<std::int16_t>((code & counts) | (32767 & ~counts));
      best[lane] = candidate < best[lane] ? candidate : best[lane];
    }
  }
  return *std::min_element(best.begin(), best.end());
}

/// The largest code below the pivot.
std::int16_t next_below(const Codes& codes, std::int16_t pivot) {
  Lanes best;
  best.fill(kHoleCode);
  for (std::size_t i = 0; i < codes.size(); i += kLanes) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const std::int16_t code = codes[i + lane];
      const auto counts = static_cast<std::int16_t>(-static_cast<std::int16_t>(code < pivot));
      const auto candidate = static_cast<std::int16_t>((code & counts) | (kHoleCode & ~counts));
      best[lane] = candidate > best[lane] ? candidate : best[lane];
    }
  }
  return *std::max_element(best.begin(), best.end());
}

int count_equal(const Codes& codes, std::int16_t pivot) {
  std::int16_t count = 0;
  for (const std::int16_t code : codes) {
    count = static_cast<std::int16_t>(count + static_cast<std::int16_t>(code == pivot));
  }
  return count;
}

}  // namespace

WindowOrder::WindowOrder(int window)
    : window_(window),
      stride_((window + kLanes - 1) / kLanes * kLanes),
      codes_(static_cast<std::size_t>(window) * static_cast<std::size_t>(stride_)),
      pivot_(-kLastCode) {
  assert(window >= 1 && window <= 32);
  clear();
}

void WindowOrder::clear() {
  std::fill(codes_.begin(), codes_.end(), kHoleCode);
  valid_ = 0;
  pivot_ = -kLastCode;
  below_ = static_cast<int>(codes_.size());
  at_pivot_ = 0;
}

void WindowOrder::replace_column(int slot, const std::int16_t* codes) {
  std::array<std::int16_t, 32> next;
  next.fill(kHoleCode);
  std::copy_n(codes, window_, next.begin());
  std::int16_t* column = codes_.data() + static_cast<std::ptrdiff_t>(slot) * stride_;
  const std::int16_t pivot = pivot_;
  for (int first = 0; first < stride_; first += kLanes) {
    int valid = 0;
    int below = 0;
    int at_pivot = 0;
    for (int i = first; i < first + kLanes; ++i) {
      const std::int16_t code = next[static_cast<std::size_t>(i)];
      valid += static_cast<int>(code != kHoleCode) - static_cast<int>(column[i] != kHoleCode);
      below += static_cast<int>(code < pivot) - static_cast<int>(column[i] < pivot);
      at_pivot += static_cast<int>(code == pivot) - static_cast<int>(column[i] == pivot);
      column[i] = code;
    }
    valid_ += valid;
    below_ += below;
    at_pivot_ += at_pivot;
  }
}

/// Moves the pivot to the code that `rank` others precede, holes among them.
void WindowOrder::seek(int rank) {
  while (below_ > rank) {
    pivot_ = next_below(codes_, pivot_);
    at_pivot_ = count_equal(codes_, pivot_);
    below_ -= at_pivot_;
  }
  while (below_ + at_pivot_ <= rank) {
    below_ += at_pivot_;
    pivot_ = next_above(codes_, pivot_);
    at_pivot_ = count_equal(codes_, pivot_);
  }
}

WindowOrder::Middle WindowOrder::middle() {
  assert(valid_ > 0);
  const int rank = static_cast<int>(codes_.size()) - valid_ + (valid_ - 1) / 2;
  seek(rank);
  if (valid_ % 2 == 1 || rank + 1 < below_ + at_pivot_) return {pivot_, pivot_};
  return {pivot_, next_above(codes_, pivot_)};
}

int WindowOrder::count_between(int from, int to) const {
  const auto low = static_cast<std::int16_t>(from);
  const auto high = static_cast<std::int16_t>(to);
  std::int16_t count = 0;
  for (const std::int16_t code : codes_) {
    const auto outside =
        static_cast<std::int16_t>(static_cast<std::int16_t>(code < low) | static_cast<std::int16_t>(code > high));
    count = static_cast<std::int16_t>(count + outside);
  }
  return static_cast<int>(codes_.size()) - count;
}

}  // namespace fvd::metrology
