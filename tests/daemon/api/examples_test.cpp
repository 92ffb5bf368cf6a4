/// The example conversations of daemon/api/examples against the descriptions of the methods.

#include <algorithm>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "config/field_reader.hpp"
#include "daemon/api/rpc_errors.hpp"
#include "tests/daemon/api/dispatcher_fixture.hpp"
#include "tests/support/readable_name.hpp"
#include "tests/support/scratch_dir.hpp"

namespace fvd {
namespace {

using nlohmann::json;

const std::filesystem::path kExamples = FVD_SOURCE_DIR "/daemon/api/examples";

/// A request, the reply that the file gives to it, and where they stand.
struct Exchange {
  std::string where;  ///< file and line of the request
  std::string request;
  std::string reply;
};

std::vector<Exchange> exchanges_of(const std::filesystem::path& file) {
  std::vector<Exchange> exchanges;
  std::istringstream lines(test::read_text(file));
  Exchange next;
  for (int number = 1; std::getline(lines, next.request); number += 2) {
    next.where = file.filename().string() + ":" + std::to_string(number);
    next.reply.clear();
    std::getline(lines, next.reply);
    exchanges.push_back(next);
  }
  return exchanges;
}

/// The exchanges of all files, in the order of the files' names.
std::vector<Exchange> all_exchanges() {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(kExamples)) {
    if (entry.path().extension() == ".jsonl") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  std::vector<Exchange> all;
  for (const auto& file : files) {
    for (Exchange& exchange : exchanges_of(file)) all.push_back(std::move(exchange));
  }
  return all;
}

void PrintTo(const Exchange& exchange, std::ostream* out) { *out << exchange.where; }

class AnExample : public ADispatcher, public testing::WithParamInterface<Exchange> {
 protected:
  [[nodiscard]] json request() const { return json::parse(GetParam().request, nullptr, false); }
  [[nodiscard]] json answer() const { return json::parse(GetParam().reply, nullptr, false); }
  /// The description of the request's method; nullptr if there is no such method.
  [[nodiscard]] const MethodDescription* description() const {
    const auto found = dispatcher_.methods().find(request().value("method", ""));
    return found == dispatcher_.methods().end() ? nullptr : &found->second.about;
  }
};

TEST_P(AnExample, IsARequestThatTheDispatcherDoesNotRefuseAsWrong) {
  const json sent = request();
  ASSERT_TRUE(sent.is_object()) << GetParam().request;
  ASSERT_TRUE(sent.contains("id")) << "no reply is sent to a notification";
  const Handled handled = dispatcher_.handle(GetParam().request, caller_);
  if (handled.waiting) return;
  ASSERT_TRUE(handled.reply.has_value());
  const json got = json::parse(*handled.reply);
  // The job of the example may be unknown to the double of the jobs; JSON-RPC's own errors are negative.
  if (got.contains("error")) {
    EXPECT_GT(got["error"]["code"].get<int>(), 0) << got.dump();
  }
}

TEST_P(AnExample, HasAReplyAsItsMethodIsDescribed) {
  const MethodDescription* const about = description();
  ASSERT_NE(about, nullptr) << GetParam().request;
  const json given = answer();
  ASSERT_TRUE(given.is_object()) << "no reply follows: " << GetParam().reply;
  EXPECT_EQ(given.value("jsonrpc", ""), "2.0");
  EXPECT_EQ(given.value("id", json()), request()["id"]);
  ASSERT_NE(given.contains("result"), given.contains("error")) << given.dump();
  if (given.contains("result")) {
    Problems problems;
    FieldReader reader(given["result"], problems, "/result");
    about->result(reader);
    reader.finish();
    EXPECT_TRUE(problems.empty()) << to_text(problems, GetParam().where);
    return;
  }
  const json& error = given["error"];
  const auto raised = std::find_if(about->errors.begin(), about->errors.end(),
                                   [&error](ErrorCode code) { return rpc_error(code).code == error.value("code", 0); });
  ASSERT_NE(raised, about->errors.end()) << "the method is not described with this error: " << error.dump();
  EXPECT_FALSE(error.value("message", "").empty());
  ASSERT_TRUE(error.contains("data"));
  EXPECT_EQ(error["data"].value("error", ""), error_name(*raised));
  EXPECT_EQ(error["data"].value("retry", json()), json(rpc_error(*raised).retry));
}

INSTANTIATE_TEST_SUITE_P(Of, AnExample, testing::ValuesIn(all_exchanges()),
                         [](const testing::TestParamInfo<Exchange>& example) {
                           return test::readable_name(example.index, example.param.where);
                         });

/// What a PLC cannot do without.
TEST(Examples, ShowEveryMethodOfAMeasurement) {
  std::string all;
  for (const Exchange& exchange : all_exchanges()) all += exchange.request + "\n";
  for (const char* method : {"system.state", "system.ping", "job.start", "job.wait", "job.status", "job.latest",
                             "job.abort", "result.get", "result.next", "result.ack"}) {
    EXPECT_NE(all.find("\"" + std::string(method) + "\""), std::string::npos) << method;
  }
}

}  // namespace
}  // namespace fvd
