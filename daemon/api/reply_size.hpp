#pragma once

/// Replies that are too long for their connection become errors that say so.

#include <cstddef>
#include <string>

#include <nlohmann/json.hpp>

namespace fvd {

/// The reply, or the list of a batch's replies, as a line without terminator. One that would be longer than most_bytes
/// becomes an error with its id that says what to ask for; of a list those that do not fit beside the ones before them,
/// so that what a short one tells is told. Errors that this makes may exceed the limit by some hundred bytes each.
/// context: pure.
[[nodiscard]] std::string line_within(nlohmann::ordered_json reply, std::size_t most_bytes);

}  // namespace fvd
