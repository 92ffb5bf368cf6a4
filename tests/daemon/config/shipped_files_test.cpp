/// The files in config/ against their JSON schemas, by a validator that knows nothing of our reader.

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validator.hpp>

#include "config/field_writer.hpp"
#include "daemon/config/config_file.hpp"
#include "daemon/recipes/recipe_document.hpp"
#include "daemon/recipes/recipe_folder.hpp"
#include "drivers/modbus/drive_profile.hpp"
#include "tests/support/expect_error.hpp"

namespace fvd {
namespace {

using nlohmann::json;

const std::filesystem::path kConfigFolder = FVD_CONFIG_FOLDER;

std::string text_of(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

json parse(const std::string& text) { return json::parse(text, nullptr, true, true); }

class Schema {
 public:
  explicit Schema(const std::string& text) {
    const json document = json::parse(text);
    valijson::SchemaParser(valijson::SchemaParser::kDraft7)
        .populateSchema(valijson::adapters::NlohmannJsonAdapter(document), schema_);
  }
  [[nodiscard]] bool accepts(const json& document) const {
    valijson::Validator validator;
    return validator.validate(schema_, valijson::adapters::NlohmannJsonAdapter(document), nullptr);
  }

 private:
  valijson::Schema schema_;
};

TEST(ShippedFiles, HoldTheSchemasThatTheProgramPrints) {
  EXPECT_EQ(text_of(kConfigFolder / "fvd.schema.json"), config_schema_text())
      << "run: fvd --print-config-schema > config/fvd.schema.json";
  EXPECT_EQ(text_of(kConfigFolder / "recipe.schema.json"), recipe_schema_text())
      << "run: fvd --print-recipe-schema > config/recipe.schema.json";
  EXPECT_EQ(text_of(kConfigFolder / "drive.schema.json"), drive_profile_schema_text())
      << "run: fvd --print-drive-schema > config/drive.schema.json";
}

class AShippedConfig : public ::testing::TestWithParam<std::string> {};

TEST_P(AShippedConfig, PassesReaderChecksAndSchema) {
  const auto file = kConfigFolder / GetParam();
  EXPECT_EQ(to_text(load_config(file).problems, GetParam()), "");
  EXPECT_TRUE(Schema(config_schema_text()).accepts(parse(text_of(file))));
}
INSTANTIATE_TEST_SUITE_P(All, AShippedConfig, ::testing::Values("fvd.json", "fvd-sim.json"));

TEST(ShippedFiles, HaveRecipesThatPassReaderSchemaAndTheSimulatedStage) {
  const auto folder = kConfigFolder / "recipes";
  const Config sim = load_config(kConfigFolder / "fvd-sim.json").config;
  const Schema schema(recipe_schema_text());
  const auto ids = list_recipes(folder);
  EXPECT_THAT(ids, ::testing::Contains("chapter"));
  for (const std::string& id : ids) {
    const Recipe recipe = parse_recipe(find_recipe_text(folder, id).value(), id);
    EXPECT_THAT(recipe.notes, ::testing::IsEmpty()) << id;
    EXPECT_TRUE(schema.accepts(parse(text_of(folder / (id + ".json"))))) << id;
    EXPECT_EQ(
        to_text(check_stage_limits(recipe, {sim.stage.min, sim.stage.max, sim.stage.take_up, sim.stage.speed_um_per_s}),
                id),
        "");
  }
}

/// Reader and schema are two descriptions of one thing: what one refuses the other does not accept.
TEST(ShippedFiles, HaveDriveProfilesThatPassReaderAndSchema) {
  const Schema schema(text_of(kConfigFolder / "drive.schema.json"));
  const auto reader_accepts = [](const json& profile) {
    try {
      (void)parse_drive_profile(profile.dump(), "profile");
      return true;
    } catch (const Error&) {
      return false;
    }
  };
  for (const auto& entry : std::filesystem::directory_iterator(kConfigFolder / "drives")) {
    if (entry.path().extension() != ".json") continue;
    SCOPED_TRACE(entry.path().string());
    const json profile = parse(text_of(entry.path()));
    EXPECT_TRUE(reader_accepts(profile));
    EXPECT_TRUE(schema.accepts(profile));
    const json mistakes = json::array({{{"op", "add"}, {"path", "/sped"}, {"value", 1}},
                                       {{"op", "replace"}, {"path", "/scale/steps_per_um"}, {"value", 0}},
                                       {{"op", "add"}, {"path", "/scale/direction"}, {"value", "up"}},
                                       {{"op", "replace"}, {"path", "/poll/0/address"}, {"value", 70000}},
                                       {{"op", "remove"}, {"path", "/status/moving"}},
                                       {{"op", "add"}, {"path", "/status/moving/colour"}, {"value", 1}},
                                       {{"op", "remove"}, {"path", "/sequences/stop"}},
                                       {{"op", "add"}, {"path", "/sequences/stop/-"}, {"value", {{"jump", 1}}}},
                                       {{"op", "add"}, {"path", "/sequences/stop/-"}, {"value", {{"delay_ms", -1}}}},
                                       {{"op", "add"}, {"path", "/sequences/stop/0/write/0/1"}, {"value", "$targets"}},
                                       {{"op", "add"}, {"path", "/alarms/0x99"}, {"value", 5}},
                                       {{"op", "replace"}, {"path", "/registers"}, {"value", 5}}});
    for (const json& mistake : mistakes) {
      SCOPED_TRACE(mistake.dump());
      const json wrong = profile.patch(json::array({mistake}));
      EXPECT_FALSE(reader_accepts(wrong));
      EXPECT_FALSE(schema.accepts(wrong));
    }
  }
}

TEST(ShippedFiles, HaveTheReferenceRecipe) {
  const Recipe chapter = parse_recipe(text_of(kConfigFolder / "recipes/chapter.json"), "chapter");
  EXPECT_EQ(chapter.start_um, -7);
  EXPECT_EQ(chapter.step_um, 10);
  EXPECT_EQ(chapter.slices, 21);
  EXPECT_EQ(chapter.focus.window_px, 9);
  EXPECT_EQ(chapter.focus.min_prominence, 0.5);
  EXPECT_EQ(chapter.peak, PeakMethod::kLogParabola);
  EXPECT_THAT(chapter.extra_peaks,
              ::testing::ElementsAre(PeakMethod::kNearest, PeakMethod::kParabola, PeakMethod::kFiveSample));
  EXPECT_EQ(chapter.focus.distance_px, 1);
}

struct DocumentedSchema {
  std::string readme;
  std::string name;  ///< of the table between "<!-- keys: NAME -->" and "<!-- end -->"
  std::string schema;

  friend std::ostream& operator<<(std::ostream& out, const DocumentedSchema& of) { return out << of.name; }
};

class ATableOfKeys : public ::testing::TestWithParam<DocumentedSchema> {};

TEST_P(ATableOfKeys, IsThatOfTheSchema) {
  const auto file = kConfigFolder / GetParam().readme;
  const std::string readme = text_of(file);
  const std::string begin = "<!-- keys: " + GetParam().name + " -->\n";
  const std::size_t from = readme.find(begin);
  const std::size_t to = readme.find("<!-- end -->", from);
  ASSERT_NE(from, std::string::npos) << begin;
  ASSERT_NE(to, std::string::npos) << "no <!-- end --> after it";
  const std::size_t table_begin = from + begin.size();
  const std::string table = schema_to_table(nlohmann::ordered_json::parse(GetParam().schema));

  if (std::getenv("FVD_WRITE_TABLES") != nullptr) {
    std::ofstream(file) << readme.substr(0, table_begin) << table << readme.substr(to);
    return;
  }
  EXPECT_EQ(readme.substr(table_begin, to - table_begin), table)
      << "run: FVD_WRITE_TABLES=1 build/tests/daemon/config/shipped_files_test --gtest_filter='*ATableOfKeys*'";
}
INSTANTIATE_TEST_SUITE_P(All, ATableOfKeys,
                         ::testing::Values(DocumentedSchema{"README.md", "fvd.json", config_schema_text()},
                                           DocumentedSchema{"README.md", "recipe", recipe_schema_text()},
                                           DocumentedSchema{"drives/README.md", "drive", drive_profile_schema_text()}),
                         [](const auto& of) { return of.param.name == "fvd.json" ? "config" : of.param.name; });

/// Values at and just outside the border of what a property accepts, and of other types.
std::vector<json> candidates(const json& property) {
  std::vector<json> values{nullptr, true, 0, -1, 0.5, "", "text", json::array(), json::object(), 1e300, -1e300};
  for (const char* bound : {"minimum", "maximum", "exclusiveMinimum"}) {
    if (!property.contains(bound)) continue;
    const json& limit = property[bound];
    values.push_back(limit);
    if (limit.is_number_integer()) {
      values.push_back(limit.get<std::int64_t>() - 1);
      values.push_back(limit.get<std::int64_t>() + 1);
    } else {
      values.push_back(limit.get<double>() - 1.0);
      values.push_back(limit.get<double>() + 1.0);
    }
  }
  if (property.contains("enum")) values.insert(values.end(), property["enum"].begin(), property["enum"].end());
  if (property.contains("items") && property["items"].contains("enum")) {
    const json& names = property["items"]["enum"];
    values.push_back(names);
    values.push_back(json::array({names[0], names[0]}));
    values.push_back(json::array({"other"}));
  }
  if (property.contains("maxLength")) {
    values.emplace_back(std::string(property["maxLength"].get<std::size_t>(), 'x'));
    values.emplace_back(std::string(property["maxLength"].get<std::size_t>() + 1, 'x'));
  }
  return values;
}

/// Puts every candidate in place of every key and compares the two verdicts.
void expect_same_verdicts(const std::string& schema_text, const json& good,
                          const std::function<bool(const std::string&)>& reader_accepts) {
  const Schema schema(schema_text);
  int compared = 0;
  const std::function<void(const json&, const json::json_pointer&)> visit = [&](const json& node,
                                                                                const json::json_pointer& place) {
    for (const auto& [name, property] : node["properties"].items()) {
      if (name == "$schema") continue;
      for (const json& value : candidates(property)) {
        json document = good;
        document[place / name] = value;
        EXPECT_EQ(schema.accepts(document), reader_accepts(document.dump())) << (place / name) << " = " << value.dump();
        ++compared;
      }
      if (property.contains("properties")) visit(property, place / name);
    }
  };
  visit(json::parse(schema_text), json::json_pointer());
  EXPECT_GT(compared, 200);
}

TEST(ConfigSchema, AcceptsExactlyWhatTheReaderAccepts) {
  Config defaults;
  expect_same_verdicts(config_schema_text(), json::parse(config_text(defaults)),
                       [](const std::string& text) { return parse_config(text, "").problems.empty(); });
}

TEST(RecipeSchema, AcceptsExactlyWhatTheReaderAccepts) {
  // Rules between keys are not the schema's: they are refused with other words than those of a range.
  const auto reader_accepts = [](const std::string& text) {
    const auto error = test::error_of([&] { (void)parse_recipe(text, "r"); });
    return !error || std::string(error->what()).find(" is even;") != std::string::npos ||
           std::string(error->what()).find("is for the intensity") != std::string::npos ||
           std::string(error->what()).find("is the peak already") != std::string::npos ||
           std::string(error->what()).find("expected at most slices - 3") != std::string::npos;
  };
  expect_same_verdicts(recipe_schema_text(), json::parse(R"({"format": 2,
                                       "acquire": {"scan": {"start_um": 0, "step_um": 1, "slices": 5, "settle": {}},
                                                   "camera": {}},
                                       "reconstruct": {"focus": {}, "lateral": {}}, "keep": {}})"),
                       reader_accepts);
}

}  // namespace
}  // namespace fvd
