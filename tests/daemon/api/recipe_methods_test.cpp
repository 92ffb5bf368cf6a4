/// What the methods of recipes answer and refuse.

#include "daemon/api/rpc_errors.hpp"
#include "gtest/gtest.h"
#include "tests/daemon/api/dispatcher_fixture.hpp"

namespace fvd {
namespace {

using nlohmann::json;

TEST_F(ADispatcher, KnowsRecipes) {
  EXPECT_EQ(result_of("recipe.list")["recipes"][0], "chapter");
  EXPECT_EQ(result_of("recipe.get", {{"id", "chapter"}})["recipe"]["scan"]["slices"], 21);
  EXPECT_EQ(result_of("recipe.prepare", {{"id", "chapter"}})["recipe"], "chapter");
  EXPECT_EQ(error_of(R"({"jsonrpc":"2.0","id":1,"method":"recipe.prepare","params":{"id":"nope"}})"), 1005);
}

TEST_F(ADispatcher, TellsARecipesTextAndItsVersion) {
  const json recipe = result_of("recipe.get", {{"id", "chapter"}});
  EXPECT_EQ(recipe["version"], 3);
  EXPECT_EQ(json::parse(recipe["text"].get<std::string>()), recipe["recipe"]);
  EXPECT_EQ(result_of("recipe.list")["entries"], json::parse(R"([{"id": "chapter", "edited": true, "version": 3}])"));
  const json versions = result_of("recipe.versions", {{"id", "chapter"}})["versions"];
  ASSERT_EQ(versions.size(), 1U);
  EXPECT_EQ(versions[0]["author"], "anna");
  EXPECT_FALSE(versions[0].contains("text"));
}

TEST_F(ADispatcher, ChecksADocumentWithoutAnError) {
  const json good = result_of("recipe.check", {{"text", "{\"scan\": {}}"}});
  EXPECT_EQ(good, json::parse(R"({"accepted": true, "refusal": null, "notes": ["has format 1"], "sha256": "abc"})"));
  const json bad = result_of("recipe.check", {{"text", "{}"}, {"id", "x"}});
  EXPECT_EQ(bad["accepted"], false);
  EXPECT_EQ(bad["refusal"], "recipe x: /format: is missing");
  EXPECT_TRUE(bad["sha256"].is_null());
}

TEST_F(ADispatcher, SavesARecipeAgainstItsBase) {
  json params{{"id", "chapter"}, {"text", std::string(20000, ' ')}, {"base_version", 3}, {"author", "bert"}};
  EXPECT_EQ(result_of("recipe.save", params)["version"], 4);
  EXPECT_EQ(service_.recipes.saved.text.size(), 20000U);
  EXPECT_EQ(service_.recipes.saved.author, "bert");
  EXPECT_EQ(service_.recipes.saved.comment, "");
  params["comment"] = std::string(100, 'c');
  (void)result_of("recipe.save", params);
  EXPECT_EQ(service_.recipes.saved.comment.size(), 100U);
  const auto error_with = [&](const char* key, const json& value) {
    json changed = params;
    changed[key] = value;
    return error_of(json{{"jsonrpc", "2.0"}, {"id", 1}, {"method", "recipe.save"}, {"params", changed}}.dump());
  };
  EXPECT_EQ(error_with("base_version", 2), 1017);
  EXPECT_EQ(error_with("base_version", -1), json_rpc::kInvalidParams);
  EXPECT_EQ(error_with("text", 5), json_rpc::kInvalidParams);
  EXPECT_EQ(error_with("comment", json::array()), json_rpc::kInvalidParams);
  EXPECT_EQ(error_with("author", nullptr), json_rpc::kInvalidParams);
  EXPECT_EQ(result_of("recipe.restore", {{"id", "chapter"}, {"version", 1}, {"base_version", 3}, {"author", "b"}}),
            json::parse(R"({"id": "chapter", "version": 4})"));
  EXPECT_EQ(service_.recipes.restored, 1);
}
}  // namespace
}  // namespace fvd
