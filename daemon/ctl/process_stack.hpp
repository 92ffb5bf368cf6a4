#pragma once

/// Recorded slices to a result directory, offline, through the same accumulator as the live scan.

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "daemon/recipes/recipe.hpp"
#include "daemon/result/result.hpp"
#include "drivers/replay/slice_heights.hpp"

namespace fvd::ctl {

struct ProcessOptions {
  std::filesystem::path source;  ///< folder of slices or multi-page TIFF
  std::filesystem::path out;     ///< result directory, must not exist
  SliceList slices;              ///< of the source
  int significant_bits = 0;      ///< see GreySurvey; 0 = seen from the levels
  ZSource z;
  bool simulated = false;          ///< the slices were recorded of simulated devices
  bool z_unit_assumed = false;     ///< z is a file, and nobody said that it is in um
  Recipe recipe;                   ///< its id may be empty
  bool recipe_plans_scan = false;  ///< the slices should be as many, and as far apart, as the recipe says
  bool knows_pixel_pitch = false;  ///< false: the recipe's is a default; the slices' own, or the files carry pixels
  int threads = 0;                 ///< 0 = one per core
  std::optional<bool> undo_drift;  ///< true: as the slices show it; false: not at all; absent: as the recipe says
  int allowed_lost_slices = 2;     ///< so many slices that must not be believed are left out
  std::string part_id;             ///< empty = the name of the source
  std::vector<Warning> warnings;   ///< go into the result
};

struct ProcessReport {
  std::string slices_text;  ///< which files were taken for slices
  std::string files_text;   ///< how many of the image files, and how many not
  Result result;
};

/// Reads a few slices at a time; writes only after the last one was good. on_slice(done, total) follows each slice.
/// Throws Error kBadInput naming the file, or as check_stack(); kBadSlice naming the slice
/// where too many must not be believed; kStorageWrite, kStorageFull; nothing is left in `out`
/// then.
ProcessReport process_stack(const ProcessOptions& options, const std::function<void(int, int)>& on_slice);

}  // namespace fvd::ctl
