#pragma once

/// Requests as a client writes them.

#include <string>

#include <nlohmann/json.hpp>

namespace fvd::test {

inline std::string call(const std::string& method, const nlohmann::json& params = nlohmann::json::object(),
                        int id = 1) {
  return nlohmann::json{{"jsonrpc", "2.0"}, {"id", id}, {"method", method}, {"params", params}}.dump();
}

inline const std::string kPing = R"({"jsonrpc":"2.0","id":1,"method":"system.ping"})";

}  // namespace fvd::test
