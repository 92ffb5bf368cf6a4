/// Bodies that are made while they are sent, answers that come later, and streams.

#include <atomic>
#include <chrono>
#include <future>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "core/base/error.hpp"
#include "tests/daemon/transport/resource_server.hpp"
#include "tests/support/captured_log.hpp"
#include "tests/support/rpc_text.hpp"

namespace fvd {
namespace {

using test::comes;
using test::FakeBody;
using test::FakeResource;
using test::FakeStream;
using test::text_answer;
using ::testing::HasSubstr;

class AServerOfBodies : public test::ResourceServer {};

TEST_F(AServerOfBodies, SendsLongBodiesPieceByPiece) {
  static constexpr std::size_t kPiece_bytes = 200'000;
  static constexpr int kPieces = 60;
  serve([this](const ResourceRequest&) {
    ResourceAnswer answer;
    answer.source = std::make_unique<FakeBody>(bodies_, kPiece_bytes, kPieces);
    answer.source_bytes = kPiece_bytes * kPieces;
    return answer;
  });
  HttpClient one(server_->port());
  one.send(one.get_request("/long"));
  const auto head = one.head_reply();
  ASSERT_TRUE(head);
  EXPECT_EQ(head->fields.at("content-length"), std::to_string(kPiece_bytes * kPieces));
  EXPECT_LT(bodies_.made, kPieces) << "nobody has read it yet";
  EXPECT_EQ(get("/other").fields["content-length"], std::to_string(kPiece_bytes * kPieces)) << "others are answered";
  for (int i = 0; i < kPieces; ++i) {
    ASSERT_EQ(one.body_bytes(kPiece_bytes), std::string(kPiece_bytes, static_cast<char>('a' + i % 26))) << i;
  }
  EXPECT_EQ(one.call(test::call("system.ping")).value_or(HttpReply{}).status, 200) << "the connection is kept";
  EXPECT_TRUE(comes([this] { return bodies_.alive == 0; }));
}

TEST_F(AServerOfBodies, ClosesWhereABodyEndsInItsMiddle) {
  const test::CapturedLog log;
  serve([this](const ResourceRequest& request) {
    class Broken final : public BodySource {
      std::string next() override { throw Error(ErrorCode::kStorageWrite, "the disk is gone"); }
    };
    ResourceAnswer answer;
    if (request.path == "/broken") {
      answer.source = std::make_unique<Broken>();
    } else {
      answer.source = std::make_unique<FakeBody>(bodies_, 10, request.path == "/short" ? 1 : 20);
    }
    answer.source_bytes = 100;
    return answer;
  });
  for (const char* target : {"/broken", "/short"}) {
    HttpClient one(server_->port());
    one.send(one.get_request(target));
    ASSERT_TRUE(one.head_reply()) << target;
    EXPECT_FALSE(one.body_bytes(100)) << target;
    EXPECT_TRUE(one.closes()) << target;
  }
  HttpClient one(server_->port());
  one.send(one.get_request("/longer"));
  ASSERT_TRUE(one.head_reply());
  EXPECT_TRUE(one.body_bytes(100));
  EXPECT_TRUE(one.call(test::call("system.ping"))) << "what was said to be its length is sent, and nothing more";
  server_.reset();
  EXPECT_EQ(bodies_.alive, 0);
  EXPECT_THAT(log.text(), HasSubstr("the disk is gone"));
}

TEST_F(AServerOfBodies, AsksAgainUntilThereIsAnAnswer) {
  FakeResource& resource = serve([](const ResourceRequest& request) {
    ResourceAnswer answer = text_answer("waited");
    if (request.path == "/later" && request.waited < std::chrono::milliseconds(50)) {
      answer.again_after = std::chrono::milliseconds(10);
    }
    if (request.path == "/204") {
      answer = {};
      answer.status = 204;
    }
    return answer;
  });
  HttpClient one(server_->port());
  EXPECT_EQ(one.get("/later").value_or(HttpReply{}).body, "waited");
  EXPECT_GT(resource.asked, 1);
  const auto nothing = one.get("/204");
  ASSERT_TRUE(nothing);
  EXPECT_EQ(nothing->status, 204);
  EXPECT_EQ(nothing->fields.count("content-length"), 0U);
  EXPECT_EQ(one.get("/later").value_or(HttpReply{}).body, "waited") << "a second wait on the same connection";
}

TEST_F(AServerOfBodies, ForgetsWhoGoesAwayWhileHeWaits) {
  std::atomic<int> asked{0};
  serve([&asked](const ResourceRequest&) {
    ++asked;
    ResourceAnswer answer;
    answer.again_after = std::chrono::hours(1);
    return answer;
  });
  {
    std::vector<std::unique_ptr<HttpClient>> waiting;
    for (int i = 0; i < 32; ++i) {
      waiting.push_back(std::make_unique<HttpClient>(server_->port()));
      waiting.back()->send(waiting.back()->get_request("/"));
    }
    ASSERT_TRUE(comes([&] { return asked == 32; }));
    HttpClient one(server_->port());
    EXPECT_EQ(one.call(test::call("system.ping")).value_or(HttpReply{}).status, 503) << "no place without a token";
  }
  EXPECT_TRUE(comes([this] {
    HttpClient one(server_->port());
    return one.call(test::call("system.ping")).value_or(HttpReply{}).status == 200;
  }));
}

TEST_F(AServerOfBodies, TellsWhoWaitsThatItEnds) {
  FakeResource& resource = serve([](const ResourceRequest&) {
    ResourceAnswer answer;
    answer.again_after = std::chrono::hours(1);
    return answer;
  });
  HttpClient one(server_->port());
  one.send(one.get_request("/"));
  ASSERT_TRUE(comes([&] { return resource.asked == 1; }));
  server_.reset();
  const auto reply = one.reply();
  ASSERT_TRUE(reply);
  EXPECT_EQ(reply->status, 503);
  EXPECT_EQ(nlohmann::json::parse(reply->body)["error"], "shutting_down");
}

TEST_F(AServerOfBodies, TellsWhoWaitsForAWorkerThatItEnds) {
  std::promise<void> begun;
  std::promise<void> released;
  serve([&](const ResourceRequest&) {
    begun.set_value();
    released.get_future().wait();
    return text_answer("too late");
  });
  HttpClient slow(server_->port());
  slow.send(slow.get_request("/slow"));
  begun.get_future().wait();
  std::thread ending([this] { server_.reset(); });
  const HttpReply reply = slow.reply().value_or(HttpReply{});
  released.set_value();
  ending.join();
  EXPECT_EQ(reply.status, 503);
  EXPECT_THAT(reply.body, HasSubstr("shutting_down"));
}

TEST_F(AServerOfBodies, CallsWhileAResourceWorks) {
  std::promise<void> begun;
  std::promise<void> released;
  serve([&](const ResourceRequest& request) {
    if (request.path == "/slow") {
      begun.set_value();
      released.get_future().wait();
    }
    return text_answer("x");
  });
  HttpClient slow(server_->port());
  slow.send(slow.get_request("/slow"));
  begun.get_future().wait();
  HttpClient one(server_->port());
  EXPECT_EQ(one.call(test::call("audit.list")).value_or(HttpReply{}).status, 200) << "what needs a worker too";
  released.set_value();
  EXPECT_EQ(slow.reply().value_or(HttpReply{}).body, "x");
}

class AServerOfStreams : public test::ResourceServer {
 protected:
  AServerOfStreams() {
    serve([this](const ResourceRequest& request) {
      ResourceAnswer answer = text_answer("first\n");
      answer.fields = {{"Content-Type", "text/event-stream"}};
      const bool pings = request.path == "/pings";
      if (!request.is_head) {
        answer.stream =
            std::make_unique<FakeStream>(news_, pings ? std::chrono::milliseconds(1) : std::chrono::hours(1));
      }
      return answer;
    });
  }
  void open(HttpClient& reader, const std::string& target = "/") {
    reader.send(reader.get_request(target));
    const auto head = reader.head_reply();
    ASSERT_TRUE(head);
    EXPECT_EQ(head->status, 200);
    EXPECT_EQ(head->fields.count("content-length"), 0U);
    EXPECT_EQ(head->fields.at("connection"), "close");
    EXPECT_EQ(reader.line(), "first");
  }
};

TEST_F(AServerOfStreams, SendsWhatComes) {
  news_.add("before\n");
  HttpClient one(server_->port());
  HttpClient two(server_->port());
  open(one);
  open(two);
  for (HttpClient* reader : {&one, &two}) EXPECT_EQ(reader->line(), "before");
  for (int i = 0; i < 100; ++i) news_.add("news " + std::to_string(i) + "\n");
  for (HttpClient* reader : {&one, &two}) {
    for (int i = 0; i < 100; ++i) ASSERT_EQ(reader->line(), "news " + std::to_string(i));
  }
}

TEST_F(AServerOfStreams, PingsWhoeverHearsNothing) {
  HttpClient one(server_->port());
  open(one, "/pings");
  for (int i = 0; i < 3; ++i) EXPECT_EQ(one.line(), "ping");
}

TEST_F(AServerOfStreams, NoticesReadersThatGo) {
  {
    HttpClient one(server_->port());
    open(one);
    EXPECT_EQ(news_.readers, 1);
  }
  EXPECT_TRUE(comes([this] { return news_.readers == 0; }));
}

TEST_F(AServerOfStreams, NoticesThatReadersGoWhoSaidMore) {
  {
    HttpClient one(server_->port());
    open(one);
    one.send(std::string(100'000, 'x'));
    news_.add("news\n");
    EXPECT_EQ(one.line(), "news") << "it is no request";
    one.send(one.get_request("/"));
  }
  EXPECT_TRUE(comes([this] { return news_.readers == 0; }));
}

TEST_F(AServerOfStreams, ClosesReadersThatTalkOn) {
  HttpClient one(server_->port());
  open(one);
  const std::string more(std::size_t{1} << 16U, 'x');
  int sent = 0;
  while (sent < 1000 && one.send(more)) ++sent;
  EXPECT_LT(sent, 1000);
  EXPECT_TRUE(comes([this] { return news_.readers == 0; }));
}

TEST_F(AServerOfStreams, WaitsForNobodyWhoDoesNotRead) {
  HttpClient silent(server_->port());
  HttpClient one(server_->port());
  open(silent);
  open(one);
  const std::string much(std::size_t{1} << 20U, 'x');
  for (int i = 0; i < 32; ++i) {
    news_.add(much + "\n");
    ASSERT_EQ(one.line().value_or("").size(), much.size()) << i;
  }
}

TEST_F(AServerOfStreams, EndsThemWithItself) {
  HttpClient one(server_->port());
  open(one);
  server_.reset();
  EXPECT_TRUE(one.closes());
  EXPECT_EQ(news_.readers, 0);
}

TEST_F(AServerOfStreams, TellsTheHeaderAlone) {
  HttpClient one(server_->port());
  EXPECT_EQ(one.head("/").value_or(HttpReply{}).fields["content-type"], "text/event-stream");
  EXPECT_EQ(news_.readers, 0);
}

}  // namespace
}  // namespace fvd
