#include "daemon/metrics/metrics_server.hpp"

#include <memory>
#include <vector>

#include <gmock/gmock.h>

#include "core/base/error.hpp"
#include "tests/daemon/metrics/fixed_machine.hpp"
#include "tests/support/expect_error.hpp"
#include "tests/support/line_client.hpp"

namespace fvd {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

class AMetricsServer : public ::testing::Test {
 protected:
  /// All that comes until the server closes the connection.
  std::string ask(const std::string& request) {
    LineClient client(server_.port());
    client.send(request);
    std::string all;
    while (const auto line = client.line()) all += *line + "\n";
    return all;
  }
  std::string get(const std::string& target, const std::string& method = "GET") {
    return ask(method + " " + target + " HTTP/1.1\r\nHost: localhost\r\n\r\n");
  }
  test::FixedMachine machine_;
  MetricsServer server_{"127.0.0.1", 0, machine_};
};

TEST_F(AMetricsServer, GivesMetrics) {
  machine_.status.epoch = 17;
  const std::string reply = get("/metrics");
  EXPECT_THAT(reply, StartsWith("HTTP/1.1 200 OK\r\n"));
  EXPECT_THAT(reply, HasSubstr("Content-Type: text/plain; version=0.0.4"));
  EXPECT_THAT(reply, HasSubstr("\nfvd_epoch 17\n"));
}

TEST_F(AMetricsServer, TellsWhetherTheMachineIsWell) {
  EXPECT_THAT(get("/healthz"), StartsWith("HTTP/1.1 503 "));
  machine_.status.state = ScanState::kReady;
  const std::string reply = get("/healthz");
  EXPECT_THAT(reply, StartsWith("HTTP/1.1 200 "));
  EXPECT_THAT(reply, HasSubstr("\r\n\r\nok\n"));
}

TEST_F(AMetricsServer, LeavesTheBodyOutForHead) {
  const std::string reply = get("/healthz", "HEAD");
  EXPECT_THAT(reply, StartsWith("HTTP/1.1 503 "));
  EXPECT_THAT(reply, ::testing::EndsWith("\r\n\r\n"));
}

TEST_F(AMetricsServer, RefusesWhatItDoesNotHave) {
  EXPECT_THAT(get("/"), StartsWith("HTTP/1.1 404 "));
  EXPECT_THAT(get("/metrics/../etc/passwd"), StartsWith("HTTP/1.1 404 "));
  EXPECT_THAT(get("/metrics", "POST"), StartsWith("HTTP/1.1 405 "));
  EXPECT_THAT(get("/metrics", "DELETE"), StartsWith("HTTP/1.1 405 "));
}

TEST_F(AMetricsServer, SurvivesWhatIsNoHttp) {
  EXPECT_EQ(ask("{\"jsonrpc\":\"2.0\"}\r\n\r\n"), "");
  EXPECT_EQ(ask("GET /metrics HTTP/1.1\r\nX: " + std::string(20000, 'x') + "\r\n\r\n"), "");
  EXPECT_EQ(ask(std::string(64, '\0') + "\r\n\r\n"), "");
  EXPECT_THAT(get("/metrics"), StartsWith("HTTP/1.1 200 OK"));
}

TEST_F(AMetricsServer, ServesOthersBesideConnectionsThatSayNothing) {
  const auto answers = [this] { return !get("/healthz").empty(); };
  {
    std::vector<std::unique_ptr<LineClient>> silent;
    for (int i = 0; i < 7; ++i) silent.push_back(std::make_unique<LineClient>(server_.port()));
    EXPECT_TRUE(answers());
    for (int i = 0; i < 4; ++i) silent.push_back(std::make_unique<LineClient>(server_.port()));
    EXPECT_TRUE(silent.back()->closes()) << "one more than 8 is closed at once";
  }
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  while (!answers() && std::chrono::steady_clock::now() < deadline) {
  }
  EXPECT_TRUE(answers()) << "once they are gone there is room";
}

TEST_F(AMetricsServer, RefusesAPortThatIsTaken) {
  test::expect_error(ErrorCode::kNotReady, {"cannot listen on 127.0.0.1", "/metrics/port"},
                     [this] { const MetricsServer other("127.0.0.1", server_.port(), machine_); });
}

}  // namespace
}  // namespace fvd
