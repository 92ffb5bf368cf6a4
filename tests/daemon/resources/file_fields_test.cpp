#include "daemon/resources/file_fields.hpp"

#include <gmock/gmock.h>

namespace fvd {
namespace {

TEST(FileFields, TellTheTypeByTheEnding) {
  EXPECT_EQ(content_type_of("report.pdf"), "application/pdf");
  EXPECT_EQ(content_type_of("result.json"), "application/json");
  EXPECT_EQ(content_type_of("height.x3p"), "application/octet-stream");
  EXPECT_EQ(content_type_of("profile.html"), "application/octet-stream") << "nothing that a browser would run";
  EXPECT_EQ(content_type_of("picture.svg"), "application/octet-stream");
  EXPECT_EQ(content_type_of(""), "application/octet-stream");
}

TEST(FileFields, GiveEveryNameAsAnAttachment) {
  EXPECT_EQ(content_disposition("height.x3p"), R"(attachment; filename="height.x3p")");
  EXPECT_EQ(content_disposition("profile_tiefe 1.png"),
            R"(attachment; filename="profile_tiefe_1.png"; filename*=UTF-8''profile_tiefe%201.png)");
  EXPECT_EQ(content_disposition("profile_h\xC3\xB6he.png"),
            R"(attachment; filename="profile_h__he.png"; filename*=UTF-8''profile_h%C3%B6he.png)");
}

TEST(FileFields, AreEndedByNoName) {
  for (const std::string& name : {std::string("a\"; filename=\"b"), std::string("a\r\nSet-Cookie: x"),
                                  std::string("a\\\""), std::string("a\0b", 3), std::string(1000, '"')}) {
    const std::string field = content_disposition(name);
    EXPECT_THAT(field,
                testing::MatchesRegex("attachment; filename=\"[A-Za-z0-9._-]*\"; filename\\*=UTF-8''[A-Za-z0-9._%-]*"));
  }
}

}  // namespace
}  // namespace fvd
