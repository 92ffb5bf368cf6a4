#pragma once

/// An HTTP server with a test's own resources, on loopback.

#include <chrono>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "daemon/access/token_file.hpp"
#include "daemon/transport/http_server.hpp"
#include "tests/daemon/api/fake_job_service.hpp"
#include "tests/daemon/transport/fake_resources.hpp"
#include "tests/support/http_client.hpp"
#include "tests/support/scratch_dir.hpp"

namespace fvd::test {

/// Waits for what other threads do. False: it did not come.
template <typename Holds>
bool comes(Holds holds) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(15);
  while (!holds()) {
    if (std::chrono::steady_clock::now() > deadline) return false;
    std::this_thread::yield();
  }
  return true;
}

class ResourceServer : public ::testing::Test {
 protected:
  void serve(std::vector<MountedResource> resources) {
    HttpConfig config;
    config.port = 0;
    service_.access_config.token_file = folder_ / "tokens";
    write_text(folder_ / "tokens", credential_of("kiosk", Role::kView, token_).line() + "\n");
    server_ = std::make_unique<HttpServer>(config, service_.services(), std::move(resources));
  }
  /// One resource for everything.
  FakeResource& serve(FakeResource::Get get, bool needs_view = true) {
    resource_ = std::make_unique<FakeResource>(std::move(get), needs_view);
    serve({{"/", resource_.get()}});
    return *resource_;
  }
  /// The answer to one request on a connection of its own.
  HttpReply get(const std::string& target, const std::string& more = "") {
    HttpClient client(server_->port());
    return client.get(target, more).value_or(HttpReply{});
  }
  /// The status of a whole request.
  int status_of(const std::string& bytes) {
    HttpClient client(server_->port());
    return client.ask(bytes).value_or(HttpReply{}).status;
  }
  [[nodiscard]] std::string bearer() const { return "Authorization: Bearer " + token_ + "\r\n"; }

  ScratchDir folder_;
  const std::string token_ = new_token();
  FakeJobService service_;
  std::unique_ptr<FakeResource> resource_;
  FakeBody::Counts bodies_;
  FakeNews news_;
  std::unique_ptr<HttpServer> server_;  // before what it uses
};

}  // namespace fvd::test
