#pragma once

/// What a PLC reads of an evaluation, in few bytes.

#include <cstddef>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "config/fields.hpp"

namespace fvd {

/// Adds to a compact result, of which what picked_of_evaluation() gives may have at most `room` bytes, from the object
/// "evaluation" of a result.json:
///   v     verdict: pass, fail, uncertain, invalid; null where nothing was judged
///   m     [id, value, U] of each measurement's main value, in the recipe's order, as many as fit; null = none
///   more  measurements that did not fit
///   c     codes of what made measurements invalid, or 1145 for uncertain
void add_compact_evaluation(const nlohmann::ordered_json& evaluation, const std::vector<std::string>& fields,
                            std::size_t room, nlohmann::ordered_json& compact);
/// These fields of a compact result, or all where none is named. Measurements that are missing of `m` are counted as
/// left out where `more` is not asked for.
[[nodiscard]] nlohmann::ordered_json picked_of_evaluation(const nlohmann::ordered_json& compact,
                                                          const std::vector<std::string>& fields);
void describe_compact_evaluation(Fields& fields);

}  // namespace fvd
