/// A drive profile as it is written: read and written back, and mistakes deep inside.

#include "drivers/modbus/drive_document.hpp"

#include <filesystem>

#include <gmock/gmock.h>

#include "config/field_reader.hpp"
#include "config/field_writer.hpp"
#include "config/strict_json.hpp"
#include "tests/support/expect_error.hpp"

namespace fvd {
namespace {

using nlohmann::json;
using ::testing::AllOf;
using ::testing::HasSubstr;

const std::filesystem::path kProfiles = FVD_SOURCE_DIR "/config/drives";

DriveDocument read(const json& profile, Problems& problems) {
  DriveDocument document;
  FieldReader reader(profile, problems);
  describe(document, reader);
  reader.finish();
  return document;
}

nlohmann::ordered_json written(DriveDocument document) {
  return fields_to_json([&](Fields& fields) { describe(document, fields); });
}

json shipped(const std::filesystem::path& file) {
  Problems none;
  return parse_strict_json(read_text_file(file), none).value();
}

TEST(DriveDocument, OfEveryShippedProfileIsWrittenAsItIsRead) {
  int profiles = 0;
  for (const auto& entry : std::filesystem::directory_iterator(kProfiles)) {
    if (entry.path().extension() != ".json") continue;
    SCOPED_TRACE(entry.path().string());
    Problems problems;
    const auto text = written(read(shipped(entry.path()), problems)).dump();
    EXPECT_EQ(to_text(problems, ""), "");
    EXPECT_EQ(written(read(json::parse(text), problems)).dump(), text);
    EXPECT_EQ(to_text(problems, ""), "");
    EXPECT_NO_THROW((void)parse_drive_profile(text, "written"));
    ++profiles;
  }
  EXPECT_GE(profiles, 6);
}

/// What the generic profile with one change is refused for.
std::string refusal(const char* operation, const char* path, const json& value) {
  const json changed =
      shipped(kProfiles / "generic.json").patch({{{"op", operation}, {"path", path}, {"value", value}}});
  try {
    (void)parse_drive_profile(changed.dump(), "p");
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(DriveDocument, NamesMistakesDeepInside) {
  EXPECT_THAT(refusal("replace", "/status/moving", {{"all", json::array({{{"not", {{"register", "x"}}}}})}}),
              HasSubstr("/status/moving/all/0/not/register: 'x' is not one of the profile's registers"));
  EXPECT_THAT(
      refusal("add", "/sequences/stop/-",
              {{"if", {{"register", "status"}}}, {"then", json::array({{{"wait", {{"register", "status"}}}}})}}),
      HasSubstr("/sequences/stop/1/then/0/timeout_ms: is missing"));
  EXPECT_THAT(refusal("add", "/sequences/stop/-", {{"jump", 1}}),
              AllOf(HasSubstr("/sequences/stop/1: "), HasSubstr(R"(keys "write", "pulse", "modify")")));
  EXPECT_THAT(refusal("add", "/sequences/stop/-", {{"expect", json::array({json::array({"status"})})}}),
              HasSubstr("/sequences/stop/1/expect/0/1: is missing"));
  EXPECT_THAT(refusal("add", "/alarms/0x1G", "text"), HasSubstr("/alarms/0x1G: the key is not accepted"));
  EXPECT_THAT(refusal("add", "/alarms/3", {{"text", "x"}, {"resetable", true}}),
              HasSubstr("did you mean 'resettable'"));
  EXPECT_THAT(refusal("replace", "/status/homed", "rememberd"),
              AllOf(HasSubstr("/status/homed"), HasSubstr("\"remembered\"")));
  EXPECT_THAT(refusal("replace", "/status/homed", "remembered"), HasSubstr("/target_register: is missing"));
  EXPECT_THAT(refusal("add", "/status/moving/differs", 0), "");
  EXPECT_THAT(refusal("add", "/sequences/stop/-", {{"delay_ms", "0x1F"}}), "") << "times too";
  EXPECT_THAT(refusal("add", "/status/moving", {{"register", "status"}, {"equals", 1}, {"differs", 1}}),
              HasSubstr("/status/moving: has equals and differs"));
  EXPECT_THAT(refusal("add", "/registers/status/write_function", 7), HasSubstr("5 or 15 for coils"));
  EXPECT_THAT(refusal("add", "/registers/status/access", "write"), HasSubstr("can only be written"));
}

TEST(DriveDocument, WithoutRegistersHasOneProblemNotOnePerName) {
  const std::string text = refusal("replace", "/registers", 5);
  EXPECT_THAT(text, HasSubstr("/registers: 5 is not an object"));
  EXPECT_EQ(text.find('\n'), std::string::npos) << text;
}

}  // namespace
}  // namespace fvd
