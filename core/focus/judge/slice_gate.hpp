#pragma once

/// Between the source of slices and the focus stack: holds each slice back until it is believed.

#include <deque>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "core/focus/judge/slice_judge.hpp"

namespace fvd {

/// Item: what owns a slice's pixels; movable. context: one thread.
template <typename Item>
class SliceGate {
 public:
  /// Slices that the gate may hold between two calls of push().
  static constexpr int kHeldBack = SliceJudge::kHeldBack;

  /// Takes a believed slice, in order, and the gain of its sharpness.
  using Pass = std::function<void(Item&& item, double z_um, double gain)>;

  /// The file of the slice with this index, for messages.
  using FileOf = std::function<std::string(int index)>;

  /// allowed_lost_slices: so many suspects are left out; one more is an error. file_of: empty where slices have none.
  explicit SliceGate(int allowed_lost_slices, FileOf file_of = {})
      : allowed_(allowed_lost_slices), file_of_(std::move(file_of)) {}

  /// view: of the item's pixels, which stay where they are when it is moved. figures: of those pixels.
  /// Throws Error kBadSlice for one suspect too many.
  void push(Item&& item, const ImageView& view, SliceFigures figures, int index, double z_um, const Pass& pass) {
    const bool constant = figures.tiles() > 0 && one_level(figures) && is_constant(view);
    // The slice before is held unless it was passed on: then its pixels are gone, and so is the doubt.
    judge_.add(std::move(figures), index, z_um, constant,
               [&] { return !held_.empty() && is_identical(view, held_.back().view); });
    held_.push_back({std::move(item), view, z_um});
    pass_decided(pass);
  }

  /// After the last slice.
  void finish(const Pass& pass) {
    judge_.close();
    pass_decided(pass);
  }

  [[nodiscard]] const std::vector<SuspectSlice>& suspects() const noexcept { return suspects_; }
  [[nodiscard]] double flicker_percent() const noexcept { return judge_.flicker_percent(); }

 private:
  struct Held {
    Item item;
    ImageView view;
    double z_um;
  };

  void pass_decided(const Pass& pass) {
    while (auto decision = judge_.decide()) {
      Held held = std::move(held_.front());
      held_.pop_front();
      if (!decision->suspect) {
        pass(std::move(held.item), held.z_um, decision->gain);
        continue;
      }
      suspects_.push_back(*decision->suspect);
      if (file_of_) suspects_.back().file = file_of_(suspects_.back().index);
      if (static_cast<int>(suspects_.size()) > allowed_) throw_suspects(suspects_, allowed_);
    }
  }

  int allowed_;
  FileOf file_of_;
  SliceJudge judge_;
  std::deque<Held> held_;
  std::vector<SuspectSlice> suspects_;
};

}  // namespace fvd
