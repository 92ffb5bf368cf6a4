#include "daemon/recipes/recipe_book.hpp"

#include <fstream>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "daemon/recipes/recipe_document.hpp"
#include "daemon/recipes/recipe_folder.hpp"
#include "daemon/store/job_store.hpp"
#include "tests/support/expect_error.hpp"
#include "tests/support/scratch_dir.hpp"

namespace fvd {
namespace {

using namespace std::string_literals;

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

std::string recipe_of(int slices) {
  return R"({"format": 2, "acquire": {"scan": {"start_um": 0, "step_um": 1, "slices": )" + std::to_string(slices) +
         "}}}";
}

std::string text_of(const std::filesystem::path& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

class ARecipeBook : public ::testing::Test {
 protected:
  ARecipeBook() {
    std::filesystem::create_directory(shipped_);
    put(shipped_ / "a.json", recipe_of(11));
    put(shipped_ / "b.json", recipe_of(12));
  }
  static void put(const std::filesystem::path& file, const std::string& text) { std::ofstream(file) << text; }
  [[nodiscard]] RecipeSave change(int slices, std::int64_t base, const std::string& author = "anna") const {
    return {"a", recipe_of(slices), base, author, "slices " + std::to_string(slices)};
  }
  [[nodiscard]] std::vector<std::string> edited_files() const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(edited_)) names.push_back(entry.path().filename());
    return names;
  }

  test::ScratchDir folder_;
  const std::filesystem::path shipped_ = folder_.path() / "shipped";
  const std::filesystem::path edited_ = folder_.path() / "edited";
  JobStore store_{folder_.path() / "fvd.sqlite"};
  RecipeBook book_{{shipped_, edited_}, {-10_um, 100_um, 5_um, 1000.0}, store_.recipe_versions()};
};

TEST_F(ARecipeBook, ShowsShippedRecipesFirst) {
  const auto entries = book_.list();
  ASSERT_THAT(entries, SizeIs(2));
  EXPECT_EQ(entries[0].id, "a");
  EXPECT_FALSE(entries[0].edited);
  EXPECT_EQ(entries[0].version, 0);
  EXPECT_EQ(book_.load("a").slices, 11);
  EXPECT_THAT(book_.versions("a"), IsEmpty());
  EXPECT_FALSE(std::filesystem::exists(edited_)) << "nothing was saved";
}

TEST_F(ARecipeBook, ShadowsAShippedRecipeAndLeavesItAlone) {
  EXPECT_EQ(book_.save(change(21, 0)), 1);

  EXPECT_EQ(book_.load("a").slices, 21);
  EXPECT_EQ(book_.load("b").slices, 12);
  EXPECT_EQ(text_of(shipped_ / "a.json"), recipe_of(11));
  EXPECT_THAT(edited_files(), ElementsAre("a.json")) << "no temporary file is left";
  EXPECT_TRUE(book_.list()[0].edited);
  EXPECT_EQ(book_.list()[0].version, 1);
}

TEST_F(ARecipeBook, KeepsANewRecipe) {
  EXPECT_EQ(book_.save({"new", recipe_of(5), 0, "anna", ""}), 1);
  EXPECT_EQ(book_.load("new").slices, 5);
  EXPECT_THAT(book_.list(), SizeIs(3));
}

TEST_F(ARecipeBook, TellsItsVersionsNewestFirst) {
  (void)book_.save(change(21, 0));
  (void)book_.save(change(22, 1, "bert"));

  const auto versions = book_.versions("a");
  ASSERT_THAT(versions, SizeIs(2));
  EXPECT_EQ(versions[0].version, 2);
  EXPECT_EQ(versions[0].author, "bert");
  EXPECT_EQ(versions[0].comment, "slices 22");
  EXPECT_EQ(versions[0].sha256, recipe_sha256(recipe_of(22)));
  EXPECT_THAT(versions[0].saved_utc, ::testing::MatchesRegex("20..-..-..T..:..:......Z"));
  EXPECT_EQ(versions[1].author, "anna");
}

TEST_F(ARecipeBook, RefusesAChangeOfAnOldVersionAndSaysWhoWasFirst) {
  (void)book_.save(change(21, 0, "anna"));

  FVD_EXPECT_ERROR_SAYING(kRecipeConflict, (void)book_.save(change(22, 0, "bert")),
                          AllOf(HasSubstr("version 1"), HasSubstr("'anna'"), HasSubstr("get the recipe anew")));
  FVD_EXPECT_ERROR(kRecipeConflict, (void)book_.save(change(22, 2, "bert")));
  EXPECT_EQ(book_.load("a").slices, 21);
  EXPECT_EQ(book_.save(change(22, 1, "bert")), 2);
}

TEST_F(ARecipeBook, LetsOneOfManyConcurrentChangesThrough) {
  std::atomic<int> saved = 0;
  std::atomic<int> refused = 0;
  std::vector<std::thread> threads;
  for (int i = 0; i < 8; ++i) {
    threads.emplace_back([&, i] {
      try {
        (void)book_.save(change(30 + i, 0, "author " + std::to_string(i)));
        ++saved;
      } catch (const Error& error) {
        EXPECT_EQ(error.code(), ErrorCode::kRecipeConflict) << error.what();
        ++refused;
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(saved, 1);
  EXPECT_EQ(refused, 7);
  EXPECT_THAT(book_.versions("a"), SizeIs(1));
}

TEST_F(ARecipeBook, MakesNoVersionOfTheTextInForce) {
  (void)book_.save(change(21, 0));
  EXPECT_EQ(book_.save(change(21, 1, "bert")), 1);
  EXPECT_THAT(book_.versions("a"), SizeIs(1));
}

TEST_F(ARecipeBook, RestoresAsANewVersion) {
  (void)book_.save(change(21, 0));
  (void)book_.save(change(22, 1));

  EXPECT_EQ(book_.restore("a", 1, 2, "bert"), 3);
  EXPECT_EQ(book_.load("a").slices, 21);
  EXPECT_EQ(book_.versions("a")[0].comment, "version 1 restored");
  EXPECT_EQ(book_.restore("a", 0, 3, "bert"), 4);
  EXPECT_EQ(book_.load("a").slices, 11) << "as shipped";
}

TEST_F(ARecipeBook, RestoresOnlyWhatItHas) {
  (void)book_.save({"new", recipe_of(5), 0, "anna", ""});
  FVD_EXPECT_ERROR_SAYING(kUnknownRecipe, (void)book_.restore("new", 2, 1, "anna"), HasSubstr("has no version 2"));
  FVD_EXPECT_ERROR_SAYING(kUnknownRecipe, (void)book_.restore("new", 0, 1, "anna"), HasSubstr("was shipped"));
  FVD_EXPECT_ERROR(kRecipeConflict, (void)book_.restore("new", 1, 0, "anna"));
  FVD_EXPECT_ERROR(kUnknownRecipe, (void)book_.restore("../a", 0, 0, "anna"));
}

TEST_F(ARecipeBook, KeepsTheNewestVersionsOnly) {
  for (int i = 0; i <= RecipeBook::kVersionsKept; ++i) ASSERT_EQ(book_.save(change(10 + i, i)), i + 1);

  const auto versions = book_.versions("a");
  EXPECT_THAT(versions, SizeIs(RecipeBook::kVersionsKept));
  EXPECT_EQ(versions.back().version, 2);
  FVD_EXPECT_ERROR(kUnknownRecipe, (void)book_.restore("a", 1, RecipeBook::kVersionsKept + 1, "anna"));
}

TEST_F(ARecipeBook, RefusesWhatItCannotKeepAndChangesNothing) {
  const auto with = [this](auto change_it) {
    RecipeSave request = change(21, 0);
    change_it(request);
    return request;
  };
  for (const std::string& id : {"../a"s, ""s, "."s, "a/b"s, "a\0"s, std::string(33, 'x'), "a.json"s}) {
    FVD_EXPECT_ERROR(kBadInput, (void)book_.save(with([&](RecipeSave& r) { r.id = id; })));
  }
  for (const std::string& author : {""s, std::string(65, 'x'), "a\nb"s, "a\0b"s, "\xc3\xa9"s}) {
    FVD_EXPECT_ERROR(kBadInput, (void)book_.save(with([&](RecipeSave& r) { r.author = author; })));
  }
  FVD_EXPECT_ERROR(kBadInput, (void)book_.save(with([](RecipeSave& r) { r.comment = std::string(201, 'x'); })));
  FVD_EXPECT_ERROR(kBadRecipe, (void)book_.save(with([](RecipeSave& r) { r.text = "{"; })));
  FVD_EXPECT_ERROR(kBadRecipe, (void)book_.save(with([](RecipeSave& r) { r.text.append(kMaxRecipeBytes, ' '); })));
  EXPECT_FALSE(std::filesystem::exists(edited_));
  EXPECT_THAT(book_.versions("a"), IsEmpty());
}

TEST_F(ARecipeBook, KeepsNoVersionWhoseFileCouldNotBeWritten) {
  (void)book_.save(change(21, 0));
  std::filesystem::create_directories(edited_ / "a.json.new" / "in the way");

  FVD_EXPECT_ERROR(kStorageWrite, (void)book_.save(change(22, 1)));
  EXPECT_EQ(book_.load("a").slices, 21);
  EXPECT_THAT(book_.versions("a"), SizeIs(1));
  EXPECT_EQ(book_.get("a").version, 1);
}

TEST_F(ARecipeBook, WritesOverWhatADeadProcessLeft) {
  std::filesystem::create_directory(edited_);
  put(edited_ / "a.json.new", "half a rec");
  EXPECT_EQ(book_.save(change(21, 0)), 1);
  EXPECT_THAT(edited_files(), ElementsAre("a.json"));
}

TEST_F(ARecipeBook, PutsATextInForceWhoseRowWasThereWhenTheProcessDied) {
  (void)book_.save(change(21, 0));
  put(edited_ / "a.json.new", recipe_of(22));
  (void)store_.recipe_versions().add({.id = "a", .author = "bert", .text = recipe_of(22)}, 10);

  const RecipeBook next({shipped_, edited_}, {-10_um, 100_um, 5_um, 1000.0},
                        store_.recipe_versions());  // the next start's

  EXPECT_EQ(next.load("a").slices, 22);
  EXPECT_EQ(next.get("a").version, 2);
  EXPECT_EQ(next.get("a").author, "bert");
  EXPECT_THAT(edited_files(), ElementsAre("a.json"));
}

TEST_F(ARecipeBook, DropsATextWithoutARow) {
  (void)book_.save(change(21, 0));
  put(edited_ / "a.json.new", recipe_of(22));

  const RecipeBook next({shipped_, edited_}, {-10_um, 100_um, 5_um, 1000.0}, store_.recipe_versions());

  EXPECT_EQ(next.load("a").slices, 21);
  EXPECT_THAT(next.versions("a"), SizeIs(1)) << "nobody changed it by hand";
  EXPECT_THAT(edited_files(), ElementsAre("a.json"));
}

TEST_F(ARecipeBook, TakesAVersionBackThatCannotBePutInForce) {
  std::filesystem::create_directories(edited_ / "a.json" / "in the way");

  FVD_EXPECT_ERROR(kStorageWrite, (void)book_.save(change(21, 0)));

  EXPECT_THAT(store_.recipe_versions().list("a"), IsEmpty());
  EXPECT_THAT(edited_files(), ElementsAre("a.json")) << "no temporary file is left";
}

TEST_F(ARecipeBook, MakesAVersionOfAFileThatWasChangedByHand) {
  (void)book_.save(change(21, 0));
  put(edited_ / "a.json", recipe_of(33));

  EXPECT_EQ(book_.load("a").slices, 33);
  FVD_EXPECT_ERROR_SAYING(kRecipeConflict, (void)book_.save(change(22, 1)), HasSubstr("version 2"));
  const auto versions = book_.versions("a");
  ASSERT_THAT(versions, SizeIs(2)) << "it is found once";
  EXPECT_THAT(versions[0].comment, HasSubstr("by hand"));
  EXPECT_EQ(book_.save(change(22, 2)), 3);
}

TEST_F(ARecipeBook, ShowsTheShippedRecipeAgainWhenTheEditedFileIsGone) {
  (void)book_.save(change(21, 0));
  std::filesystem::remove(edited_ / "a.json");

  EXPECT_EQ(book_.load("a").slices, 11);
  EXPECT_EQ(book_.get("a").version, 0);
  EXPECT_THAT(book_.versions("a"), SizeIs(1)) << "what was saved is not lost";
  EXPECT_EQ(book_.save(change(22, 0)), 2);
}

TEST_F(ARecipeBook, ChecksWithoutKeepingAnything) {
  const RecipeCheck good = book_.check(recipe_of(21), "a");
  EXPECT_EQ(good.refusal, "");
  EXPECT_EQ(good.sha256, recipe_sha256(recipe_of(21)));
  EXPECT_THAT(book_.check(R"({"scan": {"start_um": 0, "step_um": 1, "slices": 3}})", "a").notes,
              ElementsAre(HasSubstr("format 1")));
  EXPECT_THAT(book_.check(recipe_of(2), "a").refusal, HasSubstr("recipe a: /acquire/scan/slices: 2 is not accepted"));
  EXPECT_THAT(book_.check(recipe_of(200), "a").refusal, HasSubstr("expected at most 100")) << "the stage ends there";
  EXPECT_EQ(book_.check(recipe_of(200), "a").sha256, "");
  std::string two_mistakes = recipe_of(200);
  two_mistakes.insert(1, R"("x": 1, )");
  EXPECT_THAT(book_.check(two_mistakes, "a").refusal,
              AllOf(HasSubstr("/x: unknown key"), HasSubstr("expected at most 100")));
  EXPECT_FALSE(std::filesystem::exists(edited_));
}

TEST_F(ARecipeBook, NamesTheKnownRecipesWhenOneIsUnknown) {
  (void)book_.save({"new", recipe_of(5), 0, "anna", ""});
  FVD_EXPECT_ERROR_SAYING(kUnknownRecipe, (void)book_.load("c"), HasSubstr("a, b, new"));
  FVD_EXPECT_ERROR_SAYING(kUnknownRecipe, (void)book_.versions("c"), HasSubstr("a, b, new"));
}

TEST_F(ARecipeBook, TakesNoShippedRecipeWhereItCannotSeeTheEditedOne) {
  book_.save(change(13, 0));
  std::filesystem::rename(edited_, folder_.path() / "away");
  std::filesystem::create_symlink("edited", edited_);  // a circle: neither there nor absent
  FVD_EXPECT_ERROR_SAYING(kBadInput, (void)book_.load("a"), HasSubstr("cannot read"));
}

TEST_F(ARecipeBook, DoesNotLeaveItsFolders) {
  put(folder_.path() / "outside.json", recipe_of(3));
  put(shipped_ / "a", recipe_of(3));  // what "a\0.json" would open if the NUL ended the name
  ASSERT_EQ("a\0"s.size(), 2U) << "a NUL is part of the name";
  for (const std::string& id : {"../outside"s, "./a"s, ""s, "."s, ".."s, "a.json"s, "a\0"s, "a\0b"s}) {
    FVD_EXPECT_ERROR(kUnknownRecipe, (void)book_.load(id));
    FVD_EXPECT_ERROR(kUnknownRecipe, (void)book_.get(id));
    FVD_EXPECT_ERROR(kUnknownRecipe, (void)book_.versions(id));
  }
}

TEST_F(ARecipeBook, NamesTheRecipeThatIsBad) {
  put(shipped_ / "bad.json", "{");
  FVD_EXPECT_ERROR_SAYING(kBadRecipe, (void)book_.load("bad"), HasSubstr("recipe bad"));
  EXPECT_EQ(book_.get("bad").text, "{") << "it can be looked at and mended";
}

TEST_F(ARecipeBook, ListsABadRecipeWithItsErrorAmongTheOthers) {
  (void)book_.save(change(21, 0));
  put(shipped_ / "bad.json", "{");
  put(edited_ / "huge.json", std::string(2U << 20U, ' '));

  const auto entries = book_.list();

  ASSERT_THAT(entries, SizeIs(4));
  EXPECT_EQ(entries[0].id, "a");
  EXPECT_EQ(entries[0].version, 1);
  EXPECT_FALSE(entries[0].error);
  EXPECT_FALSE(entries[1].error);
  EXPECT_EQ(entries[2].error, ErrorCode::kBadRecipe);
  EXPECT_THAT(entries[2].error_message, HasSubstr("recipe bad"));
  EXPECT_EQ(entries[3].id, "huge");
  EXPECT_TRUE(entries[3].error.has_value());
  EXPECT_THAT(entries[3].error_message, HasSubstr("huge"));
}

TEST(ARecipeFolder, ListsItsRecipesSorted) {
  const test::ScratchDir folder;
  for (const char* name : {"b.json", "a.json", "notes.txt", "not an id.json", ".json", "c.json.new"}) {
    std::ofstream(folder.path() / name) << "{}";
  }
  std::filesystem::create_directory(folder.path() / "folder.json");
  EXPECT_THAT(list_recipes(folder.path()), ElementsAre("a", "b"));
  FVD_EXPECT_ERROR_SAYING(kBadInput, (void)list_recipes(folder.path() / "absent"), HasSubstr("absent"));
}

TEST(ARecipeStore, KeepsVersionsOverARestart) {
  const test::ScratchDir folder;
  const auto file = folder.path() / "fvd.sqlite";
  {
    JobStore store(file);
    (void)store.recipe_versions().add({.id = "a", .author = "anna", .text = "one\0two"s}, 10);
    store.recipe_versions().remove("a", store.recipe_versions().add({.id = "a", .text = "x"}, 10).version);
  }
  JobStore store(file);
  EXPECT_THAT(store.recipe_versions().list("a"), SizeIs(1));
  EXPECT_EQ(store.recipe_versions().latest("a").value().text, "one\0two"s);
  EXPECT_FALSE(store.recipe_versions().find("a", 2).has_value());
  EXPECT_EQ(store.recipe_versions().add({.id = "a", .author = "c", .text = "y"}, 10).version, 2);
}

}  // namespace
}  // namespace fvd
