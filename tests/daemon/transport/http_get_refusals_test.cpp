/// GET as strangers and foreign pages send it, and answers that must not be sent.

#include <algorithm>
#include <cctype>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "core/base/error.hpp"
#include "daemon/transport/http_fields.hpp"
#include "tests/daemon/transport/resource_server.hpp"
#include "tests/support/captured_log.hpp"
#include "tests/support/rpc_text.hpp"

namespace fvd {
namespace {

using test::FakeResource;
using test::text_answer;
using ::testing::HasSubstr;

class AServerThatIsCareful : public test::ResourceServer {};

TEST_F(AServerThatIsCareful, GivesEveryAnswerTheFieldsOfSafety) {
  serve([](const ResourceRequest& request) {
    ResourceAnswer answer = text_answer("x");
    if (request.path == "/bad") answer.fields.emplace_back("Content-Security-Policy", "default-src *");
    if (request.path == "/kept") answer.fields.emplace_back("Cache-Control", "no-cache");
    return answer;
  });
  HttpClient one(server_->port());
  std::vector<HttpReply> replies{get("/"), get("/bad"), get("/.."), get("/", "Origin: http://evil.example\r\n")};
  replies.push_back(one.call(test::call("system.ping")).value_or(HttpReply{}));
  const std::vector<int> statuses{200, 200, 400, 403, 200};
  for (std::size_t i = 0; i < replies.size(); ++i) {
    EXPECT_EQ(replies[i].status, statuses[i]);
    for (const auto& [name, value] : kSecurityFields) {
      std::string lower(name);
      std::transform(lower.begin(), lower.end(), lower.begin(), [](unsigned char c) { return std::tolower(c); });
      EXPECT_EQ(replies[i].fields[lower], value) << i;
    }
    EXPECT_EQ(replies[i].fields["cache-control"], "no-store") << i;
    EXPECT_EQ(replies[i].fields.count("access-control-allow-origin"), 0U);
    EXPECT_THAT(replies[i].fields["date"], HasSubstr(" GMT"));
  }
  EXPECT_EQ(get("/kept").fields["cache-control"], "no-cache");
}

TEST_F(AServerThatIsCareful, SendsNoFieldThatBeginsAnother) {
  serve([](const ResourceRequest& request) {
    ResourceAnswer answer = text_answer("x");
    answer.fields.emplace_back("Content-Disposition", "attachment; filename=\"" + request.query.at("name") + "\"");
    if (request.path == "/crlf") answer.fields.back().second += "\r\nSet-Cookie: a=b";
    if (request.path == "/status") answer.status = 99;
    return answer;
  });
  EXPECT_EQ(get("/?name=a%20b").fields["content-disposition"], "attachment; filename=\"a b\"");
  for (const char* bad : {"/crlf?name=a", "/status?name=a", "/?name=%C3%BC"}) {
    const HttpReply reply = get(bad);
    EXPECT_EQ(reply.status, 500) << bad;
    EXPECT_EQ(reply.fields.count("set-cookie"), 0U);
    EXPECT_EQ(reply.fields.count("content-disposition"), 0U);
  }
}

TEST_F(AServerThatIsCareful, RefusesTargetsThatAreNone) {
  FakeResource& resource = serve([](const ResourceRequest&) { return text_answer("x"); });
  for (const char* target : {"/../etc/passwd", "/%2e%2e/etc/passwd", "/a%00", "/%zz", "/?a=1&a=2", "*",
                             "http://127.0.0.1/", "//evil.example/", "/a%2fb", "/%0d%0aSet-Cookie:x"}) {
    const HttpReply reply = get(target);
    EXPECT_EQ(reply.status, 400) << target;
    EXPECT_TRUE(nlohmann::json::accept(reply.body)) << target;
    EXPECT_EQ(reply.fields.count("set-cookie"), 0U);
  }
  EXPECT_EQ(get("/" + std::string(3000, 'a')).status, 414);
  EXPECT_EQ(resource.asked, 0);
}

TEST_F(AServerThatIsCareful, RefusesWhatAForeignPageAsksFor) {
  FakeResource& resource = serve([](const ResourceRequest&) { return text_answer("x"); });
  const std::string host = "GET / HTTP/1.1\r\nHost: 127.0.0.1:" + std::to_string(server_->port()) + "\r\n";
  EXPECT_EQ(status_of(host + "\r\n"), 200) << "no browser at all";
  EXPECT_EQ(status_of(host + "Sec-Fetch-Site: none\r\n\r\n"), 200) << "typed by hand";
  EXPECT_EQ(status_of(host + "Sec-Fetch-Site: same-origin\r\nOrigin: http://127.0.0.1:" +
                      std::to_string(server_->port()) + "\r\n\r\n"),
            200);
  const int asked = resource.asked;
  EXPECT_EQ(status_of(host + "Sec-Fetch-Site: cross-site\r\n\r\n"), 403);
  EXPECT_EQ(status_of(host + "Sec-Fetch-Site: same-site\r\n\r\n"), 403);
  EXPECT_EQ(status_of(host + "Origin: http://evil.example\r\n\r\n"), 403);
  EXPECT_EQ(status_of(host + "Origin: null\r\n\r\n"), 403);
  EXPECT_EQ(status_of("GET / HTTP/1.1\r\nHost: evil.example\r\n\r\n"), 403) << "a name that stands for 127.0.0.1";
  EXPECT_EQ(status_of("GET / HTTP/1.1\r\n\r\n"), 400);
  EXPECT_EQ(status_of("GET http://evil.example/ HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n"), 400);
  EXPECT_EQ(resource.asked, asked);
}

TEST_F(AServerThatIsCareful, HasNothingElseThanItsMethods) {
  FakeResource& resource = serve([](const ResourceRequest&) { return text_answer("x"); });
  HttpClient one(server_->port());
  const std::string rest = " HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\n\r\n";
  for (const char* method : {"POST", "PUT", "DELETE", "OPTIONS", "PATCH", "BREW", "TRACE", "CONNECT"}) {
    HttpClient other(server_->port());
    const auto reply = other.ask(std::string(method) + " /jobs" + rest);
    ASSERT_TRUE(reply) << method;
    EXPECT_EQ(reply->status, 405) << method;
    EXPECT_EQ(reply->fields.at("allow"), "GET, HEAD");
  }
  const auto call = one.get("/api/jsonrpc");
  ASSERT_TRUE(call);
  EXPECT_EQ(call->status, 405);
  EXPECT_EQ(call->fields.at("allow"), "POST");
  EXPECT_EQ(resource.asked, 0);
}

TEST_F(AServerThatIsCareful, TakesNoBodyWithAGet) {
  serve([](const ResourceRequest&) { return text_answer("x"); });
  const std::string hidden = "GET /hidden HTTP/1.1\r\nHost: localhost\r\n\r\n";
  for (const std::string& length :
       {"Content-Length: " + std::to_string(hidden.size()) + "\r\n", std::string("Transfer-Encoding: chunked\r\n")}) {
    HttpClient one(server_->port());
    const auto reply = one.ask("GET / HTTP/1.1\r\nHost: localhost\r\n" + length + "\r\n" + hidden);
    ASSERT_TRUE(reply);
    EXPECT_EQ(reply->status, 400);
    EXPECT_FALSE(one.reply()) << "what was hidden in the body is no request";
  }
  EXPECT_EQ(status_of("GET / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 0\r\n\r\n"), 200);
}

TEST_F(AServerThatIsCareful, TakesNoBodyWhoseEndIsUnknown) {
  FakeResource& resource = serve([](const ResourceRequest&) { return text_answer("x"); });
  const std::string hidden = "GET /hidden HTTP/1.1\r\nHost: localhost\r\n\r\n";
  const std::string length = "Content-Length: " + std::to_string(hidden.size()) + "\r\n";
  const std::string call = "POST /api/jsonrpc HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\n";
  for (const std::string& coding : {std::string("gzip"), std::string("chunked, identity"), std::string("")}) {
    for (const std::string& begin : {std::string("GET / HTTP/1.1\r\nHost: localhost\r\n"), call}) {
      const std::string field = "Transfer-Encoding: " + coding + "\r\n";
      for (const std::string& fields : {field, field + length, length + field}) {
        HttpClient one(server_->port());
        const auto reply = one.ask(begin + fields + "\r\n" + hidden);
        ASSERT_TRUE(reply) << fields;
        EXPECT_EQ(reply->status, 400) << fields;
        EXPECT_FALSE(one.reply()) << "what was hidden in the body is no request: " << fields;
      }
    }
  }
  EXPECT_EQ(resource.asked, 0);
  const std::string ping = test::call("system.ping");
  std::ostringstream chunk;
  chunk << std::hex << ping.size() << "\r\n" << ping << "\r\n0\r\n\r\n";
  EXPECT_EQ(status_of(call + "Transfer-Encoding: chunked\r\n\r\n" + chunk.str()), 200);
}

TEST_F(AServerThatIsCareful, TellsTheLogOfFailuresAsOneAlarm) {
  const test::CapturedLog log;
  serve([](const ResourceRequest&) -> ResourceAnswer { throw Error(ErrorCode::kDatabase, "the database is gone"); });
  for (int i = 0; i < 50; ++i) EXPECT_EQ(get("/" + std::to_string(i)).status, 500);
  server_.reset();
  EXPECT_GE(log.lines_with("the database is gone"), 1U);
  EXPECT_EQ(log.lines_with("[error] what is asked for by GET cannot be answered: the database is gone"),
            log.lines_with("[error]"));
  EXPECT_EQ(log.lines_with("that was GET /0; 1 could"), 1U);
  EXPECT_EQ(log.lines_with("[info] that was GET /"), log.lines_with("[error]"));
}

TEST_F(AServerThatIsCareful, LooksAtWhoAsks) {
  service_.access_config.loopback_role = Role::kNone;
  FakeResource open([](const ResourceRequest&) { return text_answer("page"); }, false);
  FakeResource closed([](const ResourceRequest&) { return text_answer("map"); });
  serve({{"/", &open}, {"/api/v1/jobs/", &closed}});
  EXPECT_EQ(get("/").body, "page") << "he gives his token there";
  const HttpReply refused = get("/api/v1/jobs/1/height");
  EXPECT_EQ(refused.status, 403);
  EXPECT_EQ(nlohmann::json::parse(refused.body)["error"], "not_allowed");
  EXPECT_EQ(closed.asked, 0);
  EXPECT_EQ(get("/api/v1/jobs/1/height", bearer()).body, "map");
  EXPECT_EQ(get("/api/v1/jobs/1/height", "Authorization: Bearer wrong\r\n").status, 401);
  server_.reset();
}

TEST_F(AServerThatIsCareful, LooksByAddressWithoutAToken) {
  service_.access_config.loopback_role = Role::kView;
  serve([](const ResourceRequest&) { return text_answer("map"); });
  EXPECT_EQ(get("/api/v1/jobs/1/height").body, "map");
}

}  // namespace
}  // namespace fvd
