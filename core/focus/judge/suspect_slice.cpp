#include "core/focus/judge/suspect_slice.hpp"

#include <cmath>
#include <iomanip>
#include <sstream>

#include "core/base/error.hpp"

namespace fvd {

namespace {

/// A reason's name, what it says of a slice, and what its figure is.
struct Words {
  std::string_view name;
  std::string_view says;
  std::string_view figure;
};

Words words(SuspectReason reason) noexcept {
  switch (reason) {
    case SuspectReason::kDark:
      return {"dark", "is dark", "brightness over its neighbours', or over full scale where it has none"};
    case SuspectReason::kBrighter:
      return {"brighter", "is far brighter than the others", "brightness over its neighbours'"};
    case SuspectReason::kConstant:
      return {"constant", "has the same grey level everywhere", "grey level of full scale"};
    case SuspectReason::kPartial:
      return {"partial", "was delivered in part", "share of its rows without a signal of their own"};
    case SuspectReason::kRepeated:
      return {"repeated", "is identical to the one before, to the bit", "share of its pixels that are the same"};
    case SuspectReason::kExchanged:
      return {"exchanged", "is out of order", "correlation of the step within with the step around"};
    case SuspectReason::kStandstill:
      return {"standstill", "shows the same as the one before but for noise", "change over that of the steps about it"};
    case SuspectReason::kVibration:
      return {"vibration", "was moved while it was exposed, or exposed twice",
              "logarithm of its sharpness over its neighbours', the strongest direction"};
  }
  return {};
}

/// Two figures, without an exponent.
std::string rounded(double value) {
  std::ostringstream text;
  if (std::abs(value) >= 10.0) {
    text << std::lround(value);
  } else {
    text << std::setprecision(2) << std::round(100.0 * value) / 100.0;
  }
  return text.str();
}

/// What the figure says to people; empty where it says them nothing.
std::string figure_words(const SuspectSlice& slice) {
  std::ostringstream text;
  const std::string percent = rounded(100.0 * std::abs(slice.figure));
  switch (slice.reason) {
    case SuspectReason::kDark:
      text << "its brightness is " << percent << " % of its neighbours', or of full scale where it has none";
      break;
    case SuspectReason::kBrighter:
      text << "its brightness is " << rounded(slice.figure) << " times its neighbours'";
      break;
    case SuspectReason::kConstant:
      text << "the level is " << percent << " % of full scale";
      break;
    case SuspectReason::kPartial:
      text << percent << " % of its rows have no signal of their own";
      break;
    case SuspectReason::kRepeated:
      break;
    case SuspectReason::kExchanged:
      text << "slices farther off resemble it more than those beside it";
      break;
    case SuspectReason::kStandstill:
      text << "it changed by " << percent << " % of what slices change by there";
      break;
    case SuspectReason::kVibration:  // a logarithm of sharpness, which is a square of differences
      text << "its fine detail differs from its neighbours' by a factor of "
           << rounded(std::exp(0.5 * std::abs(slice.figure)));
      break;
  }
  return text.str();
}

template <typename Value, typename Name>
std::optional<Value> from_name(const auto& all, Name name_of, std::string_view name) noexcept {
  for (const Value value : all) {
    if (name_of(value) == name) return value;
  }
  return std::nullopt;
}

}  // namespace

std::string_view suspect_reason_name(SuspectReason reason) noexcept { return words(reason).name; }

std::optional<SuspectReason> suspect_reason_from_name(std::string_view name) noexcept {
  return from_name<SuspectReason>(kAllSuspectReasons, suspect_reason_name, name);
}

std::string_view suspect_done_name(SuspectDone done) noexcept {
  return done == SuspectDone::kLeftOut ? "left_out" : "taken_again";
}

std::optional<SuspectDone> suspect_done_from_name(std::string_view name) noexcept {
  return from_name<SuspectDone>(kAllSuspectDone, suspect_done_name, name);
}

std::string_view suspect_figure_text(SuspectReason reason) noexcept { return words(reason).figure; }

std::string suspect_text(const SuspectSlice& slice) {
  const Words reason = words(slice.reason);
  std::ostringstream text;
  text.precision(6);
  text << (slice.file.empty() ? "slice " + std::to_string(slice.index) : slice.file) << " at " << slice.z_um << " um "
       << reason.says;
  const std::string figure = figure_words(slice);
  return figure.empty() ? text.str() : text.str() + " (" + figure + ")";
}

void throw_suspects(const std::vector<SuspectSlice>& suspects, int allowed_lost_slices) {
  std::ostringstream text;
  text << suspect_text(suspects.back()) << "; with it " << suspects.size() << " slice(s) must not be believed, "
       << allowed_lost_slices
       << " may be left out: mend the cause and take the slices again, or allow more by allowed_lost_slices of the "
          "recipe, --allowed-lost-slices of fvdctl process";
  throw Error(ErrorCode::kBadSlice, text.str());
}

}  // namespace fvd
