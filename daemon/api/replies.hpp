#pragma once

/// JSON-RPC 2.0's reply objects and their text.

#include <string>

#include <nlohmann/json.hpp>

#include "core/base/error.hpp"
#include "daemon/access/access_error.hpp"

namespace fvd {

/// An error of the protocol or the parameters, as against one of the machine; code of json_rpc.
struct ProtocolError {
  int code = 0;
  std::string message;
  nlohmann::ordered_json data = nullptr;
};

/// Text from outside appears in no reply beyond this size.
inline constexpr std::size_t kMaxForeignText_bytes = 64;

/// The text, shortened to kMaxForeignText_bytes.
[[nodiscard]] std::string shortened_foreign_text(const std::string& text);
/// The same in single quotes.
[[nodiscard]] std::string quoted(const std::string& text);

/// Of a success reply around its result, with the end of the line.
[[nodiscard]] std::size_t envelope_bytes(const nlohmann::json& id);
[[nodiscard]] nlohmann::ordered_json success_reply(const nlohmann::json& id, nlohmann::ordered_json result);
[[nodiscard]] nlohmann::ordered_json failure_reply(const nlohmann::json& id, int code, const std::string& message,
                                                   nlohmann::ordered_json data = nullptr);
/// With the error's name and whether to retry; state: the machine's, left out if empty.
[[nodiscard]] nlohmann::ordered_json failure_reply(const nlohmann::json& id, ErrorCode code, const std::string& message,
                                                   std::string_view state = {});

[[nodiscard]] nlohmann::ordered_json failure_reply(const nlohmann::json& id, AccessCode code,
                                                   const std::string& message);

/// One line without terminator, ASCII.
[[nodiscard]] std::string reply_line(const nlohmann::ordered_json& reply);

/// True for what is answered as it came: null, a text of at most 64 bytes as a reply writes it, a whole number within
/// +-(2^53-1).
[[nodiscard]] bool is_valid_id(const nlohmann::json& id);

}  // namespace fvd
