/// The loop in structured text: the bytes that stand in it, sent to a dispatcher, and what it seeks in the replies.

#include <map>
#include <regex>
#include <string>
#include <vector>

#include "tests/daemon/api/dispatcher_fixture.hpp"
#include "tests/support/scratch_dir.hpp"

namespace fvd {
namespace {

using nlohmann::json;

constexpr std::int64_t kSeq = 4711;
const std::string kPart = "P-0815";
/// Many controllers' strings end there.
constexpr std::size_t kLongestString = 255;

/// The text of a literal of IEC 61131-3, without its quotes.
std::string bytes_of(const std::string& literal) {
  std::string bytes;
  for (std::size_t i = 0; i < literal.size(); ++i) {
    if (literal[i] != '$') {
      bytes += literal[i];
    } else {
      ++i;
      bytes += literal.at(i) == 'L' ? '\n' : literal.at(i);
    }
  }
  return bytes;
}

/// What an expression of literals, CONCAT, `number` and `part` gives.
std::string value_of(const std::string& expression, const std::string& number, const std::string& part) {
  static const std::regex kTerm("'((?:[^'$]|\\$.)*)'|\\b(number|part)\\b");
  std::string value;
  for (std::sregex_iterator term(expression.begin(), expression.end(), kTerm), end; term != end; ++term) {
    value += (*term)[2].matched ? ((*term)[2] == "number" ? number : part) : bytes_of((*term)[1]);
  }
  return value;
}

class TheStructuredText : public ADispatcher {
 protected:
  /// The expression that is assigned to `request` in a step.
  [[nodiscard]] std::string request_of(int step) const {
    const std::regex statement("\\n  " + std::to_string(step) + ": request := (.*);\\n");
    std::smatch found;
    EXPECT_TRUE(std::regex_search(text_, found, statement)) << step;
    return found[1];
  }
  /// Every text that is sought in a reply.
  [[nodiscard]] std::vector<std::string> sought() const {
    static const std::regex kFind("(?:FIND|NumberAfter)\\(reply, (CONCAT\\([^)]*\\)|'[^']*')\\)");
    std::vector<std::string> all;
    for (std::sregex_iterator match(text_.begin(), text_.end(), kFind), end; match != end; ++match) {
      all.push_back(value_of((*match)[1], std::to_string(kSeq), kPart));
    }
    return all;
  }
  /// The reply's line to what a step sends.
  std::string ask(int step) {
    const std::string line = value_of(request_of(step), std::to_string(kSeq), kPart);
    EXPECT_EQ(line.back(), '\n') << "a line has an end: " << line;
    const Handled handled = dispatcher_.handle(line.substr(0, line.size() - 1), caller_);
    all_replies_ += handled.reply.value_or("") + "\n";
    return handled.reply.value_or("");
  }

  std::string text_ = test::read_text(FVD_SOURCE_DIR "/daemon/api/examples/line_loop.st");
  std::string all_replies_;
};

TEST_F(TheStructuredText, SendsWhatTheDispatcherTakesInTheOrderOfItsSteps) {
  for (int step = 0; step < 2; ++step) EXPECT_TRUE(json::parse(ask(step)).contains("result")) << step;
  service_.change({kSeq}, [](JobStatus& job) {
    job.state = JobState::kCompleted;
    job.acquired = true;
    job.ended_utc = "2026-11-30T10:00:00.000Z";
  });
  for (int step = 2; step < 6; ++step) {
    const json answer = json::parse(ask(step));
    EXPECT_TRUE(answer.contains("result")) << step << answer;
    EXPECT_EQ(answer["id"], step + 1);
  }
  EXPECT_EQ(service_.starts, 1);
  EXPECT_EQ(service_.job(ClientSeq{kSeq}).request.part_id, kPart);
  EXPECT_TRUE(service_.job(ClientSeq{kSeq}).acknowledged);
}

TEST_F(TheStructuredText, SeeksInTheRepliesWhatStandsThere) {
  for (int step = 0; step < 2; ++step) ask(step);
  service_.change({kSeq}, [](JobStatus& job) {
    job.state = JobState::kFailed;
    job.error = ErrorCode::kInterrupted;
    job.acquired = true;
  });
  for (int step = 2; step < 6; ++step) ask(step);
  for (const ErrorCode code : {ErrorCode::kBusy, ErrorCode::kSeqStale}) {
    service_.refusal = code;
    ask(1);
  }
  const std::vector<std::string> all = sought();
  EXPECT_GE(all.size(), 9U);
  for (const std::string& text : all) EXPECT_NE(all_replies_.find(text), std::string::npos) << text;
}

TEST_F(TheStructuredText, KeepsToTheLengthOfAControllersString) {
  const std::string part(64, 'p');
  for (int step = 0; step < 6; ++step) {
    EXPECT_LE(value_of(request_of(step), "9007199254740991", part).size(), kLongestString) << step;
  }
}

TEST_F(ADispatcher, TellsAResultThatWasRemovedByAnErrorOfItsOwn) {
  result_of("job.start", {{"seq", 3}, {"part_id", "p"}});
  service_.change({3}, [](JobStatus& job) {
    job.state = JobState::kCompleted;
    job.removed_utc = "2026-11-30T10:00:00.000Z";
  });
  for (const char* format : {"compact", "full", "complete"}) {
    const json answer = reply(
        json{{"jsonrpc", "2.0"}, {"id", 1}, {"method", "result.get"}, {"params", {{"seq", 3}, {"format", format}}}}
            .dump());
    EXPECT_EQ(answer["error"]["code"], 1018) << answer;
    EXPECT_EQ(answer["error"]["data"]["error"], "result_removed");
  }
}

TEST_F(ADispatcher, DescribesUnitsRangesErrorsAndTheOrderOfALine) {
  const json document = result_of("rpc.discover");
  EXPECT_GE(document["x-line"]["order"].size(), 5U);
  EXPECT_EQ(document["x-line"]["times"]["reply_ms"]["value"], 1000);
  EXPECT_GT(document["x-errors"].size(), static_cast<std::size_t>(kLastErrorCode));
  const auto method = [&](const std::string& name) {
    for (const json& one : document["methods"]) {
      if (one["name"] == name) return one;
    }
    return json();
  };
  const json status = method("job.status")["result"]["schema"]["properties"];
  EXPECT_EQ(status["age_s"]["x-unit"], "s");
  EXPECT_EQ(status["progress"]["maximum"], 1);
  EXPECT_EQ(status["part_id"]["maxLength"], 64);
  EXPECT_EQ(status["state"]["enum"], json({"processing", "completed", "aborted", "failed"}));
  const json result = method("result.get");
  EXPECT_EQ(result["result"]["schema"]["properties"]["height_min_um"]["x-unit"], "um");
  EXPECT_EQ(result["errors"][1]["code"], 1018);
  EXPECT_FALSE(result["errors"][1]["x-meaning"].get<std::string>().empty());
  for (const json& one : document["methods"]) {
    for (const auto& [key, property] : one["result"]["schema"]["properties"].items()) {
      EXPECT_FALSE(property.value("description", "").empty()) << one["name"] << key;
    }
  }
}

}  // namespace
}  // namespace fvd
