/// What a browser may bring from elsewhere, and what it may not.

#include "daemon/transport/http_gate.hpp"

#include <gtest/gtest.h>

namespace fvd {
namespace {

constexpr int kGood = 0;

class AnHttpGate : public ::testing::Test {
 protected:
  int status(const HttpHead& head, std::string_view own_address = "127.0.0.1") const {
    const auto refusal = gate_.refusal_of(head, own_address);
    return refusal ? refusal->status : kGood;
  }
  static HttpHead head(const std::string& host) {
    HttpHead head;
    head.host = host;
    return head;
  }
  int of_host(const std::string& host, std::string_view own_address = "127.0.0.1") const {
    return status(head(host), own_address);
  }
  int of_origin(const std::string& origin, const std::string& host = "localhost:7413") const {
    HttpHead page = head(host);
    page.origin = origin;
    return status(page);
  }
  int of_site(const std::string& site) const {
    HttpHead page = head("localhost");
    page.fetch_site = site;
    return status(page);
  }
  HttpGate gate_{{"Fvd.Line3.example"}};
};

TEST_F(AnHttpGate, KnowsItsNames) {
  for (const char* host : {"127.0.0.1:7413", "127.0.0.1", "localhost:1", "LocalHost", "[::1]:7413", "[::1]",
                           "fvd.line3.example", "FVD.line3.example:443"}) {
    EXPECT_EQ(of_host(host), kGood) << host;
  }
  EXPECT_EQ(of_host("192.168.1.5:7413", "192.168.1.5"), kGood);
  EXPECT_EQ(of_host("192.168.1.5:7413", "::ffff:192.168.1.5"), kGood);
  EXPECT_EQ(of_host("[fe80::1]:7413", "fe80::1%eth0"), kGood);
}

TEST_F(AnHttpGate, RefusesNamesThatAnybodyMayHaveGivenIt) {
  for (const char* host : {"evil.example", "evil.example:7413", "localhost.evil.example", "127.0.0.1.evil.example",
                           "192.168.1.5", "", ":7413", "localhost:", "localhost:x", "localhost:1:2", "[::1", "[::1]x",
                           "[::2]", "user@localhost", "localhost/", "localhost,evil.example", "0.0.0.0"}) {
    EXPECT_EQ(of_host(host), 403) << host;
  }
  EXPECT_EQ(status({}), 400) << "no Host at all";
  HttpHead twice = head("localhost");
  twice.has_twice = true;
  EXPECT_EQ(status(twice), 400);
}

TEST_F(AnHttpGate, RefusesPagesFromElsewhere) {
  EXPECT_EQ(of_origin("http://localhost:7413"), kGood);
  EXPECT_EQ(of_origin("https://fvd.line3.example", "fvd.line3.example"), kGood) << "behind a proxy with TLS";
  for (const char* origin : {"http://localhost", "http://localhost:7414", "http://127.0.0.1:7413", "null", "",
                             "http://evil.example", "http://localhost:7413.evil.example", "file://", "localhost:7413",
                             "ws://localhost:7413", "http://localhost:7413/"}) {
    EXPECT_EQ(of_origin(origin), 403) << origin;
  }
  for (const char* site : {"cross-site", "same-site", "", "Same-Origin"}) {
    EXPECT_EQ(of_site(site), 403) << site;
  }
  EXPECT_EQ(of_site("same-origin"), kGood);
  EXPECT_EQ(of_site("none"), kGood);
}

TEST_F(AnHttpGate, TellsWhatToDoInOneLine) {
  const auto refusal = gate_.refusal_of(head("evil.example"), "127.0.0.1");
  ASSERT_TRUE(refusal);
  EXPECT_EQ(refusal->body().find('\n'), refusal->body().size() - 1);
  EXPECT_NE(refusal->body().find("http.hosts"), std::string::npos);
}

TEST(JsonType, IsWhatAFormCannotSend) {
  for (const char* type : {"application/json", "Application/JSON", " application/json ; charset=utf-8"}) {
    EXPECT_TRUE(is_json_type(type)) << type;
  }
  for (const char* type : {"", "text/plain", "application/x-www-form-urlencoded", "multipart/form-data",
                           "text/plain; application/json", "application/jsonx", "application/json, text/plain"}) {
    EXPECT_FALSE(is_json_type(type)) << type;
  }
}

TEST(Bearer, IsATokenOfItsScheme) {
  EXPECT_EQ(bearer_of("Bearer fvd-1"), "fvd-1");
  EXPECT_EQ(bearer_of("bearer  fvd-1 "), "fvd-1");
  for (const std::string& text : {std::string(), std::string("Bearer"), std::string("Bearer "), std::string("fvd-1"),
                                  std::string("Basic dXNlcjpw"), "Bearer " + std::string(257, 'x')}) {
    EXPECT_FALSE(bearer_of(text)) << text;
  }
}

}  // namespace
}  // namespace fvd
