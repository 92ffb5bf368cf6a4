#pragma once

/// Parameters of a call, checked and read by the method's description.

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "config/fields.hpp"

namespace fvd {

/// Integers up to here survive a client that keeps numbers as doubles.
inline constexpr std::int64_t kLargestExactInteger = (std::int64_t{1} << 53U) - 1;

/// The value of a whole number within +-kLargestExactInteger, written as 4711 or as 4711.0; nothing for all else.
[[nodiscard]] std::optional<std::int64_t> exact_integer(const nlohmann::json& value);

using DescribeFields = std::function<void(Fields&)>;

/// The names of the described parameters, in their order.
[[nodiscard]] std::vector<std::string> param_names(const DescribeFields& describe);

/// The same, made once: for each poll it would take longer than all else of it.
template <void (*kDescribe)(Fields&)>
[[nodiscard]] const std::vector<std::string>& names_in() {
  static const std::vector<std::string> names = param_names(kDescribe);
  return names;
}

/// The parameters by name, every one as described; whole numbers as integers, however they were written. given: an
/// object, a list in the order of the description, or null. Throws ProtocolError that names the method, the parameter
/// and what is accepted.
[[nodiscard]] nlohmann::json checked_params(const std::string& method, const DescribeFields& describe,
                                            const nlohmann::json& given);

/// Fills what is described from parameters that checked_params() gave.
void read_params(const nlohmann::json& checked, const DescribeFields& describe);

}  // namespace fvd
