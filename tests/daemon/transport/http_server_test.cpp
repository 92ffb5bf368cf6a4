/// JSON-RPC over HTTP: what is answered, what is refused, and that nobody holds another back.

#include "daemon/transport/http_server.hpp"

#include <algorithm>
#include <chrono>
#include <future>
#include <memory>
#include <vector>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "core/base/error.hpp"
#include "daemon/access/token_file.hpp"
#include "daemon/transport/wrong_tokens.hpp"
#include "tests/daemon/api/fake_job_service.hpp"
#include "tests/support/captured_log.hpp"
#include "tests/support/expect_error.hpp"
#include "tests/support/http_client.hpp"
#include "tests/support/rpc_text.hpp"
#include "tests/support/scratch_dir.hpp"

namespace fvd {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

using test::call;

HttpConfig on_port(int port) {
  HttpConfig config;
  config.port = port;
  config.hosts = {{"fvd.example"}};
  return config;
}

class AnHttpServer : public ::testing::Test {
 protected:
  AnHttpServer() {
    service_.access_config.token_file = folder_ / "tokens";
    test::write_text(folder_ / "tokens", credential_of("kiosk", Role::kOperate, token_).line() + "\n");
    server_ = std::make_unique<HttpServer>(on_port(0), service_.services());
  }
  [[nodiscard]] std::string bearer() const { return "Authorization: Bearer " + token_ + "\r\n"; }
  json ask(const std::string& body, const std::string& more = "") {
    HttpClient client(server_->port());
    const auto reply = client.call(body, more);
    if (!reply || reply->status != 200) return reply ? reply->status : 0;
    return json::parse(reply->body);
  }
  /// The status of a whole request.
  int status_of(const std::string& bytes) {
    HttpClient client(server_->port());
    const auto reply = client.ask(bytes);
    if (!reply) return 0;
    if (reply->status >= 400) {
      EXPECT_EQ(reply->body.find('\n'), reply->body.size() - 1) << reply->body;
      EXPECT_TRUE(json::parse(reply->body).contains("message"));
      EXPECT_TRUE(client.closes());
    }
    return reply->status;
  }
  int status_with(const std::string& more) {
    return status_of("POST /api/jsonrpc HTTP/1.1\r\n" + more + "Content-Length: 2\r\n\r\n{}");
  }

  test::ScratchDir folder_;
  const std::string token_ = new_token();
  FakeJobService service_;
  std::unique_ptr<HttpServer> server_;
};

TEST_F(AnHttpServer, AnswersCallsOnOneConnection) {
  HttpClient client(server_->port());
  for (int i = 0; i < 3; ++i) {
    const auto reply = client.call(call("system.state"));
    ASSERT_TRUE(reply);
    EXPECT_EQ(reply->status, 200);
    EXPECT_EQ(json::parse(reply->body)["result"]["state"], "ready");
    EXPECT_EQ(reply->fields.at("content-type"), "application/json");
    EXPECT_EQ(reply->fields.at("x-content-type-options"), "nosniff");
    EXPECT_EQ(reply->fields.at("referrer-policy"), "no-referrer");
    EXPECT_EQ(reply->fields.at("cache-control"), "no-store");
    EXPECT_EQ(reply->fields.count("access-control-allow-origin"), 0U);
  }
  const auto last = client.call(call("system.ping"), "Connection: close\r\n");
  ASSERT_TRUE(last);
  EXPECT_TRUE(client.closes());
}

TEST_F(AnHttpServer, GivesEveryAnswerOfJsonRpcAsOne) {
  EXPECT_EQ(ask("no json")["error"]["code"], -32700);
  EXPECT_EQ(ask("{}")["error"]["code"], -32600);
  EXPECT_EQ(ask(call("no.such"))["error"]["code"], -32601);
  EXPECT_EQ(ask("[" + call("system.ping") + "," + call("system.state") + "]").size(), 2U);
  EXPECT_EQ(ask(call("job.status", {{"job_id", "none"}}))["error"]["code"], 1007);
  HttpClient client(server_->port());
  const auto nothing = client.call(R"({"jsonrpc":"2.0","method":"system.ping"})");
  ASSERT_TRUE(nothing);
  EXPECT_EQ(nothing->status, 204);
  EXPECT_EQ(nothing->fields.count("content-length"), 0U);
  EXPECT_EQ(client.call(call("system.ping")).value_or(HttpReply{}).status, 200) << "the connection is kept";
}

TEST_F(AnHttpServer, KnowsWhoBringsAToken) {
  EXPECT_EQ(ask(call("session.info"))["result"], (json{{"who", "address 127.0.0.1"}, {"role", "view"}}))
      << "whatever loopback may do by the line protocol";
  const json start = {{"seq", 1}, {"part_id", "p"}};
  EXPECT_EQ(ask(call("job.start", start))["error"]["code"], 1004);
  EXPECT_EQ(service_.starts, 0);
  EXPECT_EQ(ask(call("session.info"), bearer())["result"]["who"], "token kiosk");
  EXPECT_TRUE(ask(call("job.start", start), bearer()).contains("result"));
  EXPECT_EQ(service_.starts, 1);
  const auto entries = service_.audit.newest(10, 0);
  ASSERT_FALSE(entries.empty());
  EXPECT_EQ(entries.front().who, "token kiosk");
  EXPECT_THAT(entries.front().peer, HasSubstr("http 127.0.0.1:"));
  EXPECT_EQ(ask(call("stage.move", {{"z_um", 1}}), bearer())["error"]["code"], 1004) << "not with this role";
}

TEST_F(AnHttpServer, KeepsNobodyLoggedIn) {
  HttpClient client(server_->port());
  ASSERT_TRUE(client.call(call("session.info"), bearer()));
  const auto next = client.call(call("session.info"));
  ASSERT_TRUE(next);
  EXPECT_EQ(json::parse(next->body)["result"]["role"], "view");
  EXPECT_EQ(ask(call("session.login", {{"token", token_}}))["error"]["code"], -32600);
}

TEST_F(AnHttpServer, RefusesWrongTokensEverMoreSlowly) {
  HttpClient guessing(server_->port());
  const std::string basic = guessing.request("{}", "Authorization: Basic dXNlcjpw\r\n");
  const std::string wrong = guessing.request(call("system.ping"), "Authorization: Bearer wrong\r\n");
  auto least = WrongTokens::kFirstDelay;
  for (const std::string& guess : {wrong, basic, wrong}) {
    HttpClient client(server_->port());
    const auto begin = std::chrono::steady_clock::now();
    const auto refused = client.ask(guess);
    EXPECT_GE(std::chrono::steady_clock::now() - begin, least);
    ASSERT_TRUE(refused);
    EXPECT_EQ(refused->status, 401);
    EXPECT_EQ(refused->fields.at("www-authenticate"), "Bearer");
    least *= 2;
  }
}

TEST_F(AnHttpServer, RecognisesRightTokensWhileWrongOnesWait) {
  std::vector<std::unique_ptr<HttpClient>> guessing;
  for (int i = 0; i < 8; ++i) {
    guessing.push_back(std::make_unique<HttpClient>(server_->port()));
    guessing.back()->send(guessing.back()->request(call("system.ping"), "Authorization: Bearer wrong\r\n"));
  }
  ASSERT_TRUE(guessing.front()->reply()) << "by now each of them was looked up";
  EXPECT_EQ(ask(call("session.info"), bearer())["result"]["role"], "operate");
  EXPECT_FALSE(guessing.back()->reply(std::chrono::milliseconds(50))) << "it did not wait for the last of them";
}

TEST_F(AnHttpServer, SaysThatItsTokensCannotBeRead) {
  std::filesystem::remove(folder_ / "tokens");
  const test::CapturedLog log;
  const auto begin = std::chrono::steady_clock::now();
  for (int i = 0; i < 20; ++i) EXPECT_EQ(ask(call("session.info"), bearer()), 503);
  EXPECT_EQ(ask(call("session.info"))["result"]["role"], "view");
  HttpClient stranger(server_->port());
  const std::string told = stranger.call(call("session.info"), bearer()).value_or(HttpReply{}).body;
  EXPECT_THAT(told, HasSubstr("the log"));
  EXPECT_THAT(told, testing::Not(HasSubstr(folder_.path().string()))) << "no stranger's business";
  server_.reset();
  EXPECT_GE(log.lines_with((folder_ / "tokens").string()), 1U) << "the log says why";
  const auto seconds = (std::chrono::steady_clock::now() - begin) / std::chrono::seconds(1);
  EXPECT_GE(log.lines_with("nobody can be recognised"), 1U);
  EXPECT_LE(log.lines_with("nobody can be recognised"), 1 + static_cast<std::size_t>(seconds));
}

TEST_F(AnHttpServer, RefusesWhatAForeignPageSends) {
  const std::string host = "Host: 127.0.0.1:" + std::to_string(server_->port()) + "\r\n";
  const std::string json_type = "Content-Type: application/json\r\n";
  EXPECT_EQ(status_with(host + json_type), 200);
  EXPECT_EQ(status_with("Host: fvd.example\r\nOrigin: https://fvd.example\r\n" + json_type), 200);
  EXPECT_EQ(status_with("Host: evil.example\r\n" + json_type), 403);
  EXPECT_EQ(status_with(json_type), 400) << "no Host";
  EXPECT_EQ(status_with(host + host + json_type), 400) << "two of them";
  EXPECT_EQ(status_with(host + "Origin: http://evil.example\r\n" + json_type), 403);
  EXPECT_EQ(status_with(host + "Origin: null\r\n" + json_type), 403);
  EXPECT_EQ(status_with(host + "Sec-Fetch-Site: cross-site\r\n" + json_type), 403);
  EXPECT_EQ(status_with(host + "Content-Type: text/plain\r\n"), 415);
  EXPECT_EQ(status_with(host), 415);
}

TEST_F(AnHttpServer, RefusesWhatItDoesNotHave) {
  const std::string host = " HTTP/1.1\r\nHost: localhost\r\n\r\n";
  EXPECT_EQ(status_of("GET /" + host), 404);
  EXPECT_EQ(status_of("POST /" + host), 404);
  EXPECT_EQ(status_of("POST /api/jsonrpc/" + host), 404);
  EXPECT_EQ(status_of("GET /api/jsonrpc" + host), 405);
  EXPECT_EQ(status_of("OPTIONS /api/jsonrpc?x=1" + host), 405);
  EXPECT_EQ(status_of("BREW /api/jsonrpc" + host), 405);
  EXPECT_EQ(status_of("GET /api/jsonrpc HTTP/1.1\r\nHost: localhost\r\nUpgrade: websocket\r\n"
                      "Connection: Upgrade\r\n\r\n"),
            405);
}

TEST_F(AnHttpServer, RefusesWhatIsTooLarge) {
  const std::string begin = "POST /api/jsonrpc HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\n";
  constexpr std::size_t kMost_bytes = std::size_t{1} << 20U;
  EXPECT_EQ(status_of(begin + "Content-Length: 1048577\r\n\r\n"), 413);
  EXPECT_EQ(status_of(begin + "Transfer-Encoding: chunked\r\n\r\n101000\r\n" + std::string(0x101000, ' ')), 413);
  EXPECT_EQ(status_of(begin + "X: " + std::string(17000, 'x') + "\r\n\r\n"), 431);
  HttpClient client(server_->port());
  const std::string most = call("system.ping") + std::string(kMost_bytes - call("system.ping").size(), ' ');
  const auto reply = client.call(most);
  ASSERT_TRUE(reply);
  EXPECT_TRUE(json::parse(reply->body).contains("result")) << "a document needs room";
  const json many(std::vector<json>(100'000, json{{"id", 1}}));
  EXPECT_LT(client.call(many.dump()).value_or(HttpReply{}).body.size(), 1000U)
      << "what is refused makes no long answer";
}

TEST_F(AnHttpServer, RefusesWhatIsNoHttp) {
  EXPECT_EQ(status_of(call("job.start") + "\r\n\r\n"), 400);
  EXPECT_EQ(status_of("POST /api/jsonrpc HTTP/1.1\r\nContent-Length: -1\r\n\r\n"), 400);
  EXPECT_EQ(status_of(std::string("\x16\x03\x01\0\x05", 5) + "\r\n\r\n"), 400);
  EXPECT_EQ(ask(call("system.ping")).contains("result"), true);
}

TEST_F(AnHttpServer, TellsWhoWaitsForItToSendTheBody) {
  HttpClient client(server_->port());
  const std::string whole = client.request(call("system.ping"), "Expect: 100-continue\r\n");
  const auto body = whole.find("\r\n\r\n") + 4;
  const auto go_on = client.ask(whole.substr(0, body));
  ASSERT_TRUE(go_on);
  EXPECT_EQ(go_on->status, 100);
  EXPECT_EQ(client.ask(whole.substr(body)).value_or(HttpReply{}).status, 200);
}

TEST_F(AnHttpServer, AnswersAWaitWhenTheJobEnds) {
  ASSERT_TRUE(ask(call("job.start", {{"seq", 1}, {"part_id", "p"}}), bearer()).contains("result"));
  HttpClient waiting(server_->port());
  waiting.send(waiting.request(call("job.wait", {{"seq", 1}, {"timeout_ms", 30000}})));
  HttpClient impatient(server_->port());
  const auto late = impatient.call(call("job.wait", {{"seq", 1}, {"timeout_ms", 1}}));
  ASSERT_TRUE(late);
  EXPECT_EQ(json::parse(late->body)["result"]["state"], "processing");
  service_.change({1}, [](JobStatus& job) { job.state = JobState::kCompleted; });
  const auto reply = waiting.reply();
  ASSERT_TRUE(reply);
  EXPECT_EQ(json::parse(reply->body)["result"]["state"], "completed");
}

TEST_F(AnHttpServer, StopsWhileItsWorkerIsBusy) {
  std::promise<void> begun;
  std::promise<void> released;
  service_.before_start = [&] {
    begun.set_value();
    released.get_future().wait();
  };
  HttpClient starting(server_->port());
  starting.send(starting.request(call("job.start", {{"seq", 5}, {"part_id", "p"}}), bearer()));
  begun.get_future().wait();
  EXPECT_EQ(ask(call("stage.stop"), bearer())["result"]["stopped"], "command") << "recognised and done meanwhile";
  released.set_value();
  EXPECT_TRUE(starting.reply());
}

TEST_F(AnHttpServer, GivesPlacesOfTheSilentToOthers) {
  std::vector<std::unique_ptr<HttpClient>> silent;
  for (int i = 0; i < 70; ++i) silent.push_back(std::make_unique<HttpClient>(server_->port()));
  EXPECT_TRUE(ask(call("system.ping")).contains("result"));
  EXPECT_TRUE(silent.front()->closes()) << "the oldest gave way";
}

TEST_F(AnHttpServer, KeepsPlacesForWhoHasAToken) {
  ASSERT_TRUE(ask(call("job.start", {{"seq", 1}, {"part_id", "p"}}), bearer()).contains("result"));
  std::vector<std::unique_ptr<HttpClient>> waiting;
  for (int i = 0; i < 70; ++i) {
    waiting.push_back(std::make_unique<HttpClient>(server_->port()));
    waiting.back()->send(waiting.back()->request(call("job.wait", {{"seq", 1}, {"timeout_ms", 30000}})));
  }
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(15);
  while (ask(call("system.ping")) != 503) ASSERT_LT(std::chrono::steady_clock::now(), deadline);
  EXPECT_EQ(ask(call("stage.stop"), bearer())["result"]["stopped"], "command");
  service_.change({1}, [](JobStatus& job) { job.state = JobState::kCompleted; });
  const auto answered = std::count_if(waiting.begin(), waiting.end(), [](const auto& client) {
    return client->reply().value_or(HttpReply{}).status == 200;
  });
  EXPECT_EQ(answered, 32) << "half of the places";
}

TEST_F(AnHttpServer, ListensToNobodyForLongWhomItHasRefused) {
  HttpClient client(server_->port());
  const auto refused = client.ask("GET / HTTP/1.1\r\nHost: localhost\r\n\r\n");
  ASSERT_TRUE(refused);
  EXPECT_EQ(refused->status, 404);
  // A second of 64 KiB each 10 ms, and what stands in buffers, which may grow to 37 MiB; as fast as it comes is
  // hundreds of MiB. A machine without time for the server makes it less.
  const std::string more(1U << 20U, 'x');
  int sent_mib = 0;
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(15);
  for (; client.send(more); ++sent_mib) ASSERT_LT(std::chrono::steady_clock::now(), deadline) << "it reads on and on";
  EXPECT_LE(sent_mib, 64);
}

TEST_F(AnHttpServer, TellsWhoWaitsForTheDevicesThatItEnds) {
  test::write_text(folder_ / "tokens", credential_of("kiosk", Role::kAdminister, token_).line() + "\n");
  HttpClient moving(server_->port());
  moving.send(moving.request(call("stage.move", {{"z_um", 1}}), bearer()));
  ASSERT_TRUE(ask(call("job.start", {{"seq", 1}, {"part_id", "p"}}), bearer()).contains("result")) << "after it";
  server_.reset();
  const auto reply = moving.reply();
  ASSERT_TRUE(reply);
  const json error = json::parse(reply->body)["error"];
  EXPECT_EQ(error["code"], 1013) << reply->body;
  EXPECT_THAT(error["message"].get<std::string>(), HasSubstr("system.state"));
}

TEST_F(AnHttpServer, AnswersWhatIsOwedWhenItEnds) {
  HttpClient waiting(server_->port());
  ASSERT_TRUE(ask(call("job.start", {{"seq", 1}, {"part_id", "p"}}), bearer()).contains("result"));
  waiting.send(waiting.request(call("job.wait", {{"seq", 1}, {"timeout_ms", 30000}})));
  EXPECT_TRUE(ask(call("system.ping")).contains("result")) << "that thread has seen the wait, which came before";
  server_.reset();
  const auto reply = waiting.reply();
  ASSERT_TRUE(reply);
  EXPECT_EQ(json::parse(reply->body)["error"]["code"], 1013) << reply->body;
  EXPECT_TRUE(waiting.closes());
}

TEST_F(AnHttpServer, SaysAtItsEndThatItStopsWhereTheDiskIsStuck) {
  std::promise<void> begun;
  std::promise<void> released;
  // The snapshot tells nothing of this job: only the worker could.
  ASSERT_TRUE(ask(call("job.start", {{"seq", 5}, {"part_id", "p"}}), bearer()).contains("result"));
  HttpClient waiting(server_->port());
  waiting.send(waiting.request(call("job.wait", {{"seq", 5}, {"timeout_ms", 30000}})));
  ASSERT_FALSE(waiting.reply(std::chrono::milliseconds(100)));
  service_.before_start = [&] {
    begun.set_value();
    released.get_future().wait();
  };
  HttpClient starting(server_->port());
  starting.send(starting.request(call("job.start", {{"seq", 6}, {"part_id", "p"}}), bearer()));
  begun.get_future().wait();
  auto ended = std::async(std::launch::async, [this] { server_.reset(); });
  const auto reply = waiting.reply();
  released.set_value();
  ended.wait();
  ASSERT_TRUE(reply);
  EXPECT_EQ(json::parse(reply->body)["error"]["code"], 1013) << reply->body;
}

TEST_F(AnHttpServer, RefusesAPortThatIsTaken) {
  test::expect_error(ErrorCode::kNotReady, {"cannot listen on 127.0.0.1", "/http/port"},
                     [this] { const HttpServer other(on_port(server_->port()), service_.services()); });
}

}  // namespace
}  // namespace fvd
