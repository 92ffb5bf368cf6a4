/// Recipes.

#include "config/strict_json.hpp"
#include "daemon/api/methods/methods.hpp"
#include "daemon/api/replies.hpp"
#include "daemon/api/result_fields.hpp"
#include "daemon/recipes/recipe_document.hpp"

namespace fvd {

namespace {

constexpr std::size_t kMaxComment_bytes = 200;
constexpr IntegerRange kVersions{0, kLargestExactInteger};

void describe_id(Fields& fields, std::string& id) {
  fields.text("id", id, kMaxForeignText_bytes, "recipe id");
  fields.require("id");
}

void describe_document(Fields& fields, std::string& text) {
  fields.text("text", text, kMaxRecipeBytes, "the document as text");
  fields.require("text");
}

struct RecipeParams {
  std::string id;

  void describe(Fields& fields) { describe_id(fields, id); }
};

struct CheckParams {
  std::string text;
  std::string id = "checked";

  void describe(Fields& fields) {
    describe_document(fields, text);
    fields.text("id", id, kMaxForeignText_bytes, "recipe id, for messages");
  }
};

struct SaveParams {
  RecipeSave save;

  void describe(Fields& fields) {
    describe_id(fields, save.id);
    describe_document(fields, save.text);
    fields.integer("base_version", save.base_version, kVersions,
                   "version that the change was made from; 0 = the shipped recipe, or a new one");
    fields.require("base_version");
    fields.text("author", save.author, kMaxForeignText_bytes, "who saves it");
    fields.require("author");
    fields.text("comment", save.comment, kMaxComment_bytes, "why");
  }
};

struct RestoreParams {
  std::string id;
  std::int64_t version = 0;
  std::int64_t base_version = 0;
  std::string author;

  void describe(Fields& fields) {
    describe_id(fields, id);
    fields.integer("version", version, kVersions, "which one; 0 = the shipped recipe");
    fields.require("version");
    fields.integer("base_version", base_version, kVersions, "version that is in force");
    fields.require("base_version");
    fields.text("author", author, kMaxForeignText_bytes, "who saves it");
    fields.require("author");
  }
};

void describe_list(Fields& fields) {
  const ResultFields result(fields);
  result.any("recipes", "list of ids");
  result.any("entries",
             "list of objects: id, edited (it shadows the shipped recipe), version (0 = shipped); of one that no "
             "job can use error and error_message, too");
}

void describe_recipe(Fields& fields) {
  const ResultFields result(fields);
  result.text("id", "as given");
  result.any("recipe", "the recipe, an object");
  result.integer("version", "in force; 0 = the shipped recipe");
  result.text("text", "the document as it was written");
}

void describe_prepared(Fields& fields) { ResultFields(fields).text("recipe", "the recipe's id"); }

void describe_check(Fields& fields) {
  const ResultFields result(fields);
  result.boolean("accepted", "whether it would be a recipe");
  result.any("refusal", "every problem with its place; null where it is accepted");
  result.any("notes", "list of what the author should know although it is accepted");
  result.any("sha256", "of the document; null where it is refused");
}

void describe_versions(Fields& fields) {
  const ResultFields result(fields);
  result.text("id", "as given");
  result.any("versions", "list, the newest first: version, saved (UTC), author, comment, sha256");
}

void describe_saved(Fields& fields) {
  const ResultFields result(fields);
  result.text("id", "as given");
  result.integer("version", "now in force");
}

Reply list(const RecipeService& recipes) {
  Reply reply{{"recipes", Reply::array()}, {"entries", Reply::array()}};
  for (const RecipeEntry& entry : recipes.list()) {
    reply["recipes"].push_back(entry.id);
    Reply shown{{"id", entry.id}, {"edited", entry.edited}, {"version", entry.version}};
    if (entry.error) {
      shown["error"] = error_name(*entry.error);
      shown["error_message"] = entry.error_message;
    }
    reply["entries"].push_back(std::move(shown));
  }
  return reply;
}

Reply get(const RecipeService& recipes, const std::string& id) {
  const RecipeVersion current = recipes.get(id);
  Problems problems;
  const auto recipe = parse_strict_json(current.text, problems);
  throw_if_any(problems, ErrorCode::kBadRecipe, "recipe " + id);
  return {{"id", id}, {"recipe", *recipe}, {"version", current.version}, {"text", current.text}};
}

Reply check(const RecipeService& recipes, const CheckParams& params) {
  const RecipeCheck check = recipes.check(params.text, params.id);
  const bool accepted = check.refusal.empty();
  Reply reply{{"accepted", accepted}, {"refusal", nullptr}, {"notes", check.notes}, {"sha256", nullptr}};
  if (accepted) {
    reply["sha256"] = check.sha256;
  } else {
    reply["refusal"] = check.refusal;
  }
  return reply;
}

Reply versions(const RecipeService& recipes, const std::string& id) {
  Reply reply{{"id", id}, {"versions", Reply::array()}};
  for (const RecipeVersion& one : recipes.versions(id)) {
    reply["versions"].push_back({{"version", one.version},
                                 {"saved", one.saved_utc},
                                 {"author", one.author},
                                 {"comment", one.comment},
                                 {"sha256", one.sha256}});
  }
  return reply;
}

void add_reading_methods(MethodTable& methods, const Services& services) {
  using enum ErrorCode;
  methods["recipe.list"] = {.about = {.summary = "Ids and versions of all recipes",
                                      .role = Role::kView,
                                      .params = described<NoParams>(),
                                      .result = describe_list},
                            .run = [&recipes = services.recipes](const Call&) { return list(recipes); }};
  methods["recipe.get"] = {
      .about = {.summary = "One recipe, as values and as text",
                .role = Role::kView,
                .params = described<RecipeParams>(),
                .result = describe_recipe,
                .errors = {kUnknownRecipe, kBadRecipe}},
      .run = with<RecipeParams>(
          [&recipes = services.recipes](const Call&, const RecipeParams& params) { return get(recipes, params.id); })};
  methods["recipe.check"] = {
      .about = {.summary = "Says whether a document would be accepted as a recipe; keeps nothing",
                .role = Role::kView,
                .params = described<CheckParams>(),
                .result = describe_check},
      .run = with<CheckParams>(
          [&recipes = services.recipes](const Call&, const CheckParams& params) { return check(recipes, params); })};
  methods["recipe.versions"] = {
      .about = {.summary = "The versions of a recipe that are kept",
                .role = Role::kView,
                .params = described<RecipeParams>(),
                .result = describe_versions,
                .errors = {kUnknownRecipe}},
      .run = with<RecipeParams>([&recipes = services.recipes](const Call&, const RecipeParams& params) {
        return versions(recipes, params.id);
      })};
}

}  // namespace

void add_recipe_methods(MethodTable& methods, const Services& services) {
  using enum ErrorCode;
  add_reading_methods(methods, services);
  methods["recipe.prepare"] = {
      .about = {.summary = "Checks a recipe and makes it the one for jobs that name none, of all clients, until "
                           "another is prepared or any job names another",
                .role = Role::kOperate,
                .params = described<RecipeParams>(),
                .result = describe_prepared,
                .errors = {kNotReady, kBusy, kUnknownRecipe, kBadRecipe, kShuttingDown, kStageLimit, kObjectiveMismatch,
                           kRegionOutside, kMemoryBudget, kDatabase, kStorageFull},
                .needs_control = true,
                .is_audited = true},
      .run = with<RecipeParams>([&jobs = services.jobs](const Call&, const RecipeParams& params) {
        jobs.prepare(params.id);
        return Reply{{"recipe", params.id}};
      })};
  const std::vector<ErrorCode> saving{kBadInput,    kRecipeConflict, kBadRecipe, kUnknownRecipe,
                                      kStorageFull, kStorageWrite,   kDatabase};
  methods["recipe.save"] = {
      .about = {.summary = "Keeps a document as a new version of a recipe and puts it in force; refused where another "
                           "version than base_version is in force",
                .role = Role::kSetUp,
                .params = described<SaveParams>(),
                .result = describe_saved,
                .errors = saving,
                .is_audited = true},
      .run = with<SaveParams>([&recipes = services.recipes](const Call&, const SaveParams& params) {
        return Reply{{"id", params.save.id}, {"version", recipes.save(params.save)}};
      })};
  methods["recipe.restore"] = {
      .about = {.summary = "Saves an earlier version of a recipe anew",
                .role = Role::kSetUp,
                .params = described<RestoreParams>(),
                .result = describe_saved,
                .errors = saving,
                .is_audited = true},
      .run = with<RestoreParams>([&recipes = services.recipes](const Call&, const RestoreParams& params) {
        return Reply{{"id", params.id},
                     {"version", recipes.restore(params.id, params.version, params.base_version, params.author)}};
      })};
}

}  // namespace fvd
