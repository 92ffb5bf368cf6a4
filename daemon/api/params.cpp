#include "daemon/api/params.hpp"

#include <cmath>

#include "config/field_reader.hpp"
#include "config/field_writer.hpp"
#include "daemon/api/replies.hpp"
#include "daemon/api/rpc_errors.hpp"

namespace fvd {

namespace {

using nlohmann::json;

constexpr const char* kPointer = "/params";
/// Problems that one refusal tells.
constexpr std::size_t kToldProblems = 3;

[[noreturn]] void refuse(const std::string& why) { throw ProtocolError{json_rpc::kInvalidParams, why}; }

json with_whole_numbers(json params) {
  for (json& value : params) {
    if (const auto whole = exact_integer(value)) value = *whole;
  }
  return params;
}

json by_name(const std::string& method, const DescribeFields& describe, const json& given) {
  if (given.is_null()) return json::object();
  if (given.is_object()) return given;
  const std::vector<std::string> names = param_names(describe);
  if (given.size() > names.size()) refuse(method + " takes at most " + std::to_string(names.size()) + " parameters");
  json params = json::object();
  for (std::size_t i = 0; i < given.size(); ++i) params[names[i]] = given[i];
  return params;
}

/// "'seq': 0 is not accepted; expected ..."
std::string problem_text(const Problem& problem) {
  const std::string name = problem.pointer.substr(std::min(problem.pointer.size(), std::string(kPointer).size() + 1));
  return quoted(name) + ": " + problem.message;
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

std::vector<std::string> param_names(const DescribeFields& describe) {
  const auto schema = fields_to_schema(describe, "");
  std::vector<std::string> names;
  for (const auto& [name, unused] : schema.at("properties").items()) {
    if (name != "$schema") names.push_back(name);
  }
  return names;
}

json checked_params(const std::string& method, const DescribeFields& describe, const json& given) {
  json params = with_whole_numbers(by_name(method, describe, given));
  Problems problems;
  FieldReader reader(params, problems, kPointer);
  describe(reader);
  reader.finish();
  if (!problems.empty()) {
    std::string all;
    for (std::size_t i = 0; i < std::min(problems.size(), kToldProblems); ++i) {
      all += (all.empty() ? method + ": " : "; ") + problem_text(problems[i]);
    }
    refuse(all);
  }
  return params;
}

void read_params(const json& checked, const DescribeFields& describe) {
  Problems none;
  FieldReader reader(checked, none, kPointer);
  describe(reader);
}

}  // namespace fvd
