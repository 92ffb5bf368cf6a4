#include "daemon/views/block_reducer.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace fvd {

namespace {

constexpr float kHole = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

struct Extremes {
  float lowest = kInfinity;
  float highest = -kInfinity;
  std::uint32_t count = 0;  ///< of points that are no holes

  void add(float value) {
    lowest = std::min(lowest, value);
    highest = std::max(highest, value);
    ++count;
  }
};

class MeanBlock {
 public:
  void add(float value) {
    extremes_.add(value);
    sum_ += static_cast<double>(value);
  }
  [[nodiscard]] const Extremes& extremes() const { return extremes_; }
  [[nodiscard]] float value() const { return static_cast<float>(sum_ / extremes_.count); }

 private:
  Extremes extremes_;
  double sum_ = 0.0;
};

class CommonestBlock {
 public:
  void add(float value) {
    extremes_.add(value);
    // Neighbours are alike most of the time.
    if (used_ == 0 || codes_[last_] != value) {
      last_ = 0;
      while (last_ < used_ && codes_[last_] != value) ++last_;
      if (last_ == codes_.size()) {
        last_ = 0;
        return;
      }
      if (last_ == used_) codes_[used_++] = value;
    }
    ++counts_[last_];
  }
  [[nodiscard]] const Extremes& extremes() const { return extremes_; }
  [[nodiscard]] float value() const {
    std::size_t best = 0;
    for (std::size_t i = 1; i < used_; ++i) {
      if (counts_[i] > counts_[best] || (counts_[i] == counts_[best] && codes_[i] > codes_[best])) best = i;
    }
    return codes_[best];
  }

 private:
  Extremes extremes_;
  std::array<float, 16> codes_{};
  std::array<std::uint32_t, 16> counts_{};
  std::size_t used_ = 0;
  std::size_t last_ = 0;  // where the newest value counts
};

template <typename Block>
class Reducer final : public BlockReducer {
 public:
  Reducer(int points, int factor)
      : points_(points), factor_(factor), blocks_(static_cast<std::size_t>((points + factor - 1) / factor)) {}

  void begin() override { std::fill(blocks_.begin(), blocks_.end(), Block{}); }

  void add(const float* row) override {
    int x = 0;
    for (Block& kept : blocks_) {
      Block block = kept;  // in registers
      for (const int end = std::min(points_, x + factor_); x < end; ++x) {
        if (!std::isnan(row[x])) block.add(row[x]);
      }
      kept = block;
    }
  }

  void finish(float* value, float* lowest, float* highest) const override {
    for (const Block& block : blocks_) {
      const Extremes& extremes = block.extremes();
      const bool is_hole = extremes.count == 0;
      *value++ = is_hole ? kHole : block.value();
      *lowest++ = is_hole ? kHole : extremes.lowest;
      *highest++ = is_hole ? kHole : extremes.highest;
    }
  }

 private:
  const int points_;
  const int factor_;
  std::vector<Block> blocks_;
};

}  // namespace

std::unique_ptr<BlockReducer> make_block_reducer(BlockValue value, int points, int factor) {
  if (value == BlockValue::kMean) return std::make_unique<Reducer<MeanBlock>>(points, factor);
  return std::make_unique<Reducer<CommonestBlock>>(points, factor);
}

}  // namespace fvd
