#pragma once

/// Answers that several resources give.

#include <string>

#include "daemon/transport/http_gate.hpp"
#include "daemon/transport/http_resource.hpp"

namespace fvd {

/// A line of JSON: {"error", "message"}.
[[nodiscard]] ResourceAnswer refused(const HttpRefusal& refusal);

/// 304. etag: in its quotes.
[[nodiscard]] ResourceAnswer not_modified(const std::string& etag, const std::string& cache_control);

/// The shortest text from which the number reads back, with a point; finite.
[[nodiscard]] std::string number_text(double value);

}  // namespace fvd
