/// Recipes.

#include "config/strict_json.hpp"
#include "daemon/api/methods/methods.hpp"
#include "daemon/api/replies.hpp"
#include "daemon/api/result_fields.hpp"

namespace fvd {

namespace {

struct RecipeParams {
  std::string id;

  void describe(Fields& fields) {
    fields.text("id", id, kMaxForeignText_bytes, "recipe id");
    fields.require("id");
  }
};

void describe_ids(Fields& fields) { ResultFields(fields).any("recipes", "list of ids"); }

void describe_recipe(Fields& fields) {
  const ResultFields result(fields);
  result.text("id", "as given");
  result.any("recipe", "the recipe, an object");
}

void describe_prepared(Fields& fields) { ResultFields(fields).text("recipe", "the recipe's id"); }

}  // namespace

void add_recipe_methods(MethodTable& methods, const Services& services) {
  using enum ErrorCode;
  methods["recipe.list"] = {
      .about = {.summary = "Ids of all recipes", .params = described<NoParams>(), .result = describe_ids},
      .run = [&recipes = services.recipes](const Call&) {
        return Reply{{"recipes", recipes.recipe_ids()}};
      }};
  methods["recipe.get"] = {
      .about = {.summary = "One recipe",
                .params = described<RecipeParams>(),
                .result = describe_recipe,
                .errors = {kUnknownRecipe, kBadRecipe}},
      .run = with<RecipeParams>([&recipes = services.recipes](const Call&, const RecipeParams& params) {
        Problems problems;
        const auto recipe = parse_strict_json(recipes.recipe_json(params.id), problems);
        throw_if_any(problems, kBadRecipe, "recipe " + params.id);
        return Reply{{"id", params.id}, {"recipe", *recipe}};
      })};
  methods["recipe.prepare"] = {
      .about = {.summary = "Checks a recipe and makes it the one for jobs that name none",
                .params = described<RecipeParams>(),
                .result = describe_prepared,
                .errors = {kNotReady, kBusy, kUnknownRecipe, kBadRecipe, kShuttingDown, kStageLimit, kMemoryBudget}},
      .run = with<RecipeParams>([&jobs = services.jobs](const Call&, const RecipeParams& params) {
        jobs.prepare(params.id);
        return Reply{{"recipe", params.id}};
      })};
}

}  // namespace fvd
