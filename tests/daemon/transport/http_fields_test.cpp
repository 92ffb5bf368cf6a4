/// Fields of requests, and of answers.

#include "daemon/transport/http_fields.hpp"

#include <gtest/gtest.h>

#include "daemon/transport/http_routes.hpp"

namespace fvd {
namespace {

TEST(HttpFields, KnowWhoTakesGzip) {
  for (const char* takes : {"gzip", "GZip", "gzip, deflate, br", "br;q=1.0, gzip;q=0.8", "x-gzip", "*",
                            "deflate,*;q=0.1", "gzip;q=0.001", " gzip ", "gzip;level=1;q=1"}) {
    EXPECT_TRUE(takes_gzip(takes)) << takes;
  }
  for (const char* refuses : {"", "identity", "br", "gzip;q=0", "gzip; q=0.000", "*;q=0", "gzip;q=0, *", "gzipped", ";",
                              ",", "q=1", "agzip"}) {
    EXPECT_FALSE(takes_gzip(refuses)) << refuses;
  }
}

TEST(HttpFields, KnowWhatAClientHas) {
  for (const char* has : {"\"a1\"", "W/\"a1\"", "\"b\", \"a1\"", "\"b\" ,W/\"a1\"", "*", " * ", "\"a1\","}) {
    EXPECT_TRUE(names_etag(has, "\"a1\"")) << has;
  }
  EXPECT_TRUE(names_etag("\"a1\"", "W/\"a1\""));
  for (const char* has_not : {"", "a1", "\"a\"", "\"a11\"", "\"A1\"", "\"a1", "\"a1\"-gz", "**"}) {
    EXPECT_FALSE(names_etag(has_not, "\"a1\"")) << has_not;
  }
  EXPECT_FALSE(names_etag("*", "")) << "there is nothing that it could have";
  EXPECT_FALSE(names_etag("", ""));
}

TEST(HttpFields, LetNothingBeginAnotherField) {
  EXPECT_TRUE(is_field_value("attachment; filename=\"a b.tiff\""));
  EXPECT_TRUE(is_field_value(""));
  for (const char* bad : {"a\r\nSet-Cookie: x", "a\n", "a\r", "\x7f", "\xc3\xbc", "\x1b[0m"}) {
    EXPECT_FALSE(is_field_value(bad)) << bad;
  }
  EXPECT_TRUE(is_field_name("X-Fvd-Z-Um"));
  for (const char* bad : {"", "A B", "A:", "A\r\n", "\xc3\xbc"}) EXPECT_FALSE(is_field_name(bad)) << bad;
}

TEST(HttpFields, WriteDatesInTheLanguageOfHttp) {
  const auto at = [](std::time_t seconds) { return http_date(std::chrono::system_clock::from_time_t(seconds)); };
  EXPECT_EQ(at(0), "Thu, 01 Jan 1970 00:00:00 GMT");
  EXPECT_EQ(at(1796032800), "Mon, 30 Nov 2026 10:00:00 GMT");
}

class NoResource final : public HttpResource {
 public:
  ResourceAnswer get(const ResourceRequest& /*request*/) override { return {}; }
};

TEST(HttpRoutes, TakeTheLongestPathThatFits) {
  NoResource resource;
  const std::vector<MountedResource> mounted{{"/", &resource},
                                             {"/api/v1/events", &resource},
                                             {"/api/v1/jobs/", &resource},
                                             {"/api/v1/jobs/special", &resource},
                                             {"/nowhere", nullptr}};
  const auto place = [&](std::string_view path) {
    const MountedResource* found = resource_for(mounted, path);
    return found == nullptr ? "" : found->path;
  };
  EXPECT_EQ(place("/"), "/");
  EXPECT_EQ(place("/api/v1/events"), "/api/v1/events");
  EXPECT_EQ(place("/api/v1/events/x"), "/api/v1/events");
  EXPECT_EQ(place("/api/v1/events2"), "/");
  EXPECT_EQ(place("/api/v1/jobs/7/height"), "/api/v1/jobs/");
  EXPECT_EQ(place("/api/v1/jobs"), "/") << "below it, not it";
  EXPECT_EQ(place("/api/v1/jobs/special/a"), "/api/v1/jobs/special");
  EXPECT_EQ(place("/nowhere"), "/");
  EXPECT_EQ(resource_for({{"/a", &resource}}, "/b"), nullptr);
  EXPECT_EQ(resource_for({}, "/"), nullptr);
}

}  // namespace
}  // namespace fvd
