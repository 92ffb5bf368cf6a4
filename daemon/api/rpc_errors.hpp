#pragma once

/// Error codes on the wire: JSON-RPC 2.0's own, and fvd's, which are positive and never change their meaning.

#include <string_view>

#include "core/base/error.hpp"

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

/// A caller whose role may not call the method.
inline constexpr int kNotAllowed = 1004;
inline constexpr const char* kNotAllowedName = "not_allowed";

struct RpcError {
  int code = 0;
  bool retry = false;  ///< the same request may succeed later without anybody doing anything
};

/// One code for every ErrorCode; no two share one.
[[nodiscard]] RpcError rpc_error(ErrorCode code) noexcept;

}  // namespace fvd
