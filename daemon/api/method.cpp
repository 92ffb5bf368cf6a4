#include "daemon/api/method.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "daemon/api/replies.hpp"
#include "daemon/api/rpc_errors.hpp"

namespace fvd {

namespace {

using nlohmann::json;

[[noreturn]] void refuse(const std::string& why) { throw ProtocolError{json_rpc::kInvalidParams, why}; }

std::string number_text(double value) {
  std::ostringstream text;
  text.precision(16);
  text << value;
  return text.str();
}

std::string range_text(const ParamRange& range) { return number_text(range.least) + ".." + number_text(range.most); }

void check_range(const Param& param, double value) {
  if (param.range && !(value >= param.range->least && value <= param.range->most)) {
    refuse(quoted(param.name) + " must lie within " + range_text(*param.range));
  }
}

json checked_integer(const Param& param, const json& value) {
  const auto whole = exact_integer(value);
  if (!whole) {
    if (value.is_number() && std::trunc(value.get<double>()) == value.get<double>()) {
      refuse(quoted(param.name) + " must lie within " +
             range_text(param.range.value_or(
                 ParamRange{-static_cast<double>(kLargestExactInteger), static_cast<double>(kLargestExactInteger)})));
    }
    refuse(quoted(param.name) + " must be an integer");
  }
  check_range(param, static_cast<double>(*whole));
  return *whole;
}

json checked_value(const Param& param, const json& value) {
  switch (param.type) {
    case ParamType::kText:
      if (!value.is_string()) refuse(quoted(param.name) + " must be a text");
      if (value.get_ref<const std::string&>().size() > kMaxForeignText_bytes) {
        refuse(quoted(param.name) + " must have at most " + std::to_string(kMaxForeignText_bytes) + " bytes");
      }
      return value;
    case ParamType::kInteger:
      return checked_integer(param, value);
    case ParamType::kNumber:
      if (!value.is_number()) refuse(quoted(param.name) + " must be a number");
      check_range(param, value.get<double>());
      return value;
    case ParamType::kAny:
      // It comes back in the reply.
      if (value.dump(-1, ' ', true, json::error_handler_t::replace).size() > kMaxForeignText_bytes) {
        refuse(quoted(param.name) + " must have at most " + std::to_string(kMaxForeignText_bytes) + " bytes as JSON");
      }
      return value;
  }
  return value;
}

}  // namespace

std::optional<std::int64_t> exact_integer(const json& value) {
  if (value.is_number_unsigned()) {
    const auto number = value.get<std::uint64_t>();
    if (number > static_cast<std::uint64_t>(kLargestExactInteger)) return std::nullopt;
    return static_cast<std::int64_t>(number);
  }
  if (value.is_number_integer()) {
    const auto number = value.get<std::int64_t>();
    return number < -kLargestExactInteger ? std::nullopt : std::optional(number);
  }
  if (!value.is_number_float()) return std::nullopt;
  const auto number = value.get<double>();
  if (std::trunc(number) != number || std::abs(number) > static_cast<double>(kLargestExactInteger)) return std::nullopt;
  return static_cast<std::int64_t>(number);
}

json checked_params(const std::string& method_name, const std::vector<Param>& known, const json& given) {
  json params = json::object();
  if (given.is_array()) {
    if (given.size() > known.size()) {
      refuse(method_name + " takes at most " + std::to_string(known.size()) + " parameters");
    }
    for (std::size_t i = 0; i < given.size(); ++i) params[known[i].name] = checked_value(known[i], given[i]);
  } else if (given.is_object()) {
    for (const auto& [key, value] : given.items()) {
      const auto param =
          std::find_if(known.begin(), known.end(), [&key = key](const Param& p) { return p.name == key; });
      if (param == known.end()) refuse(method_name + " has no parameter " + quoted(key));
      params[key] = checked_value(*param, value);
    }
  }
  for (const Param& param : known) {
    if (param.required && !params.contains(param.name)) {
      refuse(method_name + " needs the parameter " + quoted(param.name));
    }
  }
  return params;
}

}  // namespace fvd
