/// Lists of numbers and of free texts: read, written, and as a schema.

#include <string>
#include <vector>

#include <gmock/gmock.h>

#include "config/field_writer.hpp"
#include "tests/config/read_fields.hpp"

namespace fvd {
namespace {

using nlohmann::json;
using test::problem;
using test::read;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

struct Line {
  std::vector<double> from_um{0.0, 0.0};
  std::vector<std::string> regions;
};

void describe(Fields& fields, Line& line) {
  fields.numbers("from_um", line.from_um, positive(100.0), {2, 2}, "where it begins");
  fields.choices("regions", line.regions, {}, "that it crosses");
}

TEST(AListOfNumbers, IsReadAndWritten) {
  Line line;

  EXPECT_THAT(read(R"({"from_um": [1.5, 2], "regions": ["b", "a"]})", line), IsEmpty());

  EXPECT_THAT(line.from_um, ElementsAre(1.5, 2.0));
  EXPECT_THAT(line.regions, ElementsAre("b", "a"));
  EXPECT_EQ(fields_to_json([&](Fields& fields) { describe(fields, line); }).dump(),
            R"({"from_um":[1.5,2.0],"regions":["b","a"]})");
}

TEST(AListOfNumbers, IsRefusedWholeWhereOneIsWrong) {
  for (const char* text : {"5", "[1]", "[1, 2, 3]", "[1, 0]", "[1, 101]", "[1, \"2\"]", "[1, null]", "{}"}) {
    Line line;
    EXPECT_THAT(read(R"({"from_um": )" + std::string(text) + "}", line),
                ElementsAre(problem("/from_um", "a list of 2 numbers, each a number above 0 and up to 100")))
        << text;
    EXPECT_THAT(line.from_um, ElementsAre(0.0, 0.0));
  }
}

TEST(AListOfFreeTexts, RefusesRepeatedEmptyAndOtherValues) {
  for (const char* text : {R"(["a", "a"])", R"([""])", "[5]", R"("a")"}) {
    Line line;
    EXPECT_THAT(read(R"({"regions": )" + std::string(text) + "}", line),
                ElementsAre(problem("/regions", "a list without repetitions of texts")))
        << text;
  }
}

TEST(AListOfFreeTexts, MayBeAsLongAsAMessage) {
  constexpr int kMany = 150'000;
  json words = json::array();
  for (int i = 0; i < kMany; ++i) words.push_back(std::to_string(i));
  Line line;
  EXPECT_THAT(read(json{{"regions", words}}.dump(), line), IsEmpty());
  ASSERT_EQ(line.regions.size(), static_cast<std::size_t>(kMany));
  EXPECT_EQ(line.regions.front(), "0");
  EXPECT_EQ(line.regions.back(), "149999");
  words.push_back("0");
  Line refused;
  EXPECT_THAT(read(json{{"regions", words}}.dump(), refused),
              ElementsAre(problem("/regions", "a list without repetitions of texts")));
  EXPECT_THAT(refused.regions, IsEmpty());
}

TEST(SchemaOfLists, TellsNumbersAndTextsOfTheirElements) {
  Line line;

  const json schema = json::parse(fields_to_schema([&](Fields& fields) { describe(fields, line); }, "line").dump());

  const json& numbers = schema.at("properties").at("from_um");
  EXPECT_EQ(numbers.at("items").at("exclusiveMinimum"), 0.0);
  EXPECT_EQ(numbers.at("minItems"), 2);
  EXPECT_EQ(numbers.at("maxItems"), 2);
  EXPECT_EQ(schema.at("properties").at("regions").at("items").at("type"), "string");
}

}  // namespace
}  // namespace fvd
