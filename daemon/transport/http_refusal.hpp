#pragma once

/// An answer that says why a request was refused: a status and one line of JSON.

#include <string>

namespace fvd {

struct HttpRefusal {
  int status = 400;
  std::string error;    ///< a stable name
  std::string message;  ///< says what to do
  std::string allow{};  ///< of 405: the methods that the path has, "GET, HEAD"

  /// One line of JSON with error and message.
  [[nodiscard]] std::string body() const;
};

}  // namespace fvd
