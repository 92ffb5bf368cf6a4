#include "config/strict_json.hpp"
#include "daemon/api/methods.hpp"
#include "daemon/api/replies.hpp"
#include "daemon/api/rpc_errors.hpp"

namespace fvd {

namespace {

using nlohmann::ordered_json;

/// A text longer than parameters of type text may be. Throws ProtocolError if it is none.
std::string long_text(const nlohmann::json& params, const char* name) {
  const auto& value = params.at(name);
  if (value.is_string()) return value.get<std::string>();
  throw ProtocolError{json_rpc::kInvalidParams, std::string("parameter '") + name + "' is a text"};
}

ordered_json list(const RecipeService& recipes) {
  ordered_json reply{{"recipes", ordered_json::array()}, {"entries", ordered_json::array()}};
  for (const RecipeEntry& entry : recipes.list()) {
    reply["recipes"].push_back(entry.id);
    reply["entries"].push_back({{"id", entry.id}, {"edited", entry.edited}, {"version", entry.version}});
  }
  return reply;
}

ordered_json get(const RecipeService& recipes, const std::string& id) {
  const RecipeVersion current = recipes.get(id);
  Problems problems;
  const auto recipe = parse_strict_json(current.text, problems);
  throw_if_any(problems, ErrorCode::kBadRecipe, "recipe " + id);
  return {{"id", id}, {"recipe", *recipe}, {"version", current.version}, {"text", current.text}};
}

ordered_json check(const RecipeService& recipes, const nlohmann::json& params) {
  const RecipeCheck check = recipes.check(long_text(params, "text"), text_or(params, "id", "checked"));
  const bool accepted = check.refusal.empty();
  ordered_json reply{{"accepted", accepted}, {"refusal", nullptr}, {"notes", check.notes}, {"sha256", nullptr}};
  if (accepted) {
    reply["sha256"] = check.sha256;
  } else {
    reply["refusal"] = check.refusal;
  }
  return reply;
}

ordered_json versions(const RecipeService& recipes, const std::string& id) {
  ordered_json reply{{"id", id}, {"versions", ordered_json::array()}};
  for (const RecipeVersion& one : recipes.versions(id)) {
    reply["versions"].push_back({{"version", one.version},
                                 {"saved", one.saved_utc},
                                 {"author", one.author},
                                 {"comment", one.comment},
                                 {"sha256", one.sha256}});
  }
  return reply;
}

}  // namespace

void add_recipe_methods(MethodTable& methods, const Services& services) {
  constexpr ParamRange kVersions{0.0, static_cast<double>(kLargestExactInteger)};
  const Param id{"id", ParamType::kText, true, "recipe id"};
  const Param text{"text", ParamType::kAny, true, "the document as text, at most 32768 bytes"};
  const Param base{"base_version", ParamType::kInteger, true, "version the change was made from; 0 = shipped, or new",
                   kVersions};
  const Param author{"author", ParamType::kText, true, "who saves it"};
  methods["recipe.list"] = {.summary = "Ids and versions of all recipes", .params = {}, .run = [services](const Call&) {
                              return list(services.recipes);
                            }};
  methods["recipe.get"] = {
      .summary = "One recipe, as values and as text", .params = {id}, .run = [services](const Call& call) {
        return get(services.recipes, call.params["id"].get<std::string>());
      }};
  methods["recipe.prepare"] = {.summary = "Checks a recipe and makes it the one for jobs that name none",
                               .params = {id},
                               .run = [services](const Call& call) {
                                 services.jobs.prepare(call.params["id"].get<std::string>());
                                 return ordered_json{{"recipe", call.params["id"]}};
                               }};
  methods["recipe.check"] = {.summary = "Says whether a document would be accepted as a recipe; keeps nothing",
                             .params = {text, {"id", ParamType::kText, false, "recipe id, for messages"}},
                             .run = [services](const Call& call) { return check(services.recipes, call.params); }};
  methods["recipe.save"] = {
      .summary = "Keeps a document as a new version of a recipe and puts it in force",
      .params = {id, text, base, author, {"comment", ParamType::kAny, false, "a text of at most 200 bytes"}},
      .run = [services](const Call& call) {
        RecipeSave request{call.params["id"].get<std::string>(), long_text(call.params, "text"),
                           call.params["base_version"].get<std::int64_t>(), call.params["author"].get<std::string>(),
                           ""};
        if (call.params.contains("comment")) request.comment = long_text(call.params, "comment");
        return ordered_json{{"id", request.id}, {"version", services.recipes.save(request)}};
      }};
  methods["recipe.versions"] = {
      .summary = "The versions of a recipe that are kept, the newest first",
      .params = {id},
      .run = [services](const Call& call) { return versions(services.recipes, call.params["id"].get<std::string>()); }};
  methods["recipe.restore"] = {
      .summary = "Saves an earlier version of a recipe anew",
      .params = {id,
                 {"version", ParamType::kInteger, true, "which one; 0 = the shipped recipe", kVersions},
                 base,
                 author},
      .run = [services](const Call& call) {
        const auto wanted = call.params["id"].get<std::string>();
        const std::int64_t version = services.recipes.restore(wanted, call.params["version"].get<std::int64_t>(),
                                                              call.params["base_version"].get<std::int64_t>(),
                                                              call.params["author"].get<std::string>());
        return ordered_json{{"id", wanted}, {"version", version}};
      }};
}

}  // namespace fvd
