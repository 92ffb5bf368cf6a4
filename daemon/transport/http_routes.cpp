#include "daemon/transport/http_routes.hpp"

namespace fvd {

namespace {

bool holds(std::string_view mount, std::string_view path) {
  if (path.substr(0, mount.size()) != mount) return false;
  return path.size() == mount.size() || mount.ends_with('/') || path[mount.size()] == '/';
}

}  // namespace

const MountedResource* resource_for(const std::vector<MountedResource>& resources, std::string_view path) {
  const MountedResource* found = nullptr;
  for (const MountedResource& mounted : resources) {
    if (mounted.resource == nullptr || !holds(mounted.path, path)) continue;
    if (found == nullptr || mounted.path.size() > found->path.size()) found = &mounted;
  }
  return found;
}

}  // namespace fvd
