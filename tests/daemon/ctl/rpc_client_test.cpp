#include "daemon/ctl/rpc_client.hpp"

#include <gtest/gtest.h>

#include "tests/daemon/ctl/fake_rpc_server.hpp"
#include "tests/support/expect_error.hpp"
#include "tests/support/scratch_dir.hpp"

namespace fvd::ctl {
namespace {

using test::expect_error;
using test::FakeRpcServer;
using test::ScratchDir;

TEST(RpcClient, ReturnsTheResult) {
  FakeRpcServer server({{"system.ping", FakeRpcServer::result({{"hb", 7}})}});
  RpcClient client(server.endpoint());
  EXPECT_EQ(client.call("system.ping", {{"t", 1}})["hb"], 7);
  EXPECT_EQ(server.requests().at(0)["params"], nlohmann::json({{"t", 1}}));
}

TEST(RpcClient, PutsAReplyTogetherFromItsPieces) {
  FakeRpcServer server({{"a", {"{\"jsonrpc\":\"2.0\",", "\"id\":$ID,\"res", "ult\":[1,", "2]}\r", "\n"}}});
  EXPECT_EQ(RpcClient(server.endpoint()).call("a"), Json::parse("[1,2]"));
}

TEST(RpcClient, SkipsNotificationsAndEmptyLines) {
  FakeRpcServer server({{"a",
                         {"\r\n{\"jsonrpc\":\"2.0\",\"method\":\"event.state\",\"params\":{}}\n\n",
                          "{\"jsonrpc\":\"2.0\",\"id\":$ID,\"result\":null}\n"}}});
  EXPECT_TRUE(RpcClient(server.endpoint()).call("a").is_null());
}

TEST(RpcClient, CallsAgainOnTheSameConnection) {
  FakeRpcServer server({{"a", FakeRpcServer::result(1)}, {"b", FakeRpcServer::result(2)}});
  RpcClient client(server.endpoint());
  EXPECT_EQ(client.call("a"), 1);
  EXPECT_EQ(client.call("b"), 2);
  EXPECT_NE(server.requests().at(0)["id"], server.requests().at(1)["id"]);
}

TEST(RpcClient, ThrowsTheErrorOfTheReply) {
  FakeRpcServer server(
      {{"a", FakeRpcServer::error({{"code", 1002}, {"message", "busy"}, {"data", {{"error", "busy"}}}})}});
  try {
    (void)RpcClient(server.endpoint()).call("a");
    FAIL() << "no error";
  } catch (const RpcError& error) {
    EXPECT_EQ(error.code(), 1002);
    EXPECT_STREQ(error.what(), "busy");
    EXPECT_EQ(error.data()["error"], "busy");
  }
}

TEST(RpcClient, TakesAnErrorWithoutIdForItsOwn) {
  FakeRpcServer server(
      {{"a", FakeRpcServer::raw(
                 "{\"jsonrpc\":\"2.0\",\"id\":null,\"error\":{\"code\":-32700,\"message\":\"parse error\"}}\n")}});
  EXPECT_THROW((void)RpcClient(server.endpoint()).call("a"), RpcError);
}

TEST(RpcClient, RefusesRepliesThatAreNoJsonRpc) {
  for (const char* reply :
       {"[]\n", "{\"jsonrpc\":\"1.0\",\"id\":1,\"result\":1}\n", "{\"jsonrpc\":\"2.0\",\"id\":99,\"result\":1}\n",
        "{\"jsonrpc\":\"2.0\",\"id\":$ID}\n", "{\"jsonrpc\":\"2.0\",\"id\":$ID,\"error\":\"no\"}\n", "\xFF\xFE\n"}) {
    FakeRpcServer server({{"a", FakeRpcServer::raw(reply)}});
    expect_error(ErrorCode::kInternal, {"the reply"}, [&] { (void)RpcClient(server.endpoint()).call("a"); });
  }
}

TEST(RpcClient, TellsAConnectionThatClosesInTheMiddleOfAReply) {
  FakeRpcServer server({{"a", {"{\"jsonrpc\":"}, true}});
  expect_error(ErrorCode::kNotReady, {"127.0.0.1", "closed the connection"},
               [&] { (void)RpcClient(server.endpoint()).call("a"); });
}

TEST(RpcClient, GivesUpOnAServerThatFallsSilent) {
  FakeRpcServer server({{"a", FakeRpcServer::raw("{\"jsonrpc\":")}});
  RpcClient client(server.endpoint());
  expect_error(ErrorCode::kTimeout, {"did not answer"},
               [&] { (void)client.call("a", Json::object(), std::chrono::milliseconds(50)); });
}

TEST(RpcClient, AsksWhetherTheDaemonRunsWhenNobodyListens) {
  RpcEndpoint endpoint;
  { endpoint = FakeRpcServer({}).endpoint(); }
  expect_error(ErrorCode::kNotReady, {endpoint.text(), "refused", "is fvd running"},
               [&] { const RpcClient client(endpoint); });
}

TEST(RpcEndpoint, IsReadFromTextAndFile) {
  EXPECT_EQ(parse_endpoint("localhost:7411").text(), "localhost:7411");
  EXPECT_EQ(parse_endpoint("[::1]:80").host, "::1");
  EXPECT_EQ(parse_endpoint("[::1]:80").text(), "[::1]:80");
  EXPECT_FALSE(parse_endpoint("localhost:7411").is_http);
  EXPECT_TRUE(parse_endpoint("http://localhost:7413").is_http);
  EXPECT_EQ(parse_endpoint("http://[::1]:7413/").text(), "[::1]:7413");
  expect_error(ErrorCode::kBadInput, {"no TLS"}, [] { (void)parse_endpoint("https://localhost:7413"); });
  for (const char* text : {"", "host", "host:", ":1", "host:0", "host:65536", "host:1x", "host:-1", "http://host",
                           "http://host:1/x", "http://"}) {
    expect_error(ErrorCode::kBadInput, {"host:port"}, [&] { (void)parse_endpoint(text); });
  }
  const ScratchDir scratch;
  test::write_text(scratch / "rpc.json", R"({"address": "127.0.0.1", "port": 1234})");
  EXPECT_EQ(read_endpoint(scratch.path()).text(), "127.0.0.1:1234");
  for (const char* text : {"", "[]", "{\"address\": 1, \"port\": 1}", "{\"address\": \"a\", \"port\": 70000}"}) {
    test::write_text(scratch / "rpc.json", text);
    expect_error(ErrorCode::kBadInput, {"rpc.json"}, [&] { (void)read_endpoint(scratch.path()); });
  }
  expect_error(ErrorCode::kNotReady, {"is fvd running"}, [&] { (void)read_endpoint(scratch / "nowhere"); });
}

}  // namespace
}  // namespace fvd::ctl
