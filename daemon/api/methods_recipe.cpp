#include "config/strict_json.hpp"
#include "daemon/api/methods.hpp"

namespace fvd {

using nlohmann::ordered_json;

void add_recipe_methods(MethodTable& methods, const Services& services) {
  const Param id{"id", ParamType::kText, true, "recipe id"};
  methods["recipe.list"] = {.summary = "Ids of all recipes", .params = {}, .run = [services](const Call&) {
                              return ordered_json{{"recipes", services.recipes.recipe_ids()}};
                            }};
  methods["recipe.get"] = {.summary = "One recipe", .params = {id}, .run = [services](const Call& call) {
                             const auto wanted = call.params["id"].get<std::string>();
                             Problems problems;
                             const auto recipe = parse_strict_json(services.recipes.recipe_json(wanted), problems);
                             throw_if_any(problems, ErrorCode::kBadRecipe, "recipe " + wanted);
                             return ordered_json{{"id", wanted}, {"recipe", *recipe}};
                           }};
  methods["recipe.prepare"] = {.summary = "Checks a recipe and makes it the one for jobs that name none",
                               .params = {id},
                               .run = [services](const Call& call) {
                                 services.jobs.prepare(call.params["id"].get<std::string>());
                                 return ordered_json{{"recipe", call.params["id"]}};
                               }};
}

}  // namespace fvd
