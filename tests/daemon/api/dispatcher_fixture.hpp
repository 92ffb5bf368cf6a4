#pragma once

/// A dispatcher on a job service without devices, one caller, and a look at every reply.

#include <string>

#include "config/field_reader.hpp"
#include "daemon/api/dispatcher.hpp"
#include "daemon/api/methods/methods.hpp"
#include "gtest/gtest.h"
#include "tests/daemon/api/fake_job_service.hpp"

namespace fvd {

class ADispatcher : public testing::Test {
 protected:
  /// The reply to a line as JSON; a discarded value where there is none.
  nlohmann::json reply(const std::string& line) {
    const Handled handled = dispatcher_.handle(line, caller_);
    if (!handled.reply) return nlohmann::json(nlohmann::json::value_t::discarded);
    auto answer = nlohmann::json::parse(*handled.reply);
    expect_as_described(nlohmann::json::parse(line, nullptr, false), answer);
    return answer;
  }
  /// Every result that a test gets is as its method is described, and every error of a code that is.
  void expect_as_described(const nlohmann::json& request, const nlohmann::json& answer) {
    if (!request.is_object() || !answer.is_object() || !request.contains("method")) return;
    const auto method = dispatcher_.methods().find(request["method"].is_string() ? request["method"] : "");
    if (method == dispatcher_.methods().end()) return;
    const bool picked = request.contains("params") && request["params"].contains("fields");
    if (!answer.contains("result") || picked) return;
    Problems problems;
    FieldReader reader(answer["result"], problems, "/result");
    method->second.about.result(reader);
    reader.finish();
    EXPECT_TRUE(problems.empty()) << to_text(problems, method->first) << answer.dump();
  }
  int error_of(const std::string& line) {
    const nlohmann::json answer = reply(line);
    EXPECT_TRUE(answer.contains("error")) << answer.dump();
    EXPECT_FALSE(answer.contains("result"));
    return answer.contains("error") ? answer["error"]["code"].get<int>() : 0;
  }
  nlohmann::json result_of(const std::string& method, const nlohmann::json& params = nlohmann::json::object()) {
    const nlohmann::json answer =
        reply(nlohmann::json{{"jsonrpc", "2.0"}, {"id", 1}, {"method", method}, {"params", params}}.dump());
    EXPECT_TRUE(answer.contains("result")) << answer.dump();
    return answer.value("result", nlohmann::json());
  }

  FakeJobService service_;
  Caller caller_{.who = {"test", Role::kAdminister}};
  Dispatcher dispatcher_{all_methods(service_.services()), service_.services()};
};

}  // namespace fvd
