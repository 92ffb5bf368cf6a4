#pragma once

/// A dispatcher on a job service without devices, and one caller.

#include <string>

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
    return handled.reply ? nlohmann::json::parse(*handled.reply) : nlohmann::json(nlohmann::json::value_t::discarded);
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
