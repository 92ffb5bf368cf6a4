#include "daemon/transport/rpc_server.hpp"

#include <chrono>
#include <filesystem>
#include <future>

#include <nlohmann/json.hpp>

#include "core/base/error.hpp"
#include "gtest/gtest.h"
#include "tests/daemon/api/fake_job_service.hpp"
#include "tests/support/line_client.hpp"
#include "tests/support/rpc_text.hpp"
#include "tests/support/scratch_dir.hpp"

namespace fvd {
namespace {

using nlohmann::json;
using std::chrono::milliseconds;

/// Which the network thread cannot answer.
const std::string kLatest = R"({"jsonrpc":"2.0","id":1,"method":"job.latest"})";

class AnRpcServer : public testing::Test {
 protected:
  static RpcConfig config(int max_connections = 4, int idle_timeout_s = 60) {
    RpcConfig config;
    config.port = 0;
    config.max_connections = max_connections;
    config.idle_timeout_s = idle_timeout_s;
    config.access.loopback_role = Role::kAdminister;
    return config;
  }
  void serve(const RpcConfig& with) {
    server_.reset();
    service_.access.emplace(with.access);
    server_ = std::make_unique<RpcServer>(with, runtime_.path(), service_.services());
  }
  static bool answers(LineClient& client) { return client.ask(test::kPing).find("\"result\"") != std::string::npos; }

  test::ScratchDir runtime_;
  FakeJobService service_;
  std::unique_ptr<RpcServer> server_;
};

TEST_F(AnRpcServer, WritesItsAddressAndRemovesIt) {
  serve(config());
  const json file = json::parse(test::read_text(runtime_.path() / "rpc.json"));
  EXPECT_EQ(file["port"], server_->port());
  EXPECT_EQ(file["address"], "127.0.0.1");
  EXPECT_EQ(file["socket"], (runtime_.path() / "fvd.sock").string());
  server_.reset();
  EXPECT_FALSE(std::filesystem::exists(runtime_.path() / "rpc.json"));
  serve(config());
  std::ofstream(runtime_.path() / "rpc.json") << R"({"address": "127.0.0.1", "port": 1, "pid": 1})";
  server_.reset();
  EXPECT_TRUE(std::filesystem::exists(runtime_.path() / "rpc.json")) << "it is another program's by now";
}

TEST_F(AnRpcServer, TakesEveryTerminatorAndLinesInPieces) {
  serve(config());
  LineClient client(server_->port());
  for (const std::string& end : {std::string("\n"), std::string("\r\n"), std::string("\r"), std::string(1, '\0')}) {
    client.send(test::kPing.substr(0, 10));
    client.send(test::kPing.substr(10) + end);
    EXPECT_TRUE(client.line().has_value()) << "terminator " << static_cast<int>(end[0]);
  }
  client.send("\n\r\n  \n" + test::kPing + "\n" + test::kPing + "\n");
  EXPECT_TRUE(client.line().has_value());
  EXPECT_TRUE(client.line().has_value());
}

TEST_F(AnRpcServer, RefusesALineOver64KiBAndCloses) {
  serve(config());
  LineClient client(server_->port());
  client.send(std::string(70000, 'x'));
  const auto line = client.line();
  ASSERT_TRUE(line.has_value());
  EXPECT_EQ(json::parse(*line)["error"]["code"], -32600);
  EXPECT_TRUE(client.closes());
  LineClient other(server_->port());
  EXPECT_TRUE(answers(other));
}

TEST_F(AnRpcServer, DropsWhatARefusedClientGoesOnSendingAtAPace) {
  serve(config());
  LineClient client(runtime_.path() / "fvd.sock");  // unlike that of TCP, its buffer does not grow
  client.send(std::string(70000, 'x'));
  const auto line = client.line();
  ASSERT_TRUE(line.has_value());
  ASSERT_EQ(json::parse(*line)["error"]["code"], -32600);

  // In the second until it is closed: 64 KiB each 10 ms, thrice that with what stands in the buffer. A machine without
  // time for the server makes it less, never more. As fast as it comes is hundreds of MiB.
  constexpr std::size_t kMost_bytes = std::size_t{3} * 100 * 65536;
  const std::string piece(65536, 'x');
  std::size_t sent_bytes = 0;
  while (sent_bytes <= kMost_bytes && client.send(piece)) sent_bytes += piece.size();
  EXPECT_LE(sent_bytes, kMost_bytes);
}

/// What `curl -X POST -H 'Content-Type: text/plain' --data ...` sends, and so any web page.
std::string http_post(const std::string& first_line, const std::string& body) {
  return first_line + "\r\nHost: 127.0.0.1:4711\r\nUser-Agent: curl/7.88.1\r\nAccept: */*\r\n" +
         "Content-Type: text/plain\r\nContent-Length: " + std::to_string(body.size()) + "\r\n\r\n" + body;
}

TEST_F(AnRpcServer, ExecutesNothingThatAWebPageSends) {
  serve(config());
  const std::string move = R"({"jsonrpc":"2.0","id":1,"method":"stage.move","params":{"z_um":100}})"
                           "\n";
  const std::string start = R"({"jsonrpc":"2.0","id":2,"method":"job.start","params":[1,"p"]})"
                            "\n";
  for (const char* first_line : {"POST / HTTP/1.1", "GET / HTTP/1.1", "OPTIONS * HTTP/1.1", "made-up / HTTP/1.1",
                                 "PRI * HTTP/2.0", "\x16\x03\x01", "whatever comes, three lines are no JSON"}) {
    LineClient page(server_->port());
    page.send(http_post(first_line, move + start));
    EXPECT_TRUE(page.closes()) << first_line;
  }
  LineClient polite_first(server_->port());
  ASSERT_TRUE(answers(polite_first));
  polite_first.send(http_post("POST / HTTP/1.1", move + start));
  EXPECT_TRUE(polite_first.closes());

  LineClient other(server_->port());
  EXPECT_TRUE(answers(other)) << "all that was sent before is done with";
  EXPECT_EQ(service_.task, nullptr);
  EXPECT_EQ(service_.starts, 0);
}

TEST_F(AnRpcServer, ClosesAfterThreeParseErrorsInARowAndSaysWhy) {
  serve(config());
  LineClient client(server_->port());
  for (int i = 0; i < 2; ++i) EXPECT_EQ(json::parse(client.ask("nonsense"))["error"]["code"], -32700);
  EXPECT_TRUE(answers(client)) << "a good line in between counts anew";
  for (int i = 0; i < 2; ++i) EXPECT_EQ(json::parse(client.ask("nonsense"))["error"]["code"], -32700);
  const json last = json::parse(client.ask("nonsense"));
  EXPECT_EQ(last["error"]["code"], -32700);
  EXPECT_NE(last["error"]["message"].get<std::string>().find("closed"), std::string::npos);
  EXPECT_TRUE(client.closes());
}

TEST_F(AnRpcServer, ClosesASilentConnectionAlsoWithHalfALine) {
  serve(config(4, 1));
  LineClient half(server_->port());
  half.send("{\"jsonrpc\":");
  EXPECT_TRUE(half.closes(milliseconds(5000)));
}

TEST_F(AnRpcServer, SurvivesClientsThatVanish) {
  serve(config());
  for (int i = 0; i < 20; ++i) {
    LineClient client(server_->port());
    client.send(i % 2 == 0 ? test::kPing + "\n" : R"({"jsonrpc":"2.0","id":1,"met)");
  }
  // Those that are gone no longer count, once the server has noticed.
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(5);
  bool answered = false;
  while (!answered && std::chrono::steady_clock::now() < deadline) {
    LineClient client(server_->port());
    answered = answers(client);
  }
  EXPECT_TRUE(answered);
}

TEST_F(AnRpcServer, TurnsAwayAConnectionTooMany) {
  serve(config(1));
  LineClient first(server_->port());
  ASSERT_TRUE(answers(first));
  LineClient second(server_->port());
  const auto line = second.line();
  ASSERT_TRUE(line.has_value());
  EXPECT_EQ(json::parse(*line)["error"]["data"]["error"], "too_many_connections");
  EXPECT_TRUE(second.closes());
  EXPECT_TRUE(answers(first));
}

TEST_F(AnRpcServer, AnswersAWaitWhenTheJobEndsAndLaterRequestsAfterIt) {
  serve(config());
  LineClient client(server_->port());
  LineClient other(server_->port());
  client.ask(R"({"jsonrpc":"2.0","id":1,"method":"job.start","params":[5,"p"]})");
  client.send(R"({"jsonrpc":"2.0","id":2,"method":"job.wait","params":{"seq":5}})" + std::string("\n") + kLatest +
              "\n");
  EXPECT_TRUE(answers(other)) << "a wait blocks nobody else";
  EXPECT_FALSE(client.line(milliseconds(50)).has_value());
  service_.change({5}, [](JobStatus& job) { job.state = JobState::kCompleted; });
  const auto ended = client.line();
  ASSERT_TRUE(ended.has_value());
  EXPECT_EQ(json::parse(*ended)["id"], 2);
  EXPECT_EQ(json::parse(*ended)["result"]["done"], true);
  EXPECT_TRUE(client.line().has_value()) << "the request behind it";
}

TEST_F(AnRpcServer, AnswersWhatHasComeBeforeItEnds) {
  serve(config());
  LineClient client(server_->port());
  client.ask(R"({"jsonrpc":"2.0","id":1,"method":"job.start","params":[5,"p"]})");
  client.send(R"({"jsonrpc":"2.0","id":2,"method":"job.wait","params":{"seq":5}})" + std::string("\n"));
  EXPECT_FALSE(client.line(milliseconds(50)).has_value());
  service_.change({5}, [](JobStatus& job) { job.state = JobState::kAborted; });
  server_.reset();
  const auto ended = client.line();
  ASSERT_TRUE(ended.has_value()) << "the end of the job is told before the connection closes";
  EXPECT_EQ(json::parse(*ended)["result"]["state"], "aborted");
  EXPECT_TRUE(client.closes());
}

TEST_F(AnRpcServer, AnswersPingsWhileAnotherClientsStartIsOnTheDisk) {
  std::promise<void> begun;
  std::promise<void> released;
  service_.before_start = [&] {
    begun.set_value();
    released.get_future().wait();
  };
  serve(config());
  LineClient starter(server_->port());
  LineClient other(server_->port());
  starter.send(R"({"jsonrpc":"2.0","id":2,"method":"job.start","params":[5,"p"]})" + std::string("\n") + test::kPing +
               "\n");
  begun.get_future().wait();
  for (int i = 0; i < 100; ++i) EXPECT_TRUE(answers(other));
  EXPECT_EQ(json::parse(other.ask(R"({"jsonrpc":"2.0","id":1,"method":"system.state"})"))["result"]["state"], "ready");
  released.set_value();
  const auto started = starter.line();
  ASSERT_TRUE(started.has_value());
  EXPECT_EQ(json::parse(*started)["id"], 2) << "the start is answered first";
  const auto ping = starter.line();
  ASSERT_TRUE(ping.has_value());
  EXPECT_EQ(json::parse(*ping)["id"], 1) << "and what came behind it then";
}

TEST_F(AnRpcServer, StartsAndTellsResultsWhileAnotherClientsListIsRead) {
  std::promise<void> begun;
  std::promise<void> released;
  service_.history.before_list = [&] {
    begun.set_value();
    released.get_future().wait();
  };
  serve(config());
  LineClient viewer(server_->port());
  LineClient plc(server_->port());
  viewer.send(R"({"jsonrpc":"2.0","id":9,"method":"job.list"})"
              "\n");
  begun.get_future().wait();
  for (const char* line : {R"({"jsonrpc":"2.0","id":2,"method":"job.start","params":[5,"p"]})",
                           R"({"jsonrpc":"2.0","id":3,"method":"job.latest"})"}) {
    EXPECT_TRUE(json::parse(plc.ask(line)).contains("result")) << line;
  }
  released.set_value();
  const auto listed = viewer.line();
  ASSERT_TRUE(listed.has_value());
  EXPECT_EQ(json::parse(*listed)["id"], 9);
}

TEST_F(AnRpcServer, RefusesAnAnswerThatAConnectionDoesNotTakeAndKeepsTheConnection) {
  service_.history.points.assign(2000, {"J1", std::string(64, '\x01'), std::string(24, '0'), {}});
  serve(config());
  LineClient client(server_->port());
  const json refused = json::parse(client.ask(
      R"({"jsonrpc":"2.0","id":4,"method":"value.list","params":{"measurement":"m","value":"v","most":2000}})"));
  EXPECT_EQ(refused["id"], 4);
  EXPECT_EQ(refused["error"]["code"], -32602);
  EXPECT_TRUE(answers(client));
}

TEST_F(AnRpcServer, AnswersPingsWhileAnotherClientsPictureIsMade) {
  std::promise<void> begun;
  std::promise<void> released;
  service_.before_preview = [&] {
    begun.set_value();
    released.get_future().wait();
  };
  serve(config());
  LineClient viewer(server_->port());
  LineClient other(server_->port());
  viewer.send(R"({"jsonrpc":"2.0","id":3,"method":"camera.preview"})"
              "\n");
  begun.get_future().wait();
  for (int i = 0; i < 100; ++i) EXPECT_TRUE(answers(other));
  released.set_value();
}

TEST_F(AnRpcServer, ForgetsAClientThatLeavesWhileItsStartIsOnTheDisk) {
  std::promise<void> begun;
  std::promise<void> released;
  service_.before_start = [&] {
    begun.set_value();
    released.get_future().wait();
  };
  serve(config());
  {
    LineClient starter(server_->port());
    starter.send(R"({"jsonrpc":"2.0","id":2,"method":"job.start","params":[5,"p"]})" + std::string("\n"));
    begun.get_future().wait();
  }
  released.set_value();
  LineClient other(server_->port());
  EXPECT_EQ(json::parse(
                other.ask(R"({"jsonrpc":"2.0","id":3,"method":"job.status","params":{"seq":5}})"))["result"]["job_id"],
            "job-5");
}

TEST_F(AnRpcServer, AnswersAClientThatHasClosedItsSendingSide) {
  serve(config());
  LineClient client(server_->port());
  client.send(R"({"jsonrpc":"2.0","id":1,"method":"job.start","params":[5,"p"]})"
              "\n"
              R"({"jsonrpc":"2.0","id":2,"method":"job.wait","params":{"seq":5}})"
              "\n" +
              kLatest + "\n" + R"({"jsonrpc":"2.0","id":9,"method":"stage.home"})");
  client.finish_sending();
  const auto started = client.line();
  ASSERT_TRUE(started.has_value());
  EXPECT_EQ(json::parse(*started)["id"], 1);
  EXPECT_FALSE(client.line(milliseconds(50)).has_value());
  service_.change({5}, [](JobStatus& job) { job.state = JobState::kCompleted; });
  const auto ended = client.line();
  ASSERT_TRUE(ended.has_value());
  EXPECT_EQ(json::parse(*ended)["result"]["done"], true);
  EXPECT_TRUE(client.line().has_value()) << "the request behind it";
  EXPECT_NE(client.line().value_or("").find("no end of line"), std::string::npos);
  EXPECT_TRUE(client.closes());
  EXPECT_EQ(service_.task, nullptr) << "a line without an end is no request";
}

TEST_F(AnRpcServer, GivesTheConnectionOfAClientThatLeftToTheNext) {
  serve(config(1));
  LineClient gone(server_->port());
  gone.ask(R"({"jsonrpc":"2.0","id":1,"method":"job.start","params":[5,"p"]})");
  gone.send(R"({"jsonrpc":"2.0","id":2,"method":"job.wait","params":{"seq":5}})" + std::string("\n"));
  gone.finish_sending();
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(5);
  bool answered = false;
  while (!answered && std::chrono::steady_clock::now() < deadline) {
    LineClient next(server_->port());
    answered = answers(next);
  }
  EXPECT_TRUE(answered);
  EXPECT_TRUE(gone.closes());
}

TEST_F(AnRpcServer, EndsAWaitAtItsTimeout) {
  serve(config());
  LineClient client(server_->port());
  client.ask(R"({"jsonrpc":"2.0","id":1,"method":"job.start","params":[5,"p"]})");
  const json answer =
      json::parse(client.ask(R"({"jsonrpc":"2.0","id":2,"method":"job.wait","params":{"seq":5,"timeout_ms":30}})"));
  EXPECT_EQ(answer["result"]["done"], false);
}

TEST_F(AnRpcServer, StopsWhileClientsWait) {
  serve(config());
  LineClient client(server_->port());
  client.ask(R"({"jsonrpc":"2.0","id":1,"method":"job.start","params":[5,"p"]})");
  client.send(R"({"jsonrpc":"2.0","id":2,"method":"job.wait","params":{"seq":5}})" + std::string("\n"));
  server_.reset();
  EXPECT_TRUE(client.closes());
}

TEST_F(AnRpcServer, SaysWhereItCannotListen) {
  serve(config());
  RpcConfig taken = config();
  taken.port = server_->port();
  const test::ScratchDir other;
  try {
    const RpcServer second(taken, other.path(), service_.services());
    FAIL() << "listened twice on one port";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kNotReady) << "the port may be given free: the service tries again";
    EXPECT_NE(std::string(error.what()).find(std::to_string(taken.port)), std::string::npos);
  }
}

}  // namespace
}  // namespace fvd
