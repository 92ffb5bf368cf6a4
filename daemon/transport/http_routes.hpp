#pragma once

/// Which resource a path belongs to.

#include <string_view>
#include <vector>

#include "daemon/transport/http_resource.hpp"

namespace fvd {

/// The one with the longest path that the asked one is, or lies below; null where there is none. "/api/v1/events" does
/// not hold "/api/v1/events2"; "/" holds all.
[[nodiscard]] const MountedResource* resource_for(const std::vector<MountedResource>& resources, std::string_view path);

}  // namespace fvd
