/// Paths and queries as browsers and as strangers write them.

#include "daemon/transport/http_target.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace fvd {
namespace {

using Query = std::map<std::string, std::string>;

HttpTarget good(std::string_view text) {
  const auto read = read_target(text);
  if (const auto* refusal = std::get_if<HttpRefusal>(&read)) {
    ADD_FAILURE() << text << ": " << refusal->message;
    return {};
  }
  return std::get<HttpTarget>(read);
}

/// The status of the refusal; 0 for none.
int refusal_of(std::string_view text) {
  const auto read = read_target(text);
  const auto* refusal = std::get_if<HttpRefusal>(&read);
  if (refusal == nullptr) return 0;
  EXPECT_TRUE(nlohmann::json::accept(refusal->body())) << refusal->body();
  return refusal->status;
}

TEST(HttpTarget, ReadsPaths) {
  for (const char* plain : {"/", "/jobs", "/jobs/", "/api/v1/jobs/20261130-1/files/height.tiff", "/a.b", "/...", "/.a",
                            "/a~b-c_d!$&'()*+,;=:@"}) {
    EXPECT_EQ(good(plain).path, plain);
    EXPECT_TRUE(good(plain).query.empty());
  }
  EXPECT_EQ(good("/a%20b%2Bc").path, "/a b+c");
  EXPECT_EQ(good("/%c3%BC").path, "/\xc3\xbc") << "UTF-8";
  EXPECT_EQ(good("/a+b").path, "/a+b") << "a blank in the query alone";
  EXPECT_EQ(good("/%61pi").path, "/api");
}

TEST(HttpTarget, ReadsQueries) {
  EXPECT_EQ(good("/h?x=1&y=-2.5").query, (Query{{"x", "1"}, {"y", "-2.5"}}));
  EXPECT_EQ(good("/h?text=a+b%2B%26%3Dc&after").query, (Query{{"text", "a b+&=c"}, {"after", ""}}));
  EXPECT_EQ(good("/h?a==b").query, (Query{{"a", "=b"}}));
  EXPECT_EQ(good("/h?a=b?c/d").query, (Query{{"a", "b?c/d"}}));
  EXPECT_TRUE(good("/h?").query.empty());
  EXPECT_EQ(good("/h?x=..%2f..").query, (Query{{"x", "../.."}})) << "a value is no path";
}

TEST(HttpTarget, DecodesOnce) {
  EXPECT_EQ(good("/%252e%252e").path, "/%2e%2e");
  EXPECT_EQ(good("/h?a=%2541").query, (Query{{"a", "%41"}}));
}

TEST(HttpTarget, RefusesWaysOutOfAFolder) {
  for (const char* up :
       {"/..", "/../", "/a/../b", "/a/..", "/.", "/./a", "/%2e%2e/a", "/%2E./a", "/.%2e", "/a/%2e%2e", "/a%2f..%2fb",
        "/a%2fb", "/..%2fb", "/a%5cb", "/..\\a", "/..%5ca", "//", "//evil.example/a", "/a//b"}) {
    EXPECT_EQ(refusal_of(up), 400) << up;
  }
}

TEST(HttpTarget, RefusesEscapesThatAreNone) {
  for (const char* bad : {"/%", "/%4", "/%zz", "/%4g", "/%g4", "/a%", "/h?a=%", "/h?%=a", "/h?a=%u0041", "/%-1"}) {
    EXPECT_EQ(refusal_of(bad), 400) << bad;
  }
}

TEST(HttpTarget, RefusesWhatIsNoText) {
  for (const char* bad : {"/%00", "/a%00.tiff", "/h?a=%00", "/%0d%0aSet-Cookie:x", "/h?a=%0A", "/%1b[31m", "/%7f",
                          "/%ff", "/%c0%ae%c0%ae/", "/%ed%a0%80", "/%c3", "/h?a=%80"}) {
    EXPECT_EQ(refusal_of(bad), 400) << bad;
  }
  EXPECT_EQ(refusal_of(std::string_view("/a\0b", 4)), 400);
  for (const char* bad : {"/a b", "/a\tb", "/\xc3\xbc", "/a\"b", "/<script>", "/a#b", "/h?a=\x01"}) {
    EXPECT_EQ(refusal_of(bad), 400) << bad;
  }
}

TEST(HttpTarget, RefusesOtherForms) {
  for (const char* bad : {"", "*", "jobs", "http://localhost/jobs", "localhost:80", "?a=b"}) {
    EXPECT_EQ(refusal_of(bad), 400) << bad;
  }
}

TEST(HttpTarget, RefusesKeysThatSayNothingOrTwice) {
  for (const char* bad :
       {"/h?a=1&a=2", "/h?a&a", "/h?a=1&%61=2", "/h?=1", "/h?a=1&=2", "/h?a=1&", "/h?&a=1", "/h?a=1&&b=2"}) {
    EXPECT_EQ(refusal_of(bad), 400) << bad;
  }
}

TEST(HttpTarget, HasLimits) {
  const std::string longest = "/" + std::string(kLongestTarget_bytes - 1, 'a');
  EXPECT_EQ(refusal_of(longest), 0);
  EXPECT_EQ(refusal_of(longest + "a"), 414);
  std::string query = "/h?k0";
  for (std::size_t i = 1; i < kMostQueryKeys; ++i) query += "&k" + std::to_string(i);
  EXPECT_EQ(good(query).query.size(), kMostQueryKeys);
  EXPECT_EQ(refusal_of(query + "&more"), 400);
}

}  // namespace
}  // namespace fvd
