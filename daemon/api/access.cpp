#include "daemon/api/access.hpp"

namespace fvd {

bool may_call(const Caller& caller, const MethodDescription& method) { return caller.who.role >= method.role; }

}  // namespace fvd
