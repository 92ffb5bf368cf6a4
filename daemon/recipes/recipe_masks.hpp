#pragma once

/// The masks that a recipe's regions name: PNG files in the folder "masks" beside the recipes.
///
/// They are files of the administrator. Recipes that are saved name them and do not hold them: recipe.save and
/// recipe.restore look whether they can be read, versions keep the names alone, and a file that is replaced counts from
/// the next job on, whatever the version. The recipe's SHA-256 is that of its document; every result tells the SHA-256
/// of the masks that it used beside that.

#include <filesystem>

#include "config/problem.hpp"
#include "daemon/recipes/recipe.hpp"

namespace fvd {

struct StageLimits;

/// Reads masks/NAME of the folder for each region of shape mask_png into plan.masks. A file that is missing, no PNG of
/// 8 bit grey, above 64 MiB or 2^26 points, or without a point that is not 0 is a problem at the region's place behind
/// /evaluation; a name that a problem of `problems` is about is passed over. context: thread-safe.
void read_masks(const std::filesystem::path& folder, EvaluationPlan& plan, Problems& problems);

/// The recipe of a file, whose id is the file's name without suffix, with the masks beside it. Throws Error kBadRecipe
/// with every problem and its JSON pointer, kBadInput where the file cannot be read. stage: what leaves its limits is a
/// problem too; nullptr = not judged.
[[nodiscard]] Recipe read_recipe_file(const std::filesystem::path& file, const StageLimits* stage = nullptr);

}  // namespace fvd
