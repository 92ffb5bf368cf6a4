#include "daemon/api/access.hpp"

#include <algorithm>

namespace fvd {

bool may_call(const Caller& caller, const MethodDescription& method) {
  return std::find(method.callers.begin(), method.callers.end(), caller.role) != method.callers.end();
}

}  // namespace fvd
