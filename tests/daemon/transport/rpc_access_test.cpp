/// Who gets a connection, as whom, and what overtakes what.

#include <chrono>
#include <future>
#include <memory>
#include <vector>

#include <nlohmann/json.hpp>

#include "daemon/access/token_file.hpp"
#include "daemon/transport/rpc_server.hpp"
#include "gtest/gtest.h"
#include "tests/daemon/api/fake_job_service.hpp"
#include "tests/support/captured_log.hpp"
#include "tests/support/line_client.hpp"
#include "tests/support/rpc_text.hpp"
#include "tests/support/scratch_dir.hpp"

namespace fvd {
namespace {

using nlohmann::json;

using test::call;

class AGuardedRpcServer : public testing::Test {
 protected:
  AGuardedRpcServer() { config_.port = 0; }

  void serve() {
    service_.access.emplace(config_.access);
    server_ = std::make_unique<RpcServer>(config_, folder_.path(), service_.services());
  }
  json ask(LineClient& client, const std::string& line) { return json::parse(client.ask(line)); }
  [[nodiscard]] std::filesystem::path socket() const { return folder_ / "fvd.sock"; }

  test::ScratchDir folder_;
  RpcConfig config_;
  FakeJobService service_;
  std::unique_ptr<RpcServer> server_;
};

TEST_F(AGuardedRpcServer, RecognisesCallersByTheirWay) {
  serve();
  LineClient tcp(server_->port());
  EXPECT_EQ(ask(tcp, call("session.info"))["result"], (json{{"who", "address 127.0.0.1"}, {"role", "operate"}}));
  EXPECT_EQ(ask(tcp, call("stage.move", {{"z_um", 1}}))["error"]["code"], 1004);
  LineClient local(socket());
  EXPECT_EQ(ask(local, call("session.info"))["result"]["role"], "administer") << "the daemon's own user";
  local.send(call("stage.move", {{"z_um", 1}}) + "\n");
  EXPECT_TRUE(ask(tcp, call("system.ping")).contains("result"));
  server_.reset();
  EXPECT_NE(service_.task, nullptr);
  EXPECT_FALSE(std::filesystem::exists(socket()));
}

TEST_F(AGuardedRpcServer, TurnsAwayWhoMayNothingAndCannotLogIn) {
  config_.access.allow = {{"127.0.0.2", Role::kView}};
  config_.access.loopback_role = Role::kNone;
  serve();
  LineClient client(server_->port());
  client.send(call("system.state") + "\n");
  const auto line = client.line();
  ASSERT_TRUE(line);
  EXPECT_EQ(json::parse(*line)["error"]["data"]["error"], "not_allowed");
  EXPECT_TRUE(client.closes());
}

TEST_F(AGuardedRpcServer, WarnsOnceASecondOfConnectionsFromWhereNobodyMayDoAnything) {
  config_.access.loopback_role = Role::kNone;
  serve();
  const test::CapturedLog log;
  const auto begin = std::chrono::steady_clock::now();
  for (int i = 0; i < 20; ++i) {
    LineClient client(server_->port());
    EXPECT_TRUE(client.line());
  }
  server_.reset();
  const auto seconds = (std::chrono::steady_clock::now() - begin) / std::chrono::seconds(1);
  EXPECT_GE(log.lines_with("a connection is refused"), 1U);
  EXPECT_LE(log.lines_with("a connection is refused"), 1 + static_cast<std::size_t>(seconds));
}

TEST_F(AGuardedRpcServer, GivesATokensRoleToItsConnectionAlone) {
  const std::string token = new_token();
  config_.access.token_file = folder_ / "tokens";
  config_.access.loopback_role = Role::kNone;
  test::write_text(config_.access.token_file, credential_of("anna", Role::kSetUp, token).line());
  serve();
  LineClient client(server_->port());
  LineClient other(server_->port());
  EXPECT_EQ(ask(client, call("system.state"))["error"]["code"], 1004);
  EXPECT_EQ(ask(client, call("session.login", {{"token", "wrong"}}))["error"]["code"], 1004);
  EXPECT_EQ(ask(client, call("session.login", {{"token", token}}))["result"]["role"], "set_up");
  EXPECT_EQ(ask(client, call("system.state"))["result"]["state"], "ready");
  EXPECT_EQ(ask(client, call("calibrate.accept"))["error"]["code"], 1004);
  EXPECT_EQ(ask(other, call("system.state"))["error"]["code"], 1004);
}

TEST_F(AGuardedRpcServer, ClosesWhoMakesNoValidRequestInTime) {
  config_.first_request_s = 1;
  serve();
  LineClient silent(server_->port());
  LineClient talking(server_->port());
  LineClient babbling(server_->port());
  LineClient forbidden(server_->port());
  EXPECT_TRUE(ask(talking, call("system.ping")).contains("result"));
  EXPECT_TRUE(ask(babbling, call("no.such.method")).contains("error"));
  EXPECT_TRUE(ask(forbidden, call("stage.move", {{"z_um", 1}})).contains("error"));
  EXPECT_TRUE(silent.closes());
  EXPECT_TRUE(babbling.closes());
  EXPECT_TRUE(forbidden.closes());
  EXPECT_TRUE(ask(talking, call("system.ping")).contains("result"));
}

TEST_F(AGuardedRpcServer, KeepsAPlaceForWhoHasControl) {
  config_.max_connections = 3;
  serve();
  {
    LineClient controller(socket());
    ASSERT_TRUE(ask(controller, call("control.acquire", {{"owner", "plc"}})).contains("result"));
  }
  // The controller's connection is gone once the server has seen it: then two more come in, and not a third.
  LineClient first(server_->port());
  EXPECT_TRUE(ask(first, call("system.ping")).contains("result"));
  LineClient second(server_->port());
  EXPECT_TRUE(ask(second, call("system.ping")).contains("result"));
  LineClient third(server_->port());
  const auto refused = third.line();
  ASSERT_TRUE(refused);
  EXPECT_EQ(json::parse(*refused)["error"]["data"]["error"], "too_many_connections");
  EXPECT_TRUE(third.closes());
  LineClient back(socket());
  EXPECT_EQ(ask(back, call("control.state"))["result"]["yours"], true);
  LineClient anew(socket());
  EXPECT_EQ(ask(anew, call("control.state"))["result"]["yours"], true) << "its old connection gives way";
  EXPECT_TRUE(back.closes());
}

TEST_F(AGuardedRpcServer, LetsWhoMayControlByATokenHaveThatPlace) {
  const std::string operating = new_token();
  const std::string looking = new_token();
  config_.access.token_file = folder_ / "tokens";
  config_.access.loopback_role = Role::kView;
  config_.max_connections = 2;
  test::write_text(config_.access.token_file, credential_of("plc", Role::kOperate, operating).line() + "\n" +
                                                  credential_of("guest", Role::kView, looking).line() + "\n");
  serve();
  LineClient viewer(server_->port());
  EXPECT_TRUE(ask(viewer, call("system.ping")).contains("result"));
  const auto expect_refused = [](LineClient& client) {
    const auto line = client.line();
    ASSERT_TRUE(line);
    EXPECT_EQ(json::parse(*line)["error"]["data"]["error"], "too_many_connections");
    EXPECT_TRUE(client.closes());
  };
  LineClient idle(server_->port());  // one of those that may still log in
  LineClient asking(server_->port());
  asking.send(call("system.state") + "\n");
  expect_refused(asking);
  LineClient guest(server_->port());
  EXPECT_EQ(ask(guest, call("session.login", {{"token", "wrong"}}))["error"]["code"], 1004);
  expect_refused(guest);
  LineClient other(server_->port());
  other.send(call("session.login", {{"token", looking}}) + "\n");
  expect_refused(other);
  LineClient controller(server_->port());
  EXPECT_EQ(ask(controller, call("session.login", {{"token", operating}}))["result"]["role"], "operate");
  EXPECT_TRUE(ask(controller, call("control.acquire", {{"owner", "plc"}})).contains("result"));
  LineClient anew(server_->port());
  EXPECT_EQ(ask(anew, call("session.login", {{"token", operating}}))["result"]["role"], "operate");
  EXPECT_TRUE(controller.closes()) << "its old connection gives way";
}

TEST_F(AGuardedRpcServer, LetsNoSilentConnectionsKeepWhoMayControlFromLoggingIn) {
  const std::string operating = new_token();
  config_.access.token_file = folder_ / "tokens";
  config_.access.loopback_role = Role::kView;
  config_.max_connections = 2;
  config_.first_request_s = 60;
  test::write_text(config_.access.token_file, credential_of("plc", Role::kOperate, operating).line());
  serve();
  LineClient viewer(server_->port());
  EXPECT_TRUE(ask(viewer, call("system.ping")).contains("result"));
  std::vector<std::unique_ptr<LineClient>> silent;
  for (int i = 0; i < 4; ++i) silent.push_back(std::make_unique<LineClient>(server_->port()));
  LineClient controller(server_->port());
  EXPECT_EQ(ask(controller, call("session.login", {{"token", operating}}))["result"]["role"], "operate");
  EXPECT_TRUE(silent.front()->closes()) << "the oldest gives way";
}

TEST_F(AGuardedRpcServer, LogsInWhileTheWorkerIsBusy) {
  const std::string token = new_token();
  config_.access.token_file = folder_ / "tokens";
  test::write_text(config_.access.token_file, credential_of("kiosk", Role::kOperate, token).line());
  std::promise<void> begun;
  std::promise<void> released;
  service_.before_start = [&] {
    begun.set_value();
    released.get_future().wait();
  };
  serve();
  LineClient starting(server_->port());
  starting.send(call("job.start", {{"seq", 5}, {"part_id", "p"}}) + "\n");
  begun.get_future().wait();
  LineClient kiosk(server_->port());
  EXPECT_EQ(ask(kiosk, call("session.login", {{"token", token}}))["result"]["who"], "token kiosk");
  EXPECT_EQ(ask(kiosk, call("stage.stop"))["result"]["stopped"], "command");
  released.set_value();
  EXPECT_TRUE(starting.line());
}

TEST_F(AGuardedRpcServer, StopsWhileTheWorkerAndTheConnectionAreBusy) {
  std::promise<void> begun;
  std::promise<void> released;
  service_.before_start = [&] {
    begun.set_value();
    released.get_future().wait();
  };
  service_.current = JobStatus{};
  service_.current->job_id = "J1";
  serve();
  LineClient client(server_->port());
  LineClient other(server_->port());
  client.send(call("job.start", {{"seq", 5}, {"part_id", "p"}}) + "\n");
  begun.get_future().wait();
  client.send(call("system.ping", json::object(), 2) + "\n" + call("stage.stop", json::object(), 3) + "\n" +
              call("job.abort", {{"job_id", "J1"}}, 4) + "\n" + call("job.abort", {{"job_id", "J0"}}, 5) + "\n");
  for (const int id : {3, 4}) {
    const auto line = client.line();
    ASSERT_TRUE(line);
    EXPECT_EQ(json::parse(*line)["id"], id) << "it overtakes the start and the ping";
  }
  EXPECT_EQ(ask(other, call("stage.stop"))["result"]["stopped"], "command");
  EXPECT_EQ(service_.stops, 2);
  released.set_value();
  for (const int id : {1, 2, 5}) {
    const auto line = client.line();
    ASSERT_TRUE(line);
    EXPECT_EQ(json::parse(*line)["id"], id) << "the others in their order";
  }
}

TEST_F(AGuardedRpcServer, MovesNothingThatStoodBehindAMotionWhenAStopCame) {
  config_.access.loopback_role = Role::kAdminister;
  std::promise<void> begun;
  std::promise<void> released;
  service_.before_start = [&] {
    begun.set_value();
    released.get_future().wait();
  };
  serve();
  LineClient client(server_->port());
  client.send(call("job.start", {{"seq", 5}, {"part_id", "p"}}) + "\n" + call("stage.move", {{"z_um", 1}}, 2) + "\n");
  begun.get_future().wait();
  client.send(call("stage.stop", json::object(), 3) + "\n");
  auto line = client.line();
  ASSERT_TRUE(line);
  EXPECT_EQ(json::parse(*line)["id"], 3);
  released.set_value();
  ASSERT_TRUE(client.line());
  line = client.line();
  ASSERT_TRUE(line);
  EXPECT_EQ(json::parse(*line)["id"], 2);
  EXPECT_EQ(json::parse(*line).value("/error/code"_json_pointer, 0), 1012) << *line;
  EXPECT_TRUE(service_.motions.empty()) << "it was asked for before the stop, however late its turn came";
}

}  // namespace
}  // namespace fvd
