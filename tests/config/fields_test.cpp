/// Lists of objects, variants, optional values and relations between keys: read, written, and as a schema.

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <gmock/gmock.h>

#include "config/field_writer.hpp"
#include "tests/config/read_fields.hpp"

namespace fvd {
namespace {

using nlohmann::json;
using test::problem;
using test::problems_of;
using test::read;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

struct Step {
  std::string name;
  std::int64_t count = 1;
};

struct Plan {
  std::vector<Step> steps{{"first", 2}};
  std::string kind = "led";
  double current_ma = 20.0;
  std::string port = "a";
  std::int64_t low = 0;
  std::int64_t high = 10;
  std::optional<double> limit_um;
};

void describe(Fields& fields, Step& step) {
  fields.text("name", step.name, 8, "its name");
  fields.require("name");
  fields.integer("count", step.count, {1, 9}, "how often");
}

void describe(Fields& fields, Plan& plan) {
  fields.list("steps", plan.steps, {0, 5}, "what is done", [](Fields& inner, Step& step) { describe(inner, step); });
  fields.variant("kind", plan.kind,
                 {{"led", [&](Fields& led) { led.number("current_ma", plan.current_ma, positive(100), "current"); }},
                  {"laser",
                   [&](Fields& laser) {
                     laser.text("port", plan.port, 8, "its port");
                     laser.require("port");
                   }}},
                 "kind of light");
  fields.integer("low", plan.low, {0, 100}, "lowest");
  fields.integer("high", plan.high, {0, 100}, "highest");
  fields.relate("low", static_cast<double>(plan.low), Relation::kAtMost, "high", static_cast<double>(plan.high), -3);
  fields.optional("limit_um", plan.limit_um, [](Fields& inner, double& value) {
    inner.number("limit_um", value, {0, 5}, "limit");
  });
}

json schema() {
  Plan plan;
  return json::parse(fields_to_schema([&](Fields& fields) { describe(fields, plan); }, "plan").dump());
}

TEST(ListOfObjects, IsReadInItsOrder) {
  Plan plan;
  EXPECT_THAT(read(R"({"steps": [{"name": "x", "count": 3}, {"name": "y"}]})", plan), IsEmpty());
  ASSERT_EQ(plan.steps.size(), 2U);
  EXPECT_EQ(plan.steps[0].name, "x");
  EXPECT_EQ(plan.steps[0].count, 3);
  EXPECT_EQ(plan.steps[1].name, "y");
  EXPECT_EQ(plan.steps[1].count, 1);
}

TEST(ListOfObjects, EmptyReplacesTheDefaultAndAbsentKeepsIt) {
  Plan plan;
  EXPECT_THAT(read("{}", plan), IsEmpty());
  EXPECT_EQ(plan.steps.size(), 1U);
  EXPECT_THAT(read(R"({"steps": []})", plan), IsEmpty());
  EXPECT_THAT(plan.steps, IsEmpty());
}

TEST(ListOfObjects, NamesThePlaceOfEveryWrongElementAndKeepsTheOldOnes) {
  Plan plan;
  const std::string text = R"({"steps": [{"name": "a"}, {"count": 2}, {"name": "c", "cuont": 2},
                                         {"name": "d", "count": 10}, 7]})";
  EXPECT_THAT(read(text, plan),
              ElementsAre(problem("/steps/1/name", "is missing"), problem("/steps/2/cuont", "did you mean 'count'"),
                          problem("/steps/3/count", "10 is not accepted"), problem("/steps/4", "not an object")));
  ASSERT_EQ(plan.steps.size(), 1U);
  EXPECT_EQ(plan.steps[0].name, "first");
}

TEST(ListOfObjects, RefusesWhatIsNoListAndTooMany) {
  EXPECT_THAT(problems_of<Plan>(R"({"steps": {"name": "a"}})"),
              ElementsAre(problem("/steps", "a list of 0..5 objects")));
  EXPECT_THAT(problems_of<Plan>(R"({"steps": null})"), ElementsAre(problem("/steps", "a list of 0..5 objects")));
  EXPECT_THAT(problems_of<Plan>(R"({"steps": [{}, {}, {}, {}, {}, {}]})"),
              ElementsAre(problem("/steps", "a list of 0..5 objects")));
}

TEST(Variant, HasTheMembersOfItsShape) {
  Plan plan;
  EXPECT_THAT(read(R"({"kind": "laser", "port": "b"})", plan), IsEmpty());
  EXPECT_EQ(plan.kind, "laser");
  EXPECT_EQ(plan.port, "b");
  EXPECT_THAT(problems_of<Plan>(R"({"current_ma": 5})"), IsEmpty()) << "the default shape needs no key";
}

TEST(Variant, RefusesMembersOfAnotherShapeAndMissingOnes) {
  EXPECT_THAT(problems_of<Plan>(R"({"kind": "laser", "current_ma": 5})"),
              ElementsAre(problem("/port", "is missing"), problem("/current_ma", "unknown key")));
  EXPECT_THAT(problems_of<Plan>(R"({"kind": "led", "port": "b"})"), ElementsAre(problem("/port", "unknown key")));
  EXPECT_THAT(problems_of<Plan>(R"({"kind": "led", "current_ma": "5"})"),
              ElementsAre(problem("/current_ma", "is not accepted")));
}

TEST(Variant, UnknownIsOneProblemWithAllShapesNamed) {
  EXPECT_THAT(problems_of<Plan>(R"({"kind": "lamp", "port": "b", "current_ma": 5})"),
              ElementsAre(problem("/kind", R"("lamp" is not accepted; expected one of "led", "laser")")));
  EXPECT_THAT(problems_of<Plan>(R"({"kind": 3, "other": 1})"),
              ElementsAre(problem("/kind", "3 is not accepted"), problem("/other", "unknown key")));
}

TEST(OptionalValue, IsThereOnlyWhereTheDocumentHasIt) {
  Plan plan;
  EXPECT_THAT(read("{}", plan), IsEmpty());
  EXPECT_EQ(plan.limit_um, std::nullopt);
  EXPECT_THAT(read(R"({"limit_um": 0})", plan), IsEmpty());
  EXPECT_EQ(plan.limit_um, 0.0);
}

TEST(OptionalValue, StaysAbsentWhereItIsWrong) {
  for (const char* text : {R"({"limit_um": 6})", R"({"limit_um": null})", R"({"limit_um": "1"})"}) {
    Plan plan;
    EXPECT_THAT(read(text, plan), ElementsAre(problem("/limit_um", "is not accepted"))) << text;
    EXPECT_EQ(plan.limit_um, std::nullopt) << text;
  }
}

TEST(RelationOfKeys, NamesBothKeysAndTheirValues) {
  EXPECT_THAT(problems_of<Plan>(R"({"low": 7})"), IsEmpty());
  EXPECT_THAT(problems_of<Plan>(R"({"low": 8})"),
              ElementsAre(problem("/low", "low is 8; expected at most high - 3, and high is 10")));
}

TEST(RelationOfKeys, IsNotJudgedWhereOneOfThemIsWrong) {
  EXPECT_THAT(problems_of<Plan>(R"({"low": 50, "high": 101})"), ElementsAre(problem("/high", "101 is not accepted")));
  EXPECT_THAT(problems_of<Plan>(R"({"low": "x", "high": 1})"), ElementsAre(problem("/low", "is not accepted")));
}

TEST(RelationOfKeys, IsJudgedBesideAProblemOfAnotherKey) {
  EXPECT_THAT(problems_of<Plan>(R"({"low": 9, "kind": 5})"),
              ::testing::UnorderedElementsAre(problem("/kind", "not accepted"), problem("/low", "at most high - 3")));
}

TEST(AProblem, IsAboutItsValueAndAllWithinIt) {
  const Problems problems{{"/a/b", "wrong"}, {"/c", "wrong"}};
  for (const char* reported : {"/a/b", "/a/b/0", "/c", "/c/d/e"}) EXPECT_TRUE(is_reported(problems, reported));
  for (const char* sound : {"/a", "/a/bc", "/a/d", "/cd", "/d", ""}) EXPECT_FALSE(is_reported(problems, sound));
  EXPECT_TRUE(is_reported({{"", "is no JSON"}}, "/a"));
}

TEST(RelationOfKeys, HoldsAtItsBorderOnlyWhereItIsClosed) {
  const auto accepted = [](Relation relation, double value) {
    const json object = json::object();
    Problems problems;
    FieldReader reader(object, problems);
    reader.relate("a", value, relation, "b", 5.0, 0.0);
    return problems.empty();
  };
  EXPECT_TRUE(accepted(Relation::kAtMost, 5.0));
  EXPECT_FALSE(accepted(Relation::kAtMost, 5.5));
  EXPECT_TRUE(accepted(Relation::kAtLeast, 5.0));
  EXPECT_FALSE(accepted(Relation::kAtLeast, 4.5));
  EXPECT_FALSE(accepted(Relation::kBelow, 5.0));
  EXPECT_TRUE(accepted(Relation::kBelow, 4.5));
  EXPECT_FALSE(accepted(Relation::kAbove, 5.0));
  EXPECT_TRUE(accepted(Relation::kAbove, 5.5));
}

TEST(ARangeOfOneNumber, IsSaidAsThatNumber) {
  Problems problems;
  std::int64_t format = 2;
  const auto describe_format = [&](Fields& fields) { fields.integer("format", format, {2, 2}, "of the document"); };
  read_document(R"({"format": 3})", describe_format, problems);
  EXPECT_THAT(problems, ElementsAre(Problem{"/format", "3 is not accepted; must be 2"}));
  EXPECT_THAT(schema_to_table(fields_to_schema(describe_format, "t")), HasSubstr("| `format` | 2 | `2` |"));
}

TEST(WrittenFields, ReadBackAsTheSameStructure) {
  Plan plan;
  plan.steps = {{"a", 4}, {"b", 5}};
  plan.kind = "laser";
  plan.port = "z";
  plan.limit_um = 2.5;
  const auto written = fields_to_json([&](Fields& fields) { describe(fields, plan); });
  EXPECT_EQ(written.dump(), R"({"steps":[{"name":"a","count":4},{"name":"b","count":5}],"kind":"laser","port":"z",)"
                            R"("low":0,"high":10,"limit_um":2.5})");
  Plan back;
  EXPECT_THAT(read(written.dump(), back), IsEmpty());
  EXPECT_EQ(fields_to_json([&](Fields& fields) { describe(fields, back); }), written);
}

TEST(WrittenFields, LeaveOutOptionalValuesThatAreAbsent) {
  Plan plan;
  EXPECT_FALSE(fields_to_json([&](Fields& fields) { describe(fields, plan); }).contains("limit_um"));
}

TEST(SchemaOfFields, HasOneShapePerVariant) {
  const json shapes = schema().at("oneOf");
  ASSERT_EQ(shapes.size(), 2U);
  EXPECT_EQ(shapes[0].at("properties").at("kind").at("const"), "led");
  EXPECT_TRUE(shapes[0].at("properties").contains("current_ma"));
  EXPECT_FALSE(shapes[0].at("properties").contains("port"));
  EXPECT_FALSE(shapes[0].contains("required")) << "the default shape needs no key";
  EXPECT_EQ(shapes[1].at("properties").at("kind").at("const"), "laser");
  EXPECT_EQ(shapes[1].at("required"), json({"kind", "port"}));
  for (const json& shape : shapes) {
    EXPECT_EQ(shape.at("additionalProperties"), false);
    EXPECT_TRUE(shape.at("properties").contains("steps")) << "described before the variant";
    EXPECT_TRUE(shape.at("properties").contains("low")) << "described after the variant";
  }
}

TEST(SchemaOfFields, DescribesTheElementsOfAList) {
  const json steps = schema().at("oneOf")[0].at("properties").at("steps");
  EXPECT_EQ(steps.at("type"), "array");
  EXPECT_EQ(steps.at("minItems"), 0);
  EXPECT_EQ(steps.at("maxItems"), 5);
  EXPECT_EQ(steps.at("default"), json::parse(R"([{"name": "first", "count": 2}])"));
  EXPECT_EQ(steps.at("items").at("required"), json({"name"}));
  EXPECT_EQ(steps.at("items").at("properties").at("count").at("maximum"), 9);
}

TEST(SchemaOfFields, SaysRelationsInWordsAndGivesAbsentValuesNoDefault) {
  const json properties = schema().at("oneOf")[0].at("properties");
  EXPECT_EQ(properties.at("low").at("description"), "lowest; at most high - 3");
  EXPECT_EQ(properties.at("limit_um").at("maximum"), 5.0);
  EXPECT_FALSE(properties.at("limit_um").contains("default"));
}

TEST(TableOfASchema, HasARowPerKey) {
  Plan plan;
  const std::string table = schema_to_table(fields_to_schema([&](Fields& fields) { describe(fields, plan); }, "plan"));
  EXPECT_THAT(table, HasSubstr("| `low` | 0 .. 100 | `0` | lowest; at most high - 3 |\n"));
  EXPECT_THAT(table, HasSubstr("| `steps[].name` | text | required | its name |\n"));
  EXPECT_THAT(table, HasSubstr("| `limit_um` | 0 .. 5 | none | limit |\n"));
  EXPECT_THAT(table, HasSubstr("| `kind` | `led` | `led` | kind of light |\n"));
  EXPECT_EQ(table.find("`low`"), table.rfind("`low`")) << "a key of all shapes stands once";
}

}  // namespace
}  // namespace fvd
