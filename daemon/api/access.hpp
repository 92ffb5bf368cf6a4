#pragma once

/// The place where it is decided who may call what.

#include "daemon/api/caller.hpp"
#include "daemon/api/method.hpp"

namespace fvd {

/// True if the caller's role is the method's or one that may more.
[[nodiscard]] bool may_call(const Caller& caller, const MethodDescription& method);

}  // namespace fvd
