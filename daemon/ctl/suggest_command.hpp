#pragma once

/// The command `fvdctl suggest`: focus settings for a surface from recorded slices or one sharp image of it.

#include <string>

#include "daemon/ctl/fvdctl.hpp"
#include "drivers/replay/slice_files.hpp"

namespace fvd::ctl {

/// source: an image file, a folder of slices, a multi-page TIFF. choice: which files or pages of it. Prints the
/// settings as keys of a recipe, and what they rest on. Throws Error kBadInput naming the file.
[[nodiscard]] int run_suggest(const std::string& source, const StackChoice& choice, const Terminal& terminal);

}  // namespace fvd::ctl
