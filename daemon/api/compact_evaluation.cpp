#include "daemon/api/compact_evaluation.hpp"

#include <set>
#include <string>
#include <utility>

#include "daemon/api/reply_form.hpp"
#include "daemon/api/result_fields.hpp"
#include "daemon/result/evaluation_result.hpp"

namespace fvd {

namespace {

using nlohmann::ordered_json;

ordered_json number_of(const ordered_json& value, const char* key) {
  if (!value.contains(key)) return nullptr;
  return rounded_figure(value[key].get<double>());
}

ordered_json triple_of(const ordered_json& measurement) {
  const std::string main = measurement.value("main_value", "");
  ordered_json triple = ordered_json::array({measurement["id"], nullptr, nullptr});
  if (!measurement["values"].contains(main)) return triple;
  const ordered_json& value = measurement["values"][main];
  // An invalid measurement has no value that a PLC may use.
  if (measurement.contains("reason")) return triple;
  triple[1] = number_of(value, "value");
  triple[2] = number_of(value, "U");
  return triple;
}

std::set<int> codes_of(const ordered_json& evaluation) {
  std::set<int> codes;
  for (const auto& [name, measurement] : evaluation["measurements"].items()) {
    if (measurement.contains("reason_code")) codes.insert(measurement["reason_code"].get<int>());
    if (measurement.value("verdict", "") == "uncertain") codes.insert(evaluation_code::kUncertain);
    if (measurement.value("verdict", "") == "invalid" && !measurement.contains("reason_code")) {
      codes.insert(evaluation_code::kInvalid);
    }
  }
  return codes;
}

}  // namespace

void add_compact_evaluation(const ordered_json& evaluation, std::size_t room, ordered_json& compact) {
  compact["v"] = evaluation.contains("verdict") ? evaluation["verdict"] : ordered_json(nullptr);
  compact["m"] = ordered_json::array();
  compact["more"] = 0;
  compact["c"] = codes_of(evaluation);
  const ordered_json& order = evaluation["order"];
  std::size_t left = order.size();
  for (const auto& name : order) {
    ordered_json longer = compact;
    longer["m"].push_back(triple_of(evaluation["measurements"][name.get<std::string>()]));
    longer["more"] = left - 1;
    if (written_bytes(longer) > room) break;
    compact = std::move(longer);
    --left;
  }
  compact["more"] = left;
}

void describe_compact_evaluation(Fields& fields) {
  const ResultFields result(fields);
  result.text("v", "compact, with an evaluation: pass, fail, uncertain, invalid; null where nothing is limited",
              Presence::kSometimes);
  result.any("m",
             "compact, with an evaluation: [id, value, U] of each measurement in the recipe's order, as many as fit",
             Presence::kSometimes);
  result.integer("more", "compact, with an evaluation: measurements that did not fit", Presence::kSometimes);
  result.any("c",
             "compact, with an evaluation: why values are missing or uncertain: 1122 too few valid points, 1141 "
             "invalid, 1142 outside the field of view, 1145 uncertain",
             Presence::kSometimes);
}

}  // namespace fvd
