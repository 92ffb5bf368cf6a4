#pragma once

/// The middle of a window that slides along a row, in coded heights.

#include <cstdint>
#include <vector>

namespace fvd::metrology {

/// Heights as 16-bit codes that rise with them. kHoleCode: no height. Codes from -kLastCode to kLastCode; the two
/// outermost ones also stand for all heights beyond them.
inline constexpr std::int16_t kHoleCode = -32768;
inline constexpr int kLastCode = 32766;

/// The codes of a window of window x window points, columns replaced one by one. Keeps one of them and how many are
/// below it, so that the next middle is found by few steps from the last one. context: one thread.
class WindowOrder {
 public:
  /// window: 1 to 32
  explicit WindowOrder(int window);

  /// Every point becomes a hole.
  void clear();
  /// Column `slot` (0 to window - 1) gets the codes of `window` points.
  void replace_column(int slot, const std::int16_t* codes);
  [[nodiscard]] int valid() const { return valid_; }
  /// The middle ones, in order; the same one twice where the number is odd. valid() > 0.
  struct Middle {
    int lower = 0;
    int upper = 0;
  };
  [[nodiscard]] Middle middle();
  /// How many codes lie in [from, to]; kHoleCode < from.
  [[nodiscard]] int count_between(int from, int to) const;

 private:
  void seek(int rank);

  int window_;
  int stride_;                       ///< window, filled up to whole lanes
  std::vector<std::int16_t> codes_;  ///< column after column; what fills up is holes
  int valid_ = 0;
  std::int16_t pivot_;
  int below_ = 0;     ///< codes < pivot_, holes among them
  int at_pivot_ = 0;  ///< codes == pivot_
};

}  // namespace fvd::metrology
