#pragma once

/// A slice that must not be believed, and why.

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace fvd {

enum class SuspectReason {
  kDark,        ///< hardly any light
  kBrighter,    ///< far more light than the others, as of a flash
  kConstant,    ///< every pixel has the same grey level
  kPartial,     ///< delivered in part: the rest is empty, constant, or left over of the slice before
  kRepeated,    ///< identical to the slice before, to the bit
  kExchanged,   ///< out of order: it resembles the neighbours of its neighbour more than its own
  kStandstill,  ///< as the slice before but for noise: taken at the same height
  kVibration,   ///< blurred in one direction, or far less sharp than both neighbours: moved, or exposed twice
};

inline constexpr std::array kAllSuspectReasons{
    SuspectReason::kDark,     SuspectReason::kBrighter,  SuspectReason::kConstant,   SuspectReason::kPartial,
    SuspectReason::kRepeated, SuspectReason::kExchanged, SuspectReason::kStandstill, SuspectReason::kVibration};

/// What was done about it.
enum class SuspectDone {
  kLeftOut,     ///< the heights were made without it
  kTakenAgain,  ///< a second frame of the same height took its place
};

inline constexpr std::array kAllSuspectDone{SuspectDone::kLeftOut, SuspectDone::kTakenAgain};

/// Stable names, e.g. "dark", "left_out".
[[nodiscard]] std::string_view suspect_reason_name(SuspectReason reason) noexcept;
[[nodiscard]] std::optional<SuspectReason> suspect_reason_from_name(std::string_view name) noexcept;
[[nodiscard]] std::string_view suspect_done_name(SuspectDone done) noexcept;
[[nodiscard]] std::optional<SuspectDone> suspect_done_from_name(std::string_view name) noexcept;

struct SuspectSlice {
  int index = 0;  ///< of the slice, 0-based
  double z_um = 0.0;
  SuspectReason reason = SuspectReason::kDark;
  double figure = 0.0;  ///< what spoke against it; its meaning: suspect_figure_text()
  SuspectDone done = SuspectDone::kLeftOut;
  std::string file = {};  ///< of a recorded slice, as people name it; empty: it has none
  bool operator==(const SuspectSlice&) const = default;
};

/// What `figure` is, e.g. "brightness over its neighbours'"; the unit is 1 throughout.
[[nodiscard]] std::string_view suspect_figure_text(SuspectReason reason) noexcept;

/// E.g. "slice 10 at 100 um is dark (its brightness is 9 % of its neighbours', ...)"; of a recorded one
/// "s_010.png at 100 um ...".
[[nodiscard]] std::string suspect_text(const SuspectSlice& slice);

/// Throws Error kBadSlice: the last of them is one more than may be left out.
[[noreturn]] void throw_suspects(const std::vector<SuspectSlice>& suspects, int allowed_lost_slices);

}  // namespace fvd
