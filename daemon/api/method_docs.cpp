#include "daemon/api/method_docs.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>
#include <string_view>

#include "config/field_writer.hpp"
#include "daemon/api/error_meanings.hpp"
#include "daemon/api/line_contract.hpp"
#include "daemon/api/result_fields.hpp"
#include "daemon/api/rpc_errors.hpp"
#include "daemon/base/version.hpp"

namespace fvd {

namespace {

using nlohmann::ordered_json;

ordered_json schema_of(const DescribeFields& describe) {
  ordered_json schema = fields_to_schema(describe, "");
  schema.erase("$schema");
  schema.erase("title");
  schema["properties"].erase("$schema");
  return schema;
}

/// The end of a key that says its unit; longer ends first.
struct UnitOfKey {
  std::string_view end;
  std::string_view unit;
};
constexpr std::array kUnits{
    UnitOfKey{"_um_per_s", "um/s"}, UnitOfKey{"_um", "um"},      UnitOfKey{"_us", "us"},
    UnitOfKey{"_ms", "ms"},         UnitOfKey{"_s", "s"},        UnitOfKey{"_px", "px"},
    UnitOfKey{"_db", "dB"},         UnitOfKey{"_bytes", "byte"}, UnitOfKey{"_c", "degree Celsius"},
    UnitOfKey{"_percent", "%"},     UnitOfKey{"_fraction", "1"}, UnitOfKey{"progress", "1"},
    UnitOfKey{"_utc", "ISO 8601"},
};

void add_unit(const std::string& name, ordered_json& property) {
  const auto unit = std::find_if(kUnits.begin(), kUnits.end(), [&name](const UnitOfKey& known) {
    return name.size() >= known.end.size() && name.ends_with(known.end);
  });
  if (unit != kUnits.end()) property["x-unit"] = unit->unit;
}

/// A result has no defaults, and a range only where it is one that a client can use.
void make_result_schema(ordered_json& schema) {
  constexpr double kNoRange = 9.1e15;
  for (auto& [name, property] : schema["properties"].items()) {
    property.erase("default");
    for (const char* key : {"minimum", "maximum"}) {
      if (property.contains(key) && std::abs(property[key].get<double>()) > kNoRange) property.erase(key);
    }
    if (property.value("maxLength", std::size_t{0}) == kUnlimited_bytes) property.erase("maxLength");
    add_unit(name, property);
    if (property.contains("items") && property["items"].contains("properties")) make_result_schema(property["items"]);
  }
}

ordered_json result_schema(const DescribeFields& describe) {
  ordered_json schema = schema_of(describe);
  make_result_schema(schema);
  return schema;
}

/// Of a method's reply; a parameter `fields` picks keys, and then no key is sure to be there.
ordered_json reply_schema(const MethodDescription& about) {
  ordered_json schema = result_schema(about.result);
  if (!schema_of(about.params)["properties"].contains("fields") || !schema.contains("required")) return schema;
  schema["x-required-without-fields"] = schema["required"];
  schema.erase("required");
  return schema;
}

bool is_required(const ordered_json& schema, const std::string& name) {
  if (!schema.contains("required")) return false;
  const auto& required = schema["required"];
  return std::find(required.begin(), required.end(), name) != required.end();
}

ordered_json params_json(const DescribeFields& describe) {
  const ordered_json schema = schema_of(describe);
  ordered_json params = ordered_json::array();
  for (const auto& [name, property] : schema["properties"].items()) {
    ordered_json own = property;
    own.erase("description");
    add_unit(name, own);
    params.push_back({{"name", name},
                      {"description", property.value("description", "")},
                      {"required", is_required(schema, name)},
                      {"schema", std::move(own)}});
  }
  return params;
}

ordered_json errors_json(const MethodDescription& about) {
  ordered_json errors = ordered_json::array();
  for (const ErrorCode code : about.errors) {
    errors.push_back({{"code", rpc_error(code).code},
                      {"message", error_name(code)},
                      {"x-retry", rpc_error(code).retry},
                      {"x-meaning", error_meaning(code)}});
  }
  return errors;
}

/// What is accepted, from a parameter's schema.
std::string accepted_text(const ordered_json& schema) {
  if (schema.contains("enum")) {
    std::string text;
    for (const auto& value : schema["enum"]) text += (text.empty() ? "" : " or ") + value.get<std::string>();
    return text;
  }
  if (schema.contains("maxLength")) return "text of at most " + schema["maxLength"].dump() + " bytes";
  if (schema.contains("maximum")) {
    std::ostringstream text;
    text.precision(16);
    const bool whole = schema.value("type", "") == "integer";
    const bool open = schema.contains("exclusiveMinimum");
    text << (whole ? "integer " : "") << (open ? "above " : "")
         << schema[open ? "exclusiveMinimum" : "minimum"].get<double>() << " .. " << schema["maximum"].get<double>();
    return text.str();
  }
  return schema.value("type", std::string("any JSON"));
}

std::string default_text(const ordered_json& schema) {
  if (!schema.contains("default")) return "";
  const auto& value = schema["default"];
  if (value.is_string() && value.get_ref<const std::string&>().empty()) return "";
  return "`" + (value.is_string() ? value.get<std::string>() : value.dump()) + "`";
}

std::string keys_text(const DescribeFields& describe) {
  const ordered_json schema = result_schema(describe);
  std::string text;
  for (const auto& [name, property] : schema["properties"].items()) {
    const std::string key = is_required(schema, name) ? "`" + name + "`" : "[`" + name + "`]";
    text += (text.empty() ? "" : ", ") + key;
  }
  return text;
}

std::string traits_text(const MethodDescription& about) {
  std::string text;
  const auto add = [&text](const std::string& trait) { text += (text.empty() ? "" : ", ") + trait; };
  if (about.moves_stage) add("MOVES the stage");
  if (about.needs_control) add("needs control");
  if (about.is_urgent) add("never waits");
  if (about.may_wait) add("may wait");
  if (about.needs_id) add("needs an id");
  return text;
}

std::string errors_text(const MethodDescription& about) {
  std::vector<int> codes;
  for (const ErrorCode code : about.errors) codes.push_back(rpc_error(code).code);
  std::sort(codes.begin(), codes.end());
  std::string text;
  for (const int code : codes) text += (text.empty() ? "" : " ") + std::to_string(code);
  return text;
}

void write_methods(const MethodTable& methods, std::ostream& out) {
  out << "| method | what | role | besides | result, [not always] | errors |\n|---|---|---|---|---|---|\n";
  for (const auto& [name, method] : methods) {
    const MethodDescription& about = method.about;
    out << "| `" << name << "` | " << about.summary << " | " << role_name(about.role) << " | " << traits_text(about)
        << " | " << keys_text(about.result) << " | " << errors_text(about) << " |\n";
  }
}

void write_params(const MethodTable& methods, std::ostream& out) {
  out << "| method | parameter, in the order of a list | accepted | default | meaning |\n|---|---|---|---|---|\n";
  for (const auto& [name, method] : methods) {
    for (const auto& param : params_json(method.about.params)) {
      const auto& schema = param["schema"];
      const std::string preset = param["required"].get<bool>() ? "required" : default_text(schema);
      out << "| `" << name << "` | `" << param["name"].get<std::string>() << "` | " << accepted_text(schema) << " | "
          << preset << " | " << param["description"].get<std::string>() << " |\n";
    }
  }
}

struct ErrorRow {
  std::string name;
  bool retry = false;
  std::string_view meaning;
};

/// Every error that a call may meet, but JSON-RPC's own.
std::map<int, ErrorRow> all_errors() {
  std::map<int, ErrorRow> errors;
  for (const AccessCode code : {AccessCode::kNotAllowed, AccessCode::kNoControl}) {
    const RpcError wire = rpc_error(code);
    errors[wire.code] = {std::string(error_name(code)), wire.retry, error_meaning(code)};
  }
  for (int i = 0; i <= static_cast<int>(kLastErrorCode); ++i) {
    const auto code = static_cast<ErrorCode>(i);
    const RpcError wire = rpc_error(code);
    errors[wire.code] = {std::string(error_name(code)), wire.retry, error_meaning(code)};
  }
  return errors;
}

ordered_json all_errors_json() {
  ordered_json list = ordered_json::array();
  for (const int code :
       {json_rpc::kParseError, json_rpc::kInvalidRequest, json_rpc::kMethodNotFound, json_rpc::kInvalidParams}) {
    list.push_back(
        {{"code", code}, {"name", json_rpc::name_of(code)}, {"retry", false}, {"meaning", "of JSON-RPC 2.0"}});
  }
  for (const auto& [code, error] : all_errors()) {
    list.push_back({{"code", code}, {"name", error.name}, {"retry", error.retry}, {"meaning", error.meaning}});
  }
  return list;
}

void write_errors(std::ostream& out) {
  out << "| code | error | may succeed later | meaning, what to do |\n|---|---|---|---|\n";
  for (const auto& [code, error] : all_errors()) {
    out << "| " << code << " | " << error.name << " | " << (error.retry ? "yes" : "") << " | " << error.meaning
        << " |\n";
  }
  out << "\nReasons that an evaluation gives in a result, and no call fails with:\n\n" << result_codes_markdown();
}

}  // namespace

ordered_json openrpc_document(const MethodTable& methods) {
  ordered_json described = ordered_json::array();
  for (const auto& [name, method] : methods) {
    const MethodDescription& about = method.about;
    described.push_back({{"name", name},
                         {"summary", about.summary},
                         {"params", params_json(about.params)},
                         {"result", {{"name", "result"}, {"schema", reply_schema(about)}}},
                         {"errors", errors_json(about)},
                         {"x-role", role_name(about.role)},
                         {"x-moves-stage", about.moves_stage},
                         {"x-may-wait", about.may_wait},
                         {"x-needs-control", about.needs_control},
                         {"x-urgent", about.is_urgent},
                         {"x-audited", about.is_audited},
                         {"x-needs-id", about.needs_id},
                         {"x-brief", about.is_brief}});
  }
  return {{"openrpc", "1.2.6"},
          {"info", {{"title", "fvd"}, {"version", kVersion}}},
          {"methods", described},
          {"x-errors", all_errors_json()},
          {"x-line", line_contract_json()}};
}

std::string methods_markdown(const MethodTable& methods) {
  std::ostringstream out;
  write_methods(methods, out);
  out << '\n';
  write_params(methods, out);
  out << '\n';
  write_errors(out);
  out << '\n' << line_contract_markdown();
  return out.str();
}

}  // namespace fvd
