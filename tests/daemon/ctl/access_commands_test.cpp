/// fvdctl against the daemon's own servers: who it is by each way, and the commands that need no daemon.

#include <thread>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>
#include <poll.h>
#include <sys/socket.h>

#include "daemon/access/token_file.hpp"
#include "daemon/transport/http_server.hpp"
#include "daemon/transport/rpc_server.hpp"
#include "daemon/transport/unix_socket.hpp"
#include "tests/daemon/api/fake_job_service.hpp"
#include "tests/daemon/ctl/run_command.hpp"
#include "tests/support/scratch_dir.hpp"

namespace fvd::ctl {
namespace {

using ::testing::AllOf;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

TEST(FvdctlToken, PrintsASecretAndItsLine) {
  const auto outcome = test::run_command({"token", "new", "anna", "set_up"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const auto lines = lines_of(outcome.out);
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_EQ(lines[1], credential_of("anna", Role::kSetUp, lines[0]).line());
  EXPECT_THAT(outcome.err, HasSubstr("rpc.token_file"));
  EXPECT_NE(test::run_command({"token", "new", "anna", "set_up"}).out, outcome.out);
  EXPECT_EQ(test::run_command({"token", "new", "anna", "boss"}).code, 64);
  EXPECT_EQ(test::run_command({"token", "new", "anna"}).code, 64);
  const auto no_name = test::run_command({"token", "new", "an na", "view"});
  EXPECT_NE(no_name.code, 0);
  EXPECT_THAT(no_name.err, HasSubstr("is no name"));
}

TEST(FvdctlKioskUrl, HasATokenThatMayOperateBehindTheFragmentsSign) {
  const auto outcome = test::run_command({"kiosk-url", "http://microscope-3/", "kiosk-3"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const auto lines = lines_of(outcome.out);
  ASSERT_EQ(lines.size(), 2U);
  ASSERT_THAT(lines[0], StartsWith("http://microscope-3/#token=fvd-"));
  EXPECT_EQ(lines[1], credential_of("kiosk-3", Role::kOperate, lines[0].substr(lines[0].find("=") + 1)).line());
  for (const char* page : {"microscope-3", "ftp://microscope-3/", "http://microscope-3/#x", "http://micro scope/"}) {
    EXPECT_NE(test::run_command({"kiosk-url", page, "kiosk-3"}).code, 0) << page;
  }
}

class FvdctlByEachWay : public ::testing::Test {
 protected:
  FvdctlByEachWay() {
    RpcConfig config;
    config.port = 0;
    config.access.token_file = folder_ / "tokens";
    const std::string token = new_token();
    test::write_text(folder_ / "tokens", credential_of("kiosk", Role::kOperate, token).line() + "\n");
    test::write_text(folder_ / "secret", token + "\n");
    service_.access.emplace(config.access);
    rpc_ = std::make_unique<RpcServer>(config, folder_.path(), service_.services());
    HttpConfig http;
    http.port = 0;
    http_ = std::make_unique<HttpServer>(http, service_.services());
    tcp_address_ = "127.0.0.1:" + std::to_string(rpc_->port());
    http_address_ = "http://127.0.0.1:" + std::to_string(http_->port());
  }
  static test::Outcome run(std::vector<std::string> way, const std::vector<std::string>& command) {
    way.insert(way.end(), command.begin(), command.end());
    return test::run_command(way);
  }
  [[nodiscard]] std::vector<std::string> by_socket() const { return {"--runtime-dir", folder_.path().string()}; }
  [[nodiscard]] std::vector<std::string> by_http() const { return {"--address", http_address_}; }
  [[nodiscard]] std::vector<std::string> with_token(std::vector<std::string> way) const {
    way.insert(way.end(), {"--token-file", (folder_ / "secret").string()});
    return way;
  }

  test::ScratchDir folder_;
  FakeJobService service_;
  std::unique_ptr<RpcServer> rpc_;
  std::unique_ptr<HttpServer> http_;
  std::string tcp_address_;
  std::string http_address_;
};

TEST_F(FvdctlByEachWay, IsRecognised) {
  const std::vector<std::string> who{"rpc", "session.info"};
  EXPECT_THAT(run(by_socket(), who).out, HasSubstr("\"administer\"")) << "the socket comes before the port";
  EXPECT_THAT(run({"--address", tcp_address_}, who).out, HasSubstr("\"operate\""));
  EXPECT_THAT(run(by_http(), who).out, HasSubstr("\"view\""));
  EXPECT_THAT(run(with_token(by_http()), who).out, HasSubstr("\"token kiosk\""));
  EXPECT_THAT(run(with_token({"--address", tcp_address_}), who).out, HasSubstr("\"token kiosk\""));
  ASSERT_EQ(::setenv("FVD_TOKEN_FILE", (folder_ / "secret").c_str(), 1), 0);
  EXPECT_THAT(run(by_http(), who).out, HasSubstr("\"token kiosk\""));
  ASSERT_EQ(::unsetenv("FVD_TOKEN_FILE"), 0);
}

TEST_F(FvdctlByEachWay, StopsAndTellsWhoAskedForWhat) {
  for (const auto& way : {by_socket(), {"--address", tcp_address_}, with_token(by_http())}) {
    const auto stopped = run(way, {"stop"});
    EXPECT_EQ(stopped.code, 0) << stopped.err;
    EXPECT_EQ(stopped.out, "stopped: command\n");
  }
  EXPECT_EQ(service_.stops, 3);
  const auto audit = run(by_http(), {"audit"});
  EXPECT_EQ(audit.code, 0) << audit.err;
  const auto lines = lines_of(audit.out);
  ASSERT_EQ(lines.size(), 3U);
  EXPECT_THAT(lines[0], ContainsRegex("stage.stop  ok  token kiosk, .*operate, http 127.0.0.1:"));
  EXPECT_THAT(lines[1], HasSubstr("stage.stop  ok  address 127.0.0.1"));
  EXPECT_THAT(lines[2], HasSubstr("administer, process "));
  EXPECT_EQ(lines_of(run(by_http(), {"audit", "--most", "1"}).out).size(), 1U);
  EXPECT_THAT(run(by_http(), {"audit", "--json"}).out, HasSubstr("\"entries\""));
}

TEST_F(FvdctlByEachWay, AwaitsAFreshLookThatShowsStandstill) {
  service_.unseen_looks = 3;  // of the stop, and two after it, whatever part_release says
  const auto stopped = run(by_socket(), {"stop"});
  EXPECT_EQ(stopped.code, 0) << stopped.err;
  EXPECT_EQ(service_.unseen_looks, 0);
  EXPECT_EQ(service_.stops, 1);
}

TEST_F(FvdctlByEachWay, SaysWhereAStopDidNotBringStandstill) {
  MachineStatus lost;
  lost.state = ScanState::kError;
  lost.error = ErrorCode::kStageDisconnected;
  service_.machine = lost;
  const auto stopped = run(by_socket(), {"stop"});
  EXPECT_EQ(stopped.code, 69);
  EXPECT_EQ(stopped.out, "stopped: command\n");
  EXPECT_THAT(stopped.err, AllOf(HasSubstr("NOT confirmed"), HasSubstr("emergency stop")));
}

TEST_F(FvdctlByEachWay, SaysWhyHttpRefuses) {
  const auto refused = run(by_http(), {"stop"});
  EXPECT_EQ(refused.code, 65);
  EXPECT_EQ(refused.out, "") << "nothing was stopped";
  EXPECT_THAT(refused.err, HasSubstr("needs the role operate"));
  test::write_text(folder_ / "secret", "fvd-unknown\n");
  const auto by_tcp = run(with_token({"--address", tcp_address_}), {"stop"});
  EXPECT_THAT(by_tcp.err, HasSubstr("nobody has this token"));
  const auto unknown = run(with_token(by_http()), {"stop"});
  EXPECT_THAT(unknown.err, AllOf(HasSubstr("401"), HasSubstr("nobody has this token")));
  EXPECT_EQ(unknown.code, 65);
  EXPECT_EQ(by_tcp.code, unknown.code);
  const auto by_lines = run({"--address", http_address_.substr(std::string("http://").size())}, {"state"});
  EXPECT_THAT(by_lines.err, AllOf(HasSubstr("answers in HTTP"), HasSubstr("--address " + http_address_)));
  EXPECT_EQ(by_lines.code, 65);
  EXPECT_THAT(run({"--address", "http://" + tcp_address_}, {"state"}).err, HasSubstr("does not answer in HTTP"));
  EXPECT_EQ(service_.stops, 0);
}

/// A unix socket where everybody has the role view: for the daemon's own user no real one is like that.
class SocketOfViewers {
 public:
  explicit SocketOfViewers(const std::filesystem::path& file) : socket_(file), listener_(socket_.take_listener()) {
    thread_ = std::jthread([this](const std::stop_token& stop) {
      while (!stop.stop_requested()) serve_one();
    });
  }

 private:
  static bool readable(int fd, int within_ms) {
    pollfd entry{fd, POLLIN, 0};
    return ::poll(&entry, 1, within_ms) > 0;
  }
  void serve_one() const {
    if (!readable(listener_.get(), 20)) return;
    const UniqueFd client(::accept4(listener_.get(), nullptr, nullptr, SOCK_CLOEXEC));
    char request[4096];
    const ssize_t size = readable(client.get(), 5000) ? ::recv(client.get(), request, sizeof request, 0) : 0;
    if (size <= 0) return;
    const bool asks_who =
        std::string_view(request, static_cast<std::size_t>(size)).find("session.info") != std::string_view::npos;
    const std::string reply = asks_who ? R"({"jsonrpc":"2.0","id":1,"result":{"who":"uid 1","role":"view"}})"
                                       : R"({"jsonrpc":"2.0","id":1,"error":{"code":1004,"message":"not you"}})";
    (void)::send(client.get(), (reply + "\n").data(), reply.size() + 1, MSG_NOSIGNAL);
  }

  UnixSocket socket_;
  UniqueFd listener_;
  std::jthread thread_;  // last
};

TEST_F(FvdctlByEachWay, NamesThePortWhereItGivesMoreThanTheSocket) {
  const std::filesystem::path folder = folder_ / "viewers";
  const SocketOfViewers viewers(folder / "v.sock");
  const auto write_port = [&](int port) {
    const nlohmann::json ways{{"address", "127.0.0.1"}, {"port", port}, {"socket", (folder / "v.sock").string()}};
    test::write_text(folder / "rpc.json", ways.dump());
  };
  const std::vector<std::string> way{"--runtime-dir", folder.string()};
  write_port(rpc_->port());
  EXPECT_THAT(run(way, {"stop"}).err, AllOf(HasSubstr("not you"), HasSubstr("or --address " + tcp_address_)));
  write_port(http_->port());  // nobody there answers by lines
  EXPECT_THAT(run(way, {"stop"}).err, AllOf(HasSubstr("not you"), Not(HasSubstr("--address"))));
  const auto by_port = run({"--address", tcp_address_}, {"rpc", "stage.move", R"({"z_um": 1})"});
  EXPECT_THAT(by_port.err, AllOf(HasSubstr("stage.move needs"), Not(HasSubstr("--address"))));
}

}  // namespace
}  // namespace fvd::ctl
