/// Fields that contain themselves, hexadecimal numbers, rows, maps: read, written, and as a schema.

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
using ::testing::IsEmpty;

/// A condition contains conditions; its shape is the one whose key it has.
struct Condition {
  std::string kind;
  std::int64_t mask = 0;
  std::vector<Condition> parts;
};

void describe(Condition& condition, Fields& fields) {
  fields.keyed_variant(condition.kind,
                       {{"mask",
                         [&](Fields& in) {
                           in.integer64("mask", condition.mask, {0, 0xFFFF, true}, "bits");
                         }},
                        {"not",
                         [&](Fields& in) {
                           Condition inner;
                           if (!condition.parts.empty()) inner = condition.parts.front();
                           in.group_of("condition", "not", "does not hold", [&](Fields& one) { describe(inner, one); });
                           condition.parts = {inner};
                         }},
                        {"all", [&](Fields& in) {
                           in.list("all", condition.parts, {1, 3}, "all hold",
                                   [](Fields& one, Condition& part) { describe(part, one); }, {"condition"});
                         }}});
}

struct Write {
  std::string reg;
  std::string variable;
  std::int64_t value = 0;
};

struct Sheet {
  Condition condition;
  std::vector<Write> writes;
  std::map<std::string, double> factors;
};

void describe(Fields& fields, Sheet& sheet) {
  fields.group_of("condition", "condition", "what must hold", [&](Fields& in) { describe(sheet.condition, in); });
  const auto describe_write = [](Fields& in, Write& write) {
    in.text("0", write.reg, 8, "register");
    in.require("0");
    in.word_or("1", write.variable, {"$target", "$speed"}, [&](Fields& number) {
      number.integer64("1", write.value, {-5, 5, true}, "value");
    });
    in.require("1");
  };
  fields.list("writes", sheet.writes, {0, 5}, "what is sent", describe_write, {"", true});
  fields.map("factors", sheet.factors, "by name", [](Fields& in, const std::string& key, double& factor) {
    in.number(key, factor, positive(10), "a factor");
  });
}

constexpr const char* kSheet = R"({"condition": {"all": [{"mask": "0x1F"}, {"not": {"mask": 3}}]},
                                   "writes": [["a", "$speed"], ["b", -5]], "factors": {"x": 1.5, "y": 2}})";

TEST(KeyedVariant, IsReadAsDeepAsItIsWritten) {
  Sheet sheet;
  ASSERT_THAT(read(kSheet, sheet), IsEmpty());
  EXPECT_EQ(sheet.condition.kind, "all");
  ASSERT_EQ(sheet.condition.parts.size(), 2U);
  EXPECT_EQ(sheet.condition.parts[0].mask, 0x1F);
  EXPECT_EQ(sheet.condition.parts[1].kind, "not");
  EXPECT_EQ(sheet.condition.parts[1].parts.at(0).mask, 3);
}

TEST(KeyedVariant, NamesThePlaceOfAMistakeWithin) {
  EXPECT_THAT(problems_of<Sheet>(R"({"condition": {"all": [{"not": {"mask": 65536}}]}})"),
              ElementsAre(problem("/condition/all/0/not/mask", R"(integer or "0x.." within 0..65535)")));
  EXPECT_THAT(problems_of<Sheet>(R"({"condition": {"none": []}})"),
              ElementsAre(problem("/condition", R"(one of the keys "mask", "not", "all")"),
                          problem("/condition/none", "unknown key")));
  EXPECT_THAT(problems_of<Sheet>(R"({"condition": {"mask": 1, "not": {"mask": 2}}})"),
              ElementsAre(problem("/condition/not", "unknown key")));
  EXPECT_THAT(problems_of<Sheet>(R"({"condition": {"all": [7]}})"),
              ElementsAre(problem("/condition/all/0", "not an object")));
}

TEST(HexNumbers, AreTextsOfDigitsAndNothingElse) {
  for (const char* text : {"0x", "0x1G", "0x-1", "1F", "0x10000", "0x100000000", " 0x1", ""}) {
    EXPECT_THAT(problems_of<Sheet>(R"({"condition": {"mask": ")" + std::string(text) + R"("}})"),
                ElementsAre(problem("/condition/mask", "not accepted")))
        << text;
  }
}

TEST(ARow, IsReadByPosition) {
  Sheet sheet;
  ASSERT_THAT(read(kSheet, sheet), IsEmpty());
  ASSERT_EQ(sheet.writes.size(), 2U);
  EXPECT_EQ(sheet.writes[0].reg, "a");
  EXPECT_EQ(sheet.writes[0].variable, "$speed");
  EXPECT_EQ(sheet.writes[1].variable, "");
  EXPECT_EQ(sheet.writes[1].value, -5);
}

TEST(ARow, NamesThePositionOfAMistake) {
  EXPECT_THAT(problems_of<Sheet>(R"({"writes": [["a", "$sped"], ["b", 6], ["c"], ["d", 1, 2], "e"]})"),
              ElementsAre(problem("/writes/0/1", R"(or one of "$target", "$speed")"),
                          problem("/writes/1/1", R"(within -5..5, or one of)"), problem("/writes/2/1", "is missing"),
                          problem("/writes/3/2", "one too many"), problem("/writes/4", "is not a list")));
}

TEST(AMap, HasTheKeysOfTheDocument) {
  Sheet sheet;
  sheet.factors = {{"old", 1}};
  ASSERT_THAT(read(kSheet, sheet), IsEmpty());
  EXPECT_EQ(sheet.factors, (std::map<std::string, double>{{"x", 1.5}, {"y", 2.0}}));
  EXPECT_THAT(read(R"({"factors": {"z/1": 11}})", sheet), ElementsAre(problem("/factors/z~11", "above 0")));
  EXPECT_THAT(read(R"({"factors": 5})", sheet), ElementsAre(problem("/factors", "not an object")));
  EXPECT_EQ(sheet.factors.size(), 2U) << "a wrong one changes nothing";
}

TEST(WrittenFields, OfNestedShapesReadBackTheSame) {
  Sheet sheet;
  ASSERT_THAT(read(kSheet, sheet), IsEmpty());
  const auto written = fields_to_json([&](Fields& fields) { describe(fields, sheet); });
  EXPECT_EQ(written.dump(), R"({"condition":{"all":[{"mask":31},{"not":{"mask":3}}]},)"
                            R"("writes":[["a","$speed"],["b",-5]],"factors":{"x":1.5,"y":2.0}})");
  Sheet back;
  EXPECT_THAT(read(written.dump(), back), IsEmpty());
  EXPECT_EQ(fields_to_json([&](Fields& fields) { describe(fields, back); }), written);
}

TEST(SchemaOfFields, DefinesATypeThatContainsItselfOnce) {
  Sheet sheet;
  const json schema = json::parse(fields_to_schema([&](Fields& fields) { describe(fields, sheet); }, "sheet").dump());
  const json reference = json::parse(R"([{"$ref": "#/definitions/condition"}])");
  EXPECT_EQ(schema.at("properties").at("condition").at("allOf"), reference);
  const json shapes = schema.at("definitions").at("condition").at("oneOf");
  ASSERT_EQ(shapes.size(), 3U);
  EXPECT_EQ(shapes[1].at("properties").at("not").at("allOf"), reference);
  EXPECT_EQ(shapes[2].at("properties").at("all").at("items").at("allOf"), reference);
  EXPECT_EQ(shapes[2].at("required"), json({"all"}));
  EXPECT_EQ(schema.at("properties").at("factors").at("additionalProperties").at("maximum"), 10.0);
}

/// Values that may be null, and where: beside a word, a number, an object, anything.
struct Reading {
  bool has_no_value = true;
  double value_um = 0.0;
  bool has_no_verdict = false;
  std::string verdict = "pass";
  bool has_no_limits = true;
  double upper_um = 0.0;
  bool has_no_note = true;
  std::string note;
};

void describe(Fields& fields, Reading& reading) {
  fields.nullable_field("value_um", reading.has_no_value, [&](Fields& in) {
    in.number("value_um", reading.value_um, {-5.0, 5.0}, "a height");
  });
  fields.nullable_field("verdict", reading.has_no_verdict, [&](Fields& in) {
    in.choice("verdict", reading.verdict, {"pass", "fail"}, "of it");
  });
  fields.nullable_field("limits", reading.has_no_limits, [&](Fields& in) {
    in.group("limits", "of it", [&](Fields& group) { group.number("upper_um", reading.upper_um, {}, "a limit"); });
  });
  fields.nullable_field("note", reading.has_no_note, [&](Fields& in) { in.any("note", reading.note, 20, "anything"); });
  fields.require("value_um");
}

TEST(ANullableField, IsReadAsNullOrAsItsValue) {
  Reading none;
  EXPECT_THAT(read(R"({"value_um": null, "verdict": null, "limits": null, "note": null})", none), IsEmpty());
  EXPECT_TRUE(none.has_no_value && none.has_no_verdict && none.has_no_limits && none.has_no_note);
  Reading some;
  EXPECT_THAT(read(R"({"value_um": 1.5, "verdict": "fail", "limits": {"upper_um": 2}, "note": [1]})", some), IsEmpty());
  EXPECT_FALSE(some.has_no_value || some.has_no_verdict || some.has_no_limits || some.has_no_note);
  EXPECT_EQ(some.value_um, 1.5);
  EXPECT_EQ(some.verdict, "fail");
  EXPECT_EQ(some.upper_um, 2.0);
  EXPECT_EQ(some.note, "[1]");
}

TEST(ANullableField, IsRefusedWhereItIsNeither) {
  EXPECT_THAT(problems_of<Reading>(R"({"value_um": 6})"), ElementsAre(problem("/value_um", "-5..5, or null")));
  EXPECT_THAT(problems_of<Reading>(R"({"value_um": "1", "verdict": "good"})"),
              ElementsAre(problem("/value_um", ", or null"), problem("/verdict", "\"fail\", or null")));
  EXPECT_THAT(problems_of<Reading>(R"({"value_um": 1, "limits": {"lower_um": 2}})"),
              ElementsAre(problem("/limits/lower_um", "unknown key")));
  EXPECT_THAT(problems_of<Reading>("{}"), ElementsAre(problem("/value_um", "is missing")));
}

TEST(ANullableField, IsWrittenAndDescribedAsBoth) {
  Reading reading;
  const auto described = [&reading](Fields& fields) { describe(fields, reading); };
  EXPECT_EQ(json(fields_to_json(described)),
            json::parse(R"({"value_um": null, "verdict": "pass", "limits": null, "note": null})"));
  reading.has_no_value = false;
  EXPECT_EQ(fields_to_json(described)["value_um"], 0.0);

  const json properties = fields_to_schema(described, "reading")["properties"];
  EXPECT_EQ(properties["value_um"]["type"], (json{"number", "null"}));
  EXPECT_EQ(properties["verdict"]["enum"], (json{"pass", "fail", nullptr}));
  EXPECT_EQ(properties["limits"]["type"], (json{"object", "null"}));
  EXPECT_EQ(properties["limits"]["default"], nullptr);
  EXPECT_FALSE(properties["note"].contains("type")) << "anything is null, too";
}

}  // namespace
}  // namespace fvd
