#include "daemon/transport/http_refusal.hpp"

#include <nlohmann/json.hpp>

namespace fvd {

std::string HttpRefusal::body() const {
  return nlohmann::ordered_json{{"error", error}, {"message", message}}.dump(
             -1, ' ', true, nlohmann::ordered_json::error_handler_t::replace) +
         "\n";
}

}  // namespace fvd
