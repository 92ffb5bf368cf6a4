#include "daemon/result/result.hpp"

#include <algorithm>

namespace fvd {

const MeasuredValue* Result::find(std::string_view name) const noexcept {
  const auto found = std::find_if(measurements.begin(), measurements.end(),
                                  [name](const MeasuredValue& value) { return value.name == name; });
  return found == measurements.end() ? nullptr : &*found;
}

double Result::valid_fraction() const noexcept {
  return points == 0 ? 0.0 : static_cast<double>(valid_points) / static_cast<double>(points);
}

std::string_view file_state_name(FileState state) noexcept {
  switch (state) {
    case FileState::kWritten:
      return "written";
    case FileState::kPending:
      return "pending";
    case FileState::kNotMade:
      return "not_made";
  }
  return "not_made";
}

std::optional<FileState> file_state_from_name(std::string_view name) noexcept {
  for (const FileState state : kAllFileStates) {
    if (name == file_state_name(state)) return state;
  }
  return std::nullopt;
}

std::string_view drift_undone_name(DriftUndone undone) noexcept {
  switch (undone) {
    case DriftUndone::kNothing:
      return "nothing";
    case DriftUndone::kRecipe:
      return "recipe";
    case DriftUndone::kSlices:
      return "slices";
  }
  return "nothing";
}

std::optional<DriftUndone> drift_undone_from_name(std::string_view name) noexcept {
  for (const DriftUndone undone : kAllDriftUndone) {
    if (name == drift_undone_name(undone)) return undone;
  }
  return std::nullopt;
}

std::string_view bin_choice_name(BinChoice choice) noexcept {
  switch (choice) {
    case BinChoice::kRecipe:
      return "recipe";
    case BinChoice::kEarlierScans:
      return "earlier_scans";
    case BinChoice::kSlices:
      return "slices";
    case BinChoice::kUnknownWidth:
      return "unknown_width";
  }
  return "unknown_width";
}

std::optional<BinChoice> bin_choice_from_name(std::string_view name) noexcept {
  for (const BinChoice choice : kAllBinChoices) {
    if (name == bin_choice_name(choice)) return choice;
  }
  return std::nullopt;
}

}  // namespace fvd
