#pragma once

/// Blocks of points, each told by a few values, so that a large map can be looked at as a small one.

#include <memory>

namespace fvd {

/// What stands for a block beside its lowest and its highest value.
enum class BlockValue {
  kMean,      ///< of heights, standard errors, grey levels
  kCommonest  ///< of codes, where a mean would mean nothing; of several the largest
};

/// Takes the rows of points of one row of blocks, then tells the blocks. Points that are NaN do not count; a block
/// without others is NaN. context: one thread at a time.
class BlockReducer {
 public:
  virtual ~BlockReducer() = default;
  /// Forgets what was added.
  virtual void begin() = 0;
  /// row: as many points as make_block_reducer() was told.
  virtual void add(const float* row) = 0;
  /// Each array has one element a block.
  virtual void finish(float* value, float* lowest, float* highest) const = 0;
};

/// points: of a row; the last block of a row has what remains. factor: points of a block, >= 1. Of more than 16
/// different codes in one block only the first 16 that come count.
[[nodiscard]] std::unique_ptr<BlockReducer> make_block_reducer(BlockValue value, int points, int factor);

}  // namespace fvd
