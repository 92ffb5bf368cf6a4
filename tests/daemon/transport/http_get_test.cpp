/// GET and HEAD of resources: what is asked for and how it is answered.

#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "core/base/error.hpp"
#include "tests/daemon/transport/resource_server.hpp"
#include "tests/support/rpc_text.hpp"

namespace fvd {
namespace {

using test::FakeBody;
using test::FakeResource;
using test::text_answer;

class AServerOfResources : public test::ResourceServer {};

TEST_F(AServerOfResources, AsksTheResourceThatHasTheLongestPath) {
  FakeResource page([](const ResourceRequest& request) { return text_answer("page " + request.path); });
  FakeResource jobs([](const ResourceRequest& request) { return text_answer("jobs " + request.path); });
  serve({{"/", &page}, {"/api/v1/jobs/", &jobs}});
  EXPECT_EQ(get("/").body, "page /");
  EXPECT_EQ(get("/jobs/7").body, "page /jobs/7");
  EXPECT_EQ(get("/api/v1/jobs/7/height").body, "jobs /api/v1/jobs/7/height");
  server_.reset();
}

TEST_F(AServerOfResources, TellsTheResourceWhatIsAskedFor) {
  ResourceRequest seen;
  serve([&seen](const ResourceRequest& request) {
    seen = request;
    return text_answer("x");
  });
  get("/a%20b?text=c+d&max=512",
      "Accept-Encoding: br, gzip\r\nRange: bytes=0-9\r\nIf-Range: \"t\"\r\nIf-None-Match: \"u\"\r\nLast-Event-ID: "
      "17-5\r\n");
  EXPECT_EQ(seen.path, "/a b");
  EXPECT_EQ(seen.query, (std::map<std::string, std::string>{{"text", "c d"}, {"max", "512"}}));
  EXPECT_TRUE(seen.takes_gzip);
  EXPECT_EQ(seen.range, "bytes=0-9");
  EXPECT_EQ(seen.if_range, "\"t\"");
  EXPECT_EQ(seen.if_none_match, "\"u\"");
  EXPECT_EQ(seen.last_event_id, "17-5");
  EXPECT_EQ(seen.address, "127.0.0.1");
  EXPECT_EQ(seen.waited.count(), 0);
  EXPECT_FALSE(seen.is_head);
  get("/", "Range: bytes=0-9\r\nRange: bytes=5-6\r\n");
  EXPECT_FALSE(seen.range) << "two are none";
  EXPECT_FALSE(seen.takes_gzip);
}

TEST_F(AServerOfResources, KeepsTheConnection) {
  serve([](const ResourceRequest& request) { return text_answer(request.path); });
  HttpClient one(server_->port());
  EXPECT_EQ(one.get("/a").value_or(HttpReply{}).body, "/a");
  EXPECT_EQ(one.call(test::call("system.ping")).value_or(HttpReply{}).status, 200);
  one.send(one.get_request("/b") + one.get_request("/c") + one.get_request("/d", "", "HEAD"));
  EXPECT_EQ(one.reply().value_or(HttpReply{}).body, "/b");
  EXPECT_EQ(one.reply().value_or(HttpReply{}).body, "/c");
  EXPECT_EQ(one.head_reply().value_or(HttpReply{}).fields["content-length"], "2");
  EXPECT_EQ(one.get("/e", "Connection: close\r\n").value_or(HttpReply{}).body, "/e");
  EXPECT_TRUE(one.closes());
}

TEST_F(AServerOfResources, AnswersHeadWithoutABody) {
  serve([this](const ResourceRequest& request) {
    ResourceAnswer answer = text_answer("12345");
    if (request.path == "/long") {
      answer.source = std::make_unique<FakeBody>(bodies_, 10, 10);
      answer.source_bytes = 100;
    }
    if (request.path == "/gone") throw Error(ErrorCode::kUnknownJob, "there is no such job");
    EXPECT_TRUE(request.is_head);
    return answer;
  });
  HttpClient one(server_->port());
  const auto small = one.head("/small");
  ASSERT_TRUE(small);
  EXPECT_EQ(small->fields.at("content-length"), "5");
  EXPECT_EQ(one.head("/long").value_or(HttpReply{}).fields["content-length"], "100");
  EXPECT_EQ(bodies_.made, 0);
  EXPECT_EQ(one.head("/gone").value_or(HttpReply{}).status, 404);
  EXPECT_EQ(one.head("/..").value_or(HttpReply{}).status, 400) << "on the same connection: nothing lay between";
  EXPECT_FALSE(one.line().has_value()) << "and nothing behind";
}

TEST_F(AServerOfResources, TellsWhoHasItAlready) {
  serve([](const ResourceRequest& request) {
    ResourceAnswer answer = text_answer("12345", "\"t1\"");
    answer.fields.emplace_back("Cache-Control", "no-cache");
    answer.fields.emplace_back("Content-Encoding", "gzip");
    if (request.path == "/gone") answer.status = 404;
    return answer;
  });
  HttpClient one(server_->port());
  const auto known = one.get("/", "If-None-Match: \"t0\", \"t1\"\r\n");
  ASSERT_TRUE(known);
  EXPECT_EQ(known->status, 304);
  EXPECT_EQ(known->body, "");
  EXPECT_EQ(known->fields.count("content-length"), 0U);
  EXPECT_EQ(known->fields.count("content-encoding"), 0U);
  EXPECT_EQ(known->fields.at("etag"), "\"t1\"");
  EXPECT_EQ(known->fields.at("cache-control"), "no-cache");
  EXPECT_EQ(one.get("/", "If-None-Match: \"t2\"\r\n").value_or(HttpReply{}).body, "12345");
  EXPECT_EQ(one.head("/", "If-None-Match: *\r\n").value_or(HttpReply{}).status, 304);
  EXPECT_EQ(one.get("/gone", "If-None-Match: \"t1\"\r\n").value_or(HttpReply{}).status, 404);
}

TEST_F(AServerOfResources, TellsErrorsByStatus) {
  std::optional<Error> error;
  serve([&error](const ResourceRequest&) -> ResourceAnswer {
    if (error) throw Error(*error);
    throw std::runtime_error("a bug");
  });
  const std::vector<std::pair<ErrorCode, int>> expected{
      {ErrorCode::kUnknownJob, 404},    {ErrorCode::kResultRemoved, 410}, {ErrorCode::kBadConfig, 400},
      {ErrorCode::kRegionOutside, 400}, {ErrorCode::kShuttingDown, 503},  {ErrorCode::kNotReady, 503},
      {ErrorCode::kDatabase, 500},      {ErrorCode::kBadInput, 500},      {ErrorCode::kInternal, 500}};
  HttpClient one(server_->port());
  for (const auto& [code, status] : expected) {
    error.emplace(code, "what, where, what to do");
    const auto reply = one.get("/");
    ASSERT_TRUE(reply) << error_name(code) << ": the connection is kept";
    EXPECT_EQ(reply->status, status) << error_name(code);
    const auto body = nlohmann::json::parse(reply->body);
    EXPECT_EQ(body["error"], error_name(code));
    EXPECT_EQ(body["message"], "what, where, what to do");
    EXPECT_EQ(reply->fields.at("content-type"), "application/json");
  }
  error.reset();
  EXPECT_EQ(one.get("/").value_or(HttpReply{}).status, 500);
}

}  // namespace
}  // namespace fvd
