#pragma once

/// Decides in the order of a scan which slices are believed, each by itself, by the slice before and by the three that
/// follow. A slice that is clean is never suspected; one that is suspected is left out of the stack.

#include <deque>
#include <functional>
#include <optional>
#include <vector>

#include "core/focus/judge/slice_compare.hpp"
#include "core/focus/judge/slice_figures.hpp"
#include "core/focus/judge/suspect_slice.hpp"

namespace fvd {

/// What was decided about the oldest slice that nothing had been decided about.
struct SliceDecision {
  double gain = 1.0;                    ///< its sharpness times this is as in the light of the first slice; 1: none
  std::optional<SuspectSlice> suspect;  ///< it must not be believed
};

/// context: one thread.
class SliceJudge {
 public:
  /// Slices that wait for those after them.
  static constexpr int kHeldBack = 3;

  /// Takes the next slice in. identical: whether its pixels are those of the slice added before; asked only if the
  /// samples are.
  void add(SliceFigures figures, int index, double z_um, bool constant, const std::function<bool()>& identical);

  /// The decision about the oldest slice; nothing as long as it depends on slices that may come.
  [[nodiscard]] std::optional<SliceDecision> decide();

  /// No more slices come: decide() says what is left.
  void close() noexcept { closed_ = true; }

  /// Root mean square of the brightness from slice to slice, slow changes of the lamp removed, in %.
  [[nodiscard]] double flicker_percent() const noexcept;

 private:
  struct Waiting {
    SliceFigures figures;
    SuspectSlice slice;
    bool suspect = false;
  };

  [[nodiscard]] std::optional<SuspectSlice> doubt(Waiting& oldest);
  [[nodiscard]] double light_of(const SliceFigures& figures, std::vector<const SliceFigures*>& next) const;
  [[nodiscard]] std::vector<const SliceFigures*> next_believed() const;
  using Neighbours = std::vector<const SliceFigures*>;
  [[nodiscard]] Neighbours evenly_spaced_next() const;
  void doubt_order(const Neighbours& next);
  void doubt_standstill(Waiting& oldest, const Neighbours& next) const;
  void doubt_motion(Waiting& oldest, const Neighbours& next);
  void note_noise(const SliceFigures& figures);
  [[nodiscard]] double accept(SliceFigures figures, int index);
  [[nodiscard]] std::vector<double> unclipped_light(const SliceFigures& figures);
  void note_flicker(double ratio);

  std::deque<Waiting> waiting_;
  SliceFigures last_added_;  // believed or not
  std::optional<SliceFigures> last_believed_;
  std::optional<SliceFigures> before_last_;  // where it was the slice before that one
  int last_believed_index_ = -2;
  LivingRows rows_;
  std::vector<double> light_;                 // of the tiles, in the light of the first slice; grey levels
  std::vector<double> least_, second_least_;  // squared second difference of each tile
  std::vector<bool> clipped_;                 // tiles in which a slice had more than a few pixels at full scale
  double level_ = 1.0;                        // of the light, over that of the first slice; follows a lamp that drifts
  std::vector<double> ratios_;                // the last three
  double flicker_squares_ = 0.0;
  int flicker_count_ = 0;
  bool closed_ = false;
};

}  // namespace fvd
