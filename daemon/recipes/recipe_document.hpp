#pragma once

/// A recipe as a JSON document: its keys, its two formats, what makes one refused.

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "config/fields.hpp"
#include "config/problem.hpp"
#include "core/base/units.hpp"
#include "daemon/recipes/recipe.hpp"

namespace fvd {

/// The format that is written. The one before it, which had no key "format", is still read.
inline constexpr std::int64_t kRecipeFormat = 2;
/// Longer documents are refused: one fits into a request to the daemon with every quote escaped.
inline constexpr std::size_t kMaxRecipeBytes = 32768;

/// Every key with its range and meaning: the one place that defines them.
void describe(Recipe& recipe, Fields& fields);
/// Likewise of format 1.
void describe_format_1(Recipe& recipe, Fields& fields);

/// True for 1..32 characters out of A-Z a-z 0-9 _ -, which no path can be made of.
[[nodiscard]] bool is_recipe_id(std::string_view id) noexcept;

/// Hex digest of a document's bytes.
[[nodiscard]] std::string recipe_sha256(std::string_view bytes);

/// Either format; adds every problem with its JSON pointer. A value that one of them is about is at its default.
[[nodiscard]] Recipe read_recipe(std::string_view json_text, const std::string& id, Problems& problems);

/// Either format. Throws Error kBadRecipe with every problem and its JSON pointer.
[[nodiscard]] Recipe parse_recipe(std::string_view json_text, const std::string& id);

/// The document in format 2: keys moved to their new places, values as they are; comments are lost. Throws Error
/// kBadRecipe if it is refused, also where it is of format 2 already.
[[nodiscard]] std::string convert_recipe(std::string_view json_text, const std::string& id);

struct StageLimits {
  Micrometers min;
  Micrometers max;
  Micrometers take_up;
  double speed_um_per_s = 0.0;  ///< the highest
};

/// What of the recipe would leave the stage's limits: the take-up below the first slice, the last slice, and the speed
/// of a continuous scan. read: the problems of reading it; what rests on a value that they are about is not judged.
[[nodiscard]] Problems check_stage_limits(const Recipe& recipe, const StageLimits& stage, const Problems& read = {});

/// JSON Schema of format 2; config/recipe.schema.json is this text.
[[nodiscard]] std::string recipe_schema_text();

}  // namespace fvd
