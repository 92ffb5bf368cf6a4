#pragma once

/// What a PLC reads of an evaluation, in few bytes.

#include <cstddef>

#include <nlohmann/json.hpp>

#include "config/fields.hpp"

namespace fvd {

/// Adds to a compact result, which may have at most `room` bytes, from the object "evaluation" of a result.json:
///   v     verdict: pass, fail, uncertain, invalid; null where nothing was judged
///   m     [id, value, U] of each measurement's main value, in the recipe's order, as many as fit; null = none
///   more  measurements that did not fit
///   c     codes of what made measurements invalid, or 1145 for uncertain
void add_compact_evaluation(const nlohmann::ordered_json& evaluation, std::size_t room,
                            nlohmann::ordered_json& compact);
void describe_compact_evaluation(Fields& fields);

}  // namespace fvd
