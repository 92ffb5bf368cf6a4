#pragma once

/// The command `fvdctl recipe suggest-filters`: filters for texture by pitch, window and field, without a daemon.

#include <optional>
#include <string>
#include <vector>

#include "daemon/ctl/fvdctl.hpp"

namespace CLI {
class App;
}

namespace fvd::ctl {

/// The arguments as typed. What is given in numbers goes before what recipe or result tell.
struct SuggestFiltersArguments {
  std::string recipe;            ///< file; empty = none
  std::string result;            ///< folder; empty = none
  std::vector<double> pitch_um;  ///< of columns and rows, or one of both
  std::optional<double> window_px;
  std::vector<double> field_um;  ///< width and height
  bool json = false;             ///< only the fragment
};

void add_suggest_filters_options(CLI::App& command, SuggestFiltersArguments& arguments);

/// Prints the choice, the table of default settings and a section "evaluation" for the recipe. Throws UsageError where
/// pitch, window or field are neither given nor told; Error kBadInput, kBadRecipe.
[[nodiscard]] int run_suggest_filters(const SuggestFiltersArguments& arguments, const Terminal& terminal);

}  // namespace fvd::ctl
