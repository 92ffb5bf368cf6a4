/// GET /api/v1/events: streams, and how many of them; the last part with real sockets on loopback.

#include "daemon/events/event_resource.hpp"

#include <chrono>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "daemon/transport/http_server.hpp"
#include "tests/daemon/events/changing_machine.hpp"
#include "tests/support/http_client.hpp"

namespace fvd {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

class AnEventResource : public ::testing::Test {
 protected:
  ResourceAnswer get(const std::string& address, const std::string& path = EventResource::kPath,
                     bool has_token = false) {
    ResourceRequest request;
    request.path = path;
    request.address = address;
    request.has_token = has_token;
    return resource_.get(request);
  }
  ResourceAnswer get_with_token(const std::string& address) { return get(address, EventResource::kPath, true); }
  test::ChangingMachine machine_;
  FakeJobService service_;
  const Services services_ = machine_.in(service_.services());
  EventHub hub_{services_};
  EventResource resource_{hub_};
};

TEST_F(AnEventResource, GivesAStream) {
  const ResourceAnswer answer = get("10.0.0.1");
  EXPECT_EQ(answer.status, 200);
  ASSERT_TRUE(answer.stream);
  EXPECT_EQ(answer.fields.front(), (std::pair<std::string, std::string>{"Content-Type", "text/event-stream"}));
  EXPECT_THAT(answer.stream->next(), HasSubstr("event: snapshot\n"));
  EXPECT_EQ(answer.stream->next(), "");
  EXPECT_EQ(answer.stream->ping(), "event: ping\ndata: {}\n\n");
  EXPECT_EQ(answer.stream->ping_period(), std::chrono::seconds(15));
  EXPECT_TRUE(resource_.needs_view());
}

TEST_F(AnEventResource, OpensNothingForAHeader) {
  ResourceRequest request;
  request.path = EventResource::kPath;
  request.is_head = true;
  for (std::size_t i = 0; i < 2 * EventResource::kMostOfAddress; ++i) {
    const ResourceAnswer answer = resource_.get(request);
    EXPECT_EQ(answer.status, 200);
    EXPECT_FALSE(answer.stream);
    EXPECT_TRUE(answer.is_endless);
  }
}

TEST_F(AnEventResource, HasNothingBelowItsPath) {
  const ResourceAnswer answer = get("10.0.0.1", "/api/v1/events/all");
  EXPECT_EQ(answer.status, 404);
  EXPECT_FALSE(answer.stream);
}

TEST_F(AnEventResource, LimitsStreamsOfAnAddress) {
  std::vector<ResourceAnswer> open;
  for (std::size_t i = 0; i < EventResource::kMostOfAddress; ++i) open.push_back(get("10.0.0.1"));
  for (const ResourceAnswer& answer : open) EXPECT_TRUE(answer.stream);
  const ResourceAnswer refused = get("10.0.0.1");
  EXPECT_EQ(refused.status, 503);
  EXPECT_FALSE(refused.stream);
  EXPECT_EQ(json::parse(refused.body)["error"], "too_many_streams");
  EXPECT_TRUE(get("10.0.0.2").stream) << "another one";
  open.pop_back();
  EXPECT_TRUE(get("10.0.0.1").stream) << "one was closed";
}

TEST_F(AnEventResource, LimitsStreamsOfAll) {
  std::vector<ResourceAnswer> open;
  for (std::size_t i = 0; i < EventResource::kMost; ++i) {
    open.push_back(get_with_token("10.0.0." + std::to_string(i / EventResource::kMostOfAddress)));
    EXPECT_TRUE(open.back().stream) << i;
  }
  EXPECT_EQ(get_with_token("10.0.0.99").status, 503);
  open.clear();
  EXPECT_TRUE(get("10.0.0.99").stream);
}

TEST_F(AnEventResource, KeepsPlacesForCallersWithAToken) {
  std::vector<ResourceAnswer> open;
  for (std::size_t i = 0; i < EventResource::kMostWithoutToken; ++i) {
    open.push_back(get("10.0.0." + std::to_string(i / EventResource::kMostOfAddress)));
    EXPECT_TRUE(open.back().stream) << i;
  }
  EXPECT_EQ(get("10.0.0.99").status, 503);
  for (std::size_t i = EventResource::kMostWithoutToken; i < EventResource::kMost; ++i) {
    open.push_back(get_with_token("10.0.1.1"));
    EXPECT_TRUE(open.back().stream) << i;
  }
  EXPECT_EQ(get_with_token("10.0.1.2").status, 503);
  open.pop_back();
  EXPECT_EQ(get("10.0.0.99").status, 503) << "that place is none for it";
  open.erase(open.begin());
  EXPECT_TRUE(get("10.0.0.99").stream);
}

class AServerOfEvents : public AnEventResource {
 protected:
  AServerOfEvents() {
    HttpConfig config;
    config.port = 0;
    server_ = std::make_unique<HttpServer>(config, services_,
                                           std::vector<MountedResource>{{EventResource::kPath, &resource_}});
  }
  /// A reader whose header was read; the status.
  int open(HttpClient& reader, const std::string& more = "") {
    reader.send(reader.get_request(EventResource::kPath, more));
    return reader.head_reply().value_or(HttpReply{}).status;
  }
  /// The lines of the next event.
  static std::vector<std::string> event(HttpClient& reader) {
    std::vector<std::string> lines;
    for (auto line = reader.line(); line && !line->empty(); line = reader.line()) lines.push_back(*line);
    return lines;
  }
  std::unique_ptr<HttpServer> server_;
};

TEST_F(AServerOfEvents, TellsAPageWhatHappens) {
  HttpClient page(server_->port());
  ASSERT_EQ(open(page), 200);
  EXPECT_EQ(event(page), std::vector<std::string>{"retry: 2000"});
  auto lines = event(page);
  ASSERT_EQ(lines.size(), 3U);
  EXPECT_EQ(lines[0], "id: 17-0");
  EXPECT_EQ(lines[1], "event: snapshot");
  machine_.change([](MachineStatus& status) { status.state = ScanState::kExecuting; });
  lines = event(page);
  ASSERT_EQ(lines.size(), 3U);
  EXPECT_EQ(lines[0], "id: 17-1");
  EXPECT_EQ(lines[1], "event: state");
  EXPECT_EQ(json::parse(lines[2].substr(6))["state"], "executing");
}

TEST_F(AServerOfEvents, SaysNoLengthWhereThereIsNone) {
  HttpClient page(server_->port());
  const auto head = page.head(EventResource::kPath);
  ASSERT_TRUE(head);
  EXPECT_EQ(head->status, 200);
  EXPECT_EQ(head->fields.at("content-type"), "text/event-stream");
  EXPECT_EQ(head->fields.count("content-length"), 0U);
  EXPECT_EQ(page.head(EventResource::kPath).value_or(HttpReply{}).status, 200) << "the connection goes on";
}

TEST_F(AServerOfEvents, GoesOnAfterAReconnection) {
  {
    HttpClient page(server_->port());
    ASSERT_EQ(open(page), 200);
    machine_.change([](MachineStatus& status) { status.recipe = "a"; });
    for (auto lines = event(page); lines.empty() || lines.front() != "id: 17-1"; lines = event(page)) {
    }
  }
  machine_.change([](MachineStatus& status) { status.recipe = "b"; });
  HttpClient page(server_->port());
  ASSERT_EQ(open(page, "Last-Event-ID: 17-1\r\n"), 200);
  (void)event(page);  // retry
  const auto lines = event(page);
  ASSERT_EQ(lines.size(), 3U);
  EXPECT_EQ(lines[0], "id: 17-2");
  EXPECT_EQ(json::parse(lines[2].substr(6))["recipe"], "b");
}

TEST_F(AServerOfEvents, GivesPlacesBack) {
  for (int round = 0; round < 3; ++round) {
    std::vector<std::unique_ptr<HttpClient>> pages;
    for (std::size_t i = 0; i < EventResource::kMostOfAddress; ++i) {
      pages.push_back(std::make_unique<HttpClient>(server_->port()));
      // The places of the round before are free once its ends were seen.
      const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(15);
      while (open(*pages.back()) != 200) {
        ASSERT_LT(std::chrono::steady_clock::now(), deadline);
        pages.back() = std::make_unique<HttpClient>(server_->port());
      }
    }
    HttpClient one(server_->port());
    EXPECT_EQ(one.get(EventResource::kPath).value_or(HttpReply{}).status, 503);
  }
}

}  // namespace
}  // namespace fvd
