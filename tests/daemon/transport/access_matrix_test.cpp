/// Who may call what, by every way in: caller x method x transport against the servers themselves, and what a web page
/// can send to either port.

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iostream>
#include <map>
#include <memory>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

#include "daemon/access/token_file.hpp"
#include "daemon/transport/http_server.hpp"
#include "daemon/transport/rpc_server.hpp"
#include "tests/daemon/api/fake_job_service.hpp"
#include "tests/daemon/api/working_params.hpp"
#include "tests/support/http_client.hpp"
#include "tests/support/line_client.hpp"
#include "tests/support/scratch_dir.hpp"

namespace fvd {
namespace {

using nlohmann::json;

constexpr int kNotAllowed = 1004;

std::string request_of(const std::string& method, const json& params) {
  return json{{"jsonrpc", "2.0"}, {"id", 1}, {"method", method}, {"params", params}}.dump();
}

/// Everything that calls have changed so far.
struct Effects {
  explicit Effects(const FakeJobService& service)
      : motions(service.motions.size()),
        jogs(service.jogs.size()),
        calls(service.starts + service.stops + service.aborts),
        studies(service.studies.begun.has_value()),
        constants(service.studies.accepted.has_value()),
        saved(service.recipes.saved.id),
        restored(service.recipes.restored),
        confirmed(service.objectives.confirmed.has_value()),
        controlled(service.control.holder().has_value()),
        acknowledged(service.alarms.newest().front().acknowledged) {}
  bool operator==(const Effects&) const = default;

  std::size_t motions;
  std::size_t jogs;
  int calls;
  bool studies;
  bool constants;
  std::string saved;
  std::int64_t restored;
  bool confirmed;
  bool controlled;
  bool acknowledged;
};

class AnAccessMatrix : public ::testing::Test {
 protected:
  /// Sends a request by some way; true if it was executed, whatever came of it.
  using Send = std::function<bool(const std::string& request)>;

  AnAccessMatrix() {
    spdlog::set_level(spdlog::level::err);  // each refusal is a line
    // What is accepted is answered at once, without devices.
    service_.refuse_tasks = true;
    service_.studies.busy = true;
    RpcConfig config;
    config.port = 0;
    config.max_connections = 100;
    config.access.loopback_role = Role::kNone;
    config.access.token_file = folder_ / "tokens";
    std::string lines;
    for (const Role role : kGivenRoles) {
      tokens_[role] = new_token();
      lines += credential_of(std::string(role_name(role)), role, tokens_[role]).line() + "\n";
    }
    test::write_text(folder_ / "tokens", lines);
    service_.access.emplace(config.access);
    rpc_ = std::make_unique<RpcServer>(config, folder_.path(), service_.services());
    HttpConfig http;
    http.port = 0;
    http_ = std::make_unique<HttpServer>(http, service_.services());
    learn_methods();
  }

  /// As the daemon describes them.
  void learn_methods() {
    LineClient client(rpc_->port());
    log_in(client, Role::kView);
    const json reply = json::parse(client.ask(request_of("rpc.discover", json::object())));
    for (const json& method : reply["result"]["methods"]) {
      const auto role = method["x-role"].get<std::string>();
      methods_[method["name"].get<std::string>()] = role_from_name(role).value_or(Role::kNone);
    }
  }

  void log_in(LineClient& client, Role role) {
    if (role == Role::kNone) return;
    const std::string reply = client.ask(request_of("session.login", {{"token", tokens_.at(role)}}));
    ASSERT_EQ(json::parse(reply)["result"]["role"], role_name(role)) << reply;
  }

  static bool is_executed(const std::string& reply) {
    const json answer = json::parse(reply, nullptr, false);
    if (answer.is_discarded()) return false;
    const int code = answer.value("/error/code"_json_pointer, 0);
    return code != kNotAllowed && code != -32600;
  }

  /// may: the role of the caller; none where nothing may be accepted at all.
  void try_all(const std::string& way, std::optional<Role> may, const Send& send) {
    // What is to be refused comes first: then nothing may have changed.
    const Effects before(service_);
    for (const bool allowed : {false, true}) {
      for (const auto& [method, least] : methods_) {
        // It is how a caller gets his role, not what he may do with it.
        if (method == "session.login" || allowed != (may && *may >= least)) continue;
        ++cases_;
        const bool executed = send(request_of(method, test::working_params(method)));
        EXPECT_EQ(executed, allowed) << method << " by " << way;
        if (executed && !allowed) ++unauthorised_accepted_;
      }
      if (allowed || Effects(service_) == before) continue;
      ++unauthorised_accepted_;
      ADD_FAILURE() << "something that was refused was done: " << way;
    }
  }

  /// The answers wait ever longer, so the first of them alone are awaited.
  void try_unknown_token() {
    const Effects before(service_);
    std::vector<std::unique_ptr<HttpClient>> clients;
    for (const auto& [method, least] : methods_) {
      clients.push_back(std::make_unique<HttpClient>(http_->port()));
      const std::string request = request_of(method, test::working_params(method));
      clients.back()->send(clients.back()->request(request, "Authorization: Bearer fvd-unknown\r\n"));
      if (clients.size() > 3) continue;
      ++cases_;
      EXPECT_EQ(clients.back()->reply().value_or(HttpReply{}).status, 401) << method;
    }
    // Tokens are looked up in turn: that of the others has been.
    EXPECT_TRUE(by_http(bearer(Role::kView))(request_of("system.state", json::object())));
    http_.reset();
    EXPECT_EQ(Effects(service_), before);
    if (Effects(service_) != before) ++unauthorised_accepted_;
  }

  Send by_line(LineClient& client) {
    return [&client](const std::string& request) { return is_executed(client.ask(request)); };
  }
  /// more: lines of the header. Each request has a connection of its own, for a refusal ends it.
  Send by_http(const std::string& more, const std::string& type = "application/json", const std::string& host = {}) {
    return [this, more, type, host](const std::string& request) {
      HttpClient client(http_->port());
      const std::string name = host.empty() ? "127.0.0.1:" + std::to_string(http_->port()) : host;
      client.send("POST /api/jsonrpc HTTP/1.1\r\nHost: " + name + "\r\nContent-Type: " + type +
                  "\r\nContent-Length: " + std::to_string(request.size()) + "\r\n" + more + "\r\n" + request);
      const auto reply = client.reply();
      return reply && reply->status == 200 && is_executed(reply->body);
    };
  }
  [[nodiscard]] std::string bearer(Role role) const {
    return role == Role::kNone ? "" : "Authorization: Bearer " + tokens_.at(role) + "\r\n";
  }

  test::ScratchDir folder_;
  FakeJobService service_;
  std::map<Role, std::string> tokens_;
  std::unique_ptr<RpcServer> rpc_;
  std::unique_ptr<HttpServer> http_;
  std::map<std::string, Role> methods_;
  int cases_ = 0;
  int unauthorised_accepted_ = 0;
};

TEST_F(AnAccessMatrix, AcceptsWhatRolesSayAndNothingElse) {
  ASSERT_GT(methods_.size(), 50U);
  for (const Role role : {Role::kNone, Role::kView, Role::kOperate, Role::kSetUp, Role::kAdminister}) {
    const std::string who(role_name(role));
    LineClient tcp(rpc_->port());
    log_in(tcp, role);
    try_all("tcp, " + who, role, by_line(tcp));
    // The kernel says that the process is the daemon's own user, so nobody is nobody there.
    if (role != Role::kNone) {
      LineClient local(folder_ / "fvd.sock");
      log_in(local, role);
      try_all("unix, " + who, role, by_line(local));
    }
    try_all("http, " + who, role, by_http(bearer(role)));
    const std::string own = "http://127.0.0.1:" + std::to_string(http_->port());
    try_all("http of its own page, " + who, role,
            by_http(bearer(role) + "Origin: " + own + "\r\nSec-Fetch-Site: same-origin\r\n"));
    // As a web page sends it, even one that knows a token.
    try_all("page elsewhere, " + who, std::nullopt, by_http(bearer(role) + "Origin: http://evil.example\r\n"));
    try_all("sandboxed page, " + who, std::nullopt, by_http(bearer(role) + "Origin: null\r\n"));
    try_all("page of another port, " + who, std::nullopt, by_http(bearer(role) + "Origin: http://127.0.0.1:1\r\n"));
    try_all("page without origin, " + who, std::nullopt, by_http(bearer(role) + "Sec-Fetch-Site: cross-site\r\n"));
    try_all("form, " + who, std::nullopt, by_http(bearer(role), "text/plain"));
    try_all("form, " + who, std::nullopt, by_http(bearer(role), "application/x-www-form-urlencoded"));
    try_all("name that is rebound, " + who, std::nullopt, by_http(bearer(role), "application/json", "evil.example"));
  }
  try_unknown_token();
  const json figures{{"unauthorised_accepted", unauthorised_accepted_}, {"matrix_cases", cases_}};
  std::cout << "matrix: " << figures.dump() << '\n';
  if (const char* file = std::getenv("FVD_MATRIX_FILE")) std::ofstream(file) << figures.dump() << '\n';
}

TEST_F(AnAccessMatrix, TakesNoHttpOnTheLineProtocolsPort) {
  rpc_.reset();
  RpcConfig config;
  config.port = 0;
  config.access.loopback_role = Role::kAdminister;
  service_.access.emplace(config.access);
  rpc_ = std::make_unique<RpcServer>(config, folder_.path(), service_.services());
  for (const std::string begin :
       {"POST / HTTP/1.1\r\n", "GET / HTTP/1.1\r\nUpgrade: websocket\r\n", "\x16\x03\x01\n"}) {
    try_all("http to the line protocol", std::nullopt, [&](const std::string& request) {
      LineClient client(rpc_->port());
      client.send(begin + "Content-Type: text/plain\r\n\r\n" + request + "\r\n");
      bool executed = false;
      while (const auto line = client.line()) executed = executed || is_executed(*line);
      return executed;
    });
  }
}

}  // namespace
}  // namespace fvd
