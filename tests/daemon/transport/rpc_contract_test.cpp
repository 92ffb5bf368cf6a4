/// What a PLC may rely on at its socket: answers while it waits, heartbeats, mistakes that are named, words at the end.

#include <atomic>
#include <chrono>
#include <functional>
#include <future>
#include <memory>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "daemon/transport/rpc_server.hpp"
#include "tests/daemon/api/fake_job_service.hpp"
#include "tests/support/line_client.hpp"
#include "tests/support/rpc_text.hpp"
#include "tests/support/scratch_dir.hpp"

namespace fvd {
namespace {

using nlohmann::json;
using std::chrono::milliseconds;
using testing::HasSubstr;

const std::string kWait = R"({"jsonrpc":"2.0","id":2,"method":"job.wait","params":{"seq":5}})";

const std::string kShortWait = R"({"jsonrpc":"2.0","id":3,"method":"job.wait","params":{"seq":5,"timeout_ms":0}})"
                               "\n";

/// As a client encodes the text that keeps it in two bytes a character.
std::string utf16(const std::string& text, bool little_endian) {
  std::string bytes;
  for (const char c : text) bytes += little_endian ? std::string{c, '\0'} : std::string{'\0', c};
  return bytes;
}

/// With its length in so many bytes before it.
std::string with_length(const std::string& text, int bytes, bool little_endian) {
  std::string all = text;
  for (int i = 0; i < bytes; ++i) {
    const auto digit = static_cast<char>((text.size() >> (8U * static_cast<unsigned>(i))) & 0xFFU);
    all.insert(little_endian ? static_cast<std::size_t>(i) : 0U, 1, digit);
  }
  return all;
}

/// Counts how often somebody looks at the machine.
class CountedMachine final : public MachineView {
 public:
  explicit CountedMachine(FakeJobService& service) : service_(service) {}
  [[nodiscard]] std::shared_ptr<const MachineStatus> snapshot() const override {
    ++looks;
    return service_.snapshot();
  }
  [[nodiscard]] bool stage_stands() const override { return service_.stage_stands(); }
  void on_change(std::function<void()> listener, const void* whose) override {
    service_.on_change(std::move(listener), whose);
  }
  mutable std::atomic<int> looks{0};

 private:
  FakeJobService& service_;
};

class AtItsSocket : public testing::Test {
 protected:
  void serve(int idle_timeout_s = 60, int first_request_s = 5) {
    RpcConfig config;
    config.port = 0;
    config.idle_timeout_s = idle_timeout_s;
    config.first_request_s = first_request_s;
    config.access.loopback_role = Role::kAdminister;
    service_.access.emplace(config.access);
    const Services all = service_.services();
    const Services counted{machine_,    all.jobs,  all.results, all.tasks,    all.recipes, all.objectives, all.studies,
                           all.control, all.audit, all.access,  all.refusals, all.history, all.alarms};
    server_ = std::make_unique<RpcServer>(config, runtime_.path(), counted);
  }
  /// A job of number 5 that runs.
  void start_a_job(LineClient& client) {
    JobStatus running;
    running.job_id = "job-5";
    running.request.seq = 5;
    service_.current = running;
    client.ask(R"({"jsonrpc":"2.0","id":1,"method":"job.start","params":[5,"p"]})");
  }
  /// And a client that waits for it.
  void wait_for_a_job(LineClient& client) {
    start_a_job(client);
    client.send(kWait + "\n");
  }
  /// The error's message of the next line, after which the server closes.
  static std::string last_words(LineClient& client) {
    const auto line = client.line();
    if (!line) return "no line";
    EXPECT_TRUE(client.closes());
    const json answer = json::parse(*line, nullptr, false);
    return answer.contains("error") ? answer["error"]["message"].get<std::string>() : "no error: " + *line;
  }
  std::string refusal_of(const std::string& bytes) {
    LineClient client(server_->port());
    client.send(bytes);
    return last_words(client);
  }

  test::ScratchDir runtime_;
  FakeJobService service_;
  CountedMachine machine_{service_};
  std::unique_ptr<RpcServer> server_;
};

TEST_F(AtItsSocket, AnswersAtOnceWhileTheSameConnectionWaits) {
  serve();
  LineClient client(server_->port());
  wait_for_a_job(client);
  const std::string with_params = R"(","params":{"seq":5}})";
  int id = 10;
  for (const std::string& call :
       {std::string(R"("system.ping"})"), std::string(R"("system.state"})"), std::string(R"("system.info"})"),
        "\"job.status" + with_params, "\"job.abort" + with_params, std::string(R"("stage.stop"})")}) {
    const json answer =
        json::parse(client.ask(R"({"jsonrpc":"2.0","id":)" + std::to_string(++id) + R"(,"method":)" + call));
    EXPECT_EQ(answer["id"], id) << answer;
    EXPECT_TRUE(answer.contains("result")) << answer;
  }
  EXPECT_EQ(service_.aborts, 1);
  EXPECT_EQ(service_.stops, 1);
  service_.current->state = JobState::kAborted;
  service_.change({5}, [](JobStatus& job) { job.state = JobState::kAborted; });
  const auto ended = client.line();
  ASSERT_TRUE(ended.has_value());
  EXPECT_EQ(json::parse(*ended)["id"], 2) << "the wait itself is answered when the job has ended";
}

TEST_F(AtItsSocket, AnswersBehindARequestThatNeedsTheDiskWhileItWaits) {
  serve();
  LineClient client(server_->port());
  wait_for_a_job(client);
  client.send(R"({"jsonrpc":"2.0","id":3,"method":"result.next"})"
              "\n" +
              test::kPing + "\n");
  const auto first = client.line();
  ASSERT_TRUE(first.has_value());
  EXPECT_EQ(json::parse(*first)["id"], 1);
  EXPECT_FALSE(client.line(milliseconds(50)).has_value()) << "the other waits for its turn";
}

TEST_F(AtItsSocket, SaysAtTheEndWhatBecameOfAWait) {
  serve();
  LineClient client(server_->port());
  LineClient other(server_->port());
  wait_for_a_job(client);
  other.send(R"({"jsonrpc":"2.0","id":"home","method":"stage.home"})"
             "\n");
  ASSERT_FALSE(other.line(milliseconds(50)).has_value());
  server_.reset();
  for (const auto& [waiting, id] : {std::pair(&client, json(2)), std::pair(&other, json("home"))}) {
    const auto line = waiting->line();
    ASSERT_TRUE(line.has_value());
    const json answer = json::parse(*line);
    EXPECT_EQ(answer["id"], id);
    EXPECT_EQ(answer["error"]["code"], 1013) << answer;
    EXPECT_EQ(answer["error"]["data"]["retry"], true);
    EXPECT_TRUE(waiting->closes());
  }
}

TEST_F(AtItsSocket, SaysAtTheEndThatItStopsWhereTheDiskIsStuck) {
  std::promise<void> begun;
  std::promise<void> released;
  serve();
  LineClient client(server_->port());
  LineClient starter(server_->port());
  // The snapshot tells nothing of this job: only the worker could.
  client.ask(R"({"jsonrpc":"2.0","id":1,"method":"job.start","params":[5,"p"]})");
  service_.before_start = [&] {
    begun.set_value();
    released.get_future().wait();
  };
  client.send(kWait + "\n");
  ASSERT_FALSE(client.line(milliseconds(100)).has_value());
  starter.send(R"({"jsonrpc":"2.0","id":1,"method":"job.start","params":[6,"p"]})"
               "\n");
  begun.get_future().wait();
  auto ended = std::async(std::launch::async, [this] { server_.reset(); });
  const auto line = client.line();
  released.set_value();
  ended.wait();
  ASSERT_TRUE(line.has_value());
  EXPECT_EQ(json::parse(*line)["error"]["code"], 1013) << *line;
}

TEST_F(AtItsSocket, KeepsAConnectionThatSendsEmptyLines) {
  serve(2);
  LineClient client(server_->port());
  ASSERT_THAT(client.ask(test::kPing), HasSubstr("result"));
  const auto until = std::chrono::steady_clock::now() + milliseconds(2500);
  while (std::chrono::steady_clock::now() < until) {
    client.send("\n");
    EXPECT_FALSE(client.line(milliseconds(20)).has_value()) << "an empty line has no answer";
  }
  EXPECT_THAT(client.ask(test::kPing), HasSubstr("result"));
}

TEST_F(AtItsSocket, NamesUtf16) {
  serve();
  for (const bool little_endian : {true, false}) {
    EXPECT_THAT(refusal_of(utf16(test::kPing + "\r\n", little_endian)), HasSubstr("UTF-16"));
    EXPECT_THAT(refusal_of((little_endian ? "\xff\xfe" : "\xfe\xff") + utf16(test::kPing + "\n", little_endian)),
                HasSubstr("UTF-16"));
  }
}

TEST_F(AtItsSocket, NamesLengthsBeforeTheText) {
  serve();
  for (const int bytes : {2, 4}) {
    for (const bool little_endian : {true, false}) {
      EXPECT_THAT(refusal_of(with_length(test::kPing, bytes, little_endian)), HasSubstr("a length stands before"))
          << bytes << little_endian;
    }
  }
  EXPECT_THAT(refusal_of("47" + test::kPing), HasSubstr("a length stands before"));
  EXPECT_THAT(refusal_of("0047\r\n" + test::kPing), HasSubstr("a length stands before"));
  EXPECT_THAT(refusal_of("Content-Length: 47\r\n\r\n" + test::kPing), HasSubstr("a length stands before"));
  EXPECT_EQ(service_.starts, 0);
}

TEST_F(AtItsSocket, NamesAMissingEnd) {
  serve(60, 1);
  LineClient silent(server_->port());
  silent.send(R"({"jsonrpc":"2.0","id":1,"method":"job.start","params":[5,"p"]})");
  EXPECT_THAT(last_words(silent), HasSubstr("no end of line"));
  LineClient closing(server_->port());
  closing.send(R"({"jsonrpc":"2.0","id":1,"method":"job.start","params":[5,"p"]})");
  closing.finish_sending();
  EXPECT_THAT(last_words(closing), HasSubstr("no end of line"));
  LineClient half(server_->port());
  half.send(test::kPing.substr(0, 20));
  half.finish_sending();
  EXPECT_THAT(last_words(half), HasSubstr("within a line"));
  EXPECT_EQ(service_.starts, 0) << "none of them is executed";
}

TEST_F(AtItsSocket, IsPatientWithTheEndOfAKnownClientsLine) {
  serve(60, 1);
  LineClient client(server_->port());
  ASSERT_THAT(client.ask(test::kPing), HasSubstr("result"));
  client.send(test::kPing);
  EXPECT_FALSE(client.line(milliseconds(1000)).has_value()) << "networks repeat what they lose";
  EXPECT_THAT(client.ask(""), HasSubstr("result"));
}

TEST_F(AtItsSocket, NamesAMissingEndAlsoWhileTheMachineChanges) {
  serve(60, 4);  // noticed after 2 s
  LineClient other(server_->port());
  wait_for_a_job(other);
  LineClient client(server_->port());
  client.send(test::kPing);
  std::optional<std::string> line;
  const auto until = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  while (!line && std::chrono::steady_clock::now() < until) {
    service_.change({5}, [](JobStatus& job) { ++job.slices_done; });
    line = client.line(milliseconds(50));
  }
  EXPECT_THAT(line.value_or("closed without a word"), HasSubstr("no end of line"));
}

TEST_F(AtItsSocket, LooksAtALineAFewTimesHoweverManyWaitsStandBeforeIt) {
  serve();
  LineClient client(server_->port());
  start_a_job(client);
  client.ask(R"({"jsonrpc":"2.0","id":1,"method":"job.start","params":[6,"p"]})");
  constexpr int kMany = 150;
  std::string lines;
  for (int i = 0; i < kMany; ++i) lines += kShortWait;
  // Of a job that does not run: the snapshot tells nothing of it, and each waits for its turn.
  for (int i = 0; i < kMany; ++i) {
    lines += R"({"jsonrpc":"2.0","id":4,"method":"job.status","params":{"seq":6}})"
             "\n";
  }
  const int before = machine_.looks;
  client.send(lines);
  for (int i = 0; i < 2 * kMany; ++i) ASSERT_TRUE(client.line().has_value()) << i;
  EXPECT_LT(machine_.looks - before, 30 * kMany) << "not by the product of both";
}

TEST_F(AtItsSocket, TriesAnAbortThatCannotBeAnsweredAFewTimesHoweverManyWaitsStandBeforeIt) {
  serve();
  LineClient client(server_->port());
  start_a_job(client);
  client.ask(R"({"jsonrpc":"2.0","id":1,"method":"job.start","params":[6,"p"]})");
  constexpr int kMany = 100;
  std::string lines;
  for (int i = 0; i < kMany; ++i) lines += kShortWait;
  for (int i = 0; i < kMany; ++i) {
    lines += R"({"jsonrpc":"2.0","id":4,"method":"job.abort","params":{"seq":6}})"
             "\n";
  }
  client.send(lines);
  for (int i = 0; i < 2 * kMany; ++i) ASSERT_TRUE(client.line().has_value()) << i;
  EXPECT_LE(service_.abort_tries, 4 * kMany) << "not by the product of both";
}

TEST_F(AtItsSocket, LooksAtAnAbortHoweverManyWaitsStandBeforeIt) {
  serve();
  LineClient client(server_->port());
  start_a_job(client);
  // A job that is not on the board until its turn has come.
  service_.shows_started = true;
  std::string lines;
  for (int i = 0; i < 10; ++i) lines += kShortWait;
  client.send(lines + R"({"jsonrpc":"2.0","id":6,"method":"job.start","params":[6,"p"]})"
                      "\n"
                      R"({"jsonrpc":"2.0","id":7,"method":"job.wait","params":{"seq":6}})"
                      "\n"
                      R"({"jsonrpc":"2.0","id":8,"method":"job.abort","params":{"seq":6}})"
                      "\n");
  for (int i = 0; i < 11; ++i) ASSERT_TRUE(client.line().has_value()) << i;
  const auto aborted = client.line();
  ASSERT_TRUE(aborted.has_value()) << "it does not wait for the end of its job";
  EXPECT_EQ(json::parse(*aborted)["id"], 8);
  EXPECT_EQ(service_.aborts, 1);
}

TEST_F(AtItsSocket, ExecutesNothingBehindAMistakeHoweverLongAWaitStandsBeforeIt) {
  serve();
  LineClient other(server_->port());
  for (const std::string& mistake : {std::string("POST / HTTP/1.1\r\n"), utf16(test::kPing + "\n", true)}) {
    LineClient client(server_->port());
    wait_for_a_job(client);
    client.send(test::kPing + "\n" + mistake + R"({"jsonrpc":"2.0","id":3,"method":"stage.stop"})" + "\n");
    ASSERT_TRUE(client.line().has_value()) << "they are there, and so is what came with them";
    for (int i = 0; i < 20; ++i) {
      service_.change({5}, [](JobStatus& job) { ++job.slices_done; });
      ASSERT_THAT(other.ask(test::kPing), HasSubstr("result")) << "the change was seen before it";
    }
    EXPECT_EQ(service_.stops, 0);
    service_.change({5}, [](JobStatus& job) { job.state = JobState::kCompleted; });
    service_.change_current([](JobStatus& job) { job.state = JobState::kCompleted; });
    service_.change({5}, [](JobStatus& job) { ++job.slices_done; });
    const auto waited = client.line();
    ASSERT_TRUE(waited.has_value());
    EXPECT_EQ(json::parse(*waited)["id"], 2) << *waited;
    EXPECT_THAT(last_words(client), HasSubstr("the connection is closed"));
    EXPECT_EQ(service_.stops, 0);
    service_.change({5}, [](JobStatus& job) { job.state = JobState::kProcessing; });
  }
}

}  // namespace
}  // namespace fvd
