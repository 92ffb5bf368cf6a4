/// A recipe of either format: read, checked against a stage, and converted.

#include <spdlog/spdlog.h>

#include "core/base/error.hpp"
#include "daemon/recipes/recipe_document.hpp"
#include "tests/fuzz/fuzz_input.hpp"

namespace fvd::test {

namespace {

/// Whether the document can be converted; what it becomes is a recipe of the format that is written.
bool converts(std::string_view text) {
  try {
    const Recipe converted = parse_recipe(convert_recipe(text, "r"), "r");
    require(converted.format == kRecipeFormat);
    return true;
  } catch (const Error& error) {
    require(error.code() == ErrorCode::kBadRecipe);
    return false;
  }
}

}  // namespace

}  // namespace fvd::test

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace fvd;
  using namespace fvd::test;
  spdlog::set_level(spdlog::level::off);
  const std::string_view text = text_of({bytes, size});
  Problems problems;
  const Recipe recipe = read_recipe(text, "r", problems);
  for (const Problem& problem : problems) require(!problem.message.empty());
  const StageLimits stage{Micrometers{-1000.0}, Micrometers{1000.0}, Micrometers{50.0}, 2000.0};
  for (const Problem& problem : check_stage_limits(recipe, stage, problems)) require(!problem.message.empty());
  // What was read with problems is not converted; a good one of the older format is.
  const bool good = problems.empty();
  if (good) require(recipe.slices >= 3 && recipe.step_um > 0.0 && !recipe.sha256.empty());
  require(converts(text) == (good && recipe.format != kRecipeFormat));
  return 0;
}
