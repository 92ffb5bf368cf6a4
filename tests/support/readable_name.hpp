#pragma once

/// Names of parameterised tests that describe the parameter.

#include <cctype>
#include <cstddef>
#include <string>

namespace fvd::test {

/// "07_RpcPortIsMissing" of 7 and "/rpc/port is missing": a test's name may hold letters, digits and _ only.
inline std::string readable_name(std::size_t index, const std::string& text) {
  std::string name = (index < 10 ? "0" : "") + std::to_string(index) + "_";
  bool begins = true;
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (code >= 128 || std::isalnum(code) == 0) {
      begins = true;
    } else {
      name += begins ? static_cast<char>(std::toupper(code)) : c;
      begins = false;
    }
  }
  return name;
}

}  // namespace fvd::test
