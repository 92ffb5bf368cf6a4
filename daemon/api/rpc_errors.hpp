#pragma once

/// Error codes on the wire: JSON-RPC 2.0's own, and fvd's, which are positive and never change their meaning.

#include <string_view>

#include "core/base/error.hpp"
#include "daemon/access/access_error.hpp"

namespace fvd {

namespace json_rpc {
inline constexpr int kParseError = -32700;
inline constexpr int kInvalidRequest = -32600;
inline constexpr int kMethodNotFound = -32601;
inline constexpr int kInvalidParams = -32602;
inline constexpr int kInternalError = -32603;

[[nodiscard]] constexpr std::string_view name_of(int code) noexcept {
  switch (code) {
    case kParseError:
      return "parse_error";
    case kInvalidRequest:
      return "invalid_request";
    case kMethodNotFound:
      return "method_not_found";
    case kInvalidParams:
      return "invalid_params";
    default:
      return "internal";
  }
}
}  // namespace json_rpc

/// As the errors of the machine, those of the callers: stable names.
[[nodiscard]] constexpr std::string_view error_name(AccessCode code) noexcept {
  return code == AccessCode::kNotAllowed ? "not_allowed" : "no_control";
}

struct RpcError {
  int code = 0;
  bool retry = false;  ///< the same request may succeed later without anybody doing anything
};

/// One code for every ErrorCode; no two share one.
[[nodiscard]] RpcError rpc_error(ErrorCode code) noexcept;
[[nodiscard]] constexpr RpcError rpc_error(AccessCode code) noexcept {
  return code == AccessCode::kNotAllowed ? RpcError{1004, false} : RpcError{1003, true};
}

}  // namespace fvd
