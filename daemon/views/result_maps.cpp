#include "daemon/views/result_maps.hpp"

#include <algorithm>

#include "daemon/surface_files/png_rows.hpp"
#include "daemon/surface_files/result_folder.hpp"
#include "daemon/views/file_tag.hpp"

namespace fvd {

namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, kAllMapKinds.size()> kNames{"height", "sigma", "texture", "reason"};

/// The file that holds the map; empty = there is none.
fs::path file_of(MapKind kind, const fs::path& folder) {
  const auto plain = [&folder](const char* name) { return is_plain_file(folder / name) ? folder / name : fs::path(); };
  switch (kind) {
    case MapKind::kHeight:
      return heights_file(folder);
    case MapKind::kSigma:
      return sigma_file(folder);
    case MapKind::kTexture:
      return plain("texture.png");
    case MapKind::kReason:
      return plain("mask.png");
  }
  return {};
}

void check_size(const fs::path& path, const GridSize& size, const std::optional<OpenedMap>& heights) {
  if (!heights) return;
  const GridSize wanted = heights->rows->size();
  if (size.width == wanted.width && size.height == wanted.height) return;
  refuse(path, "size",
         std::to_string(size.width) + " x " + std::to_string(size.height) + " points, the heights have " +
             std::to_string(wanted.width) + " x " + std::to_string(wanted.height));
}

}  // namespace

std::string_view map_kind_name(MapKind kind) noexcept { return kNames[static_cast<std::size_t>(kind)]; }

std::optional<MapKind> map_kind_from_name(std::string_view name) noexcept {
  const auto found = std::find(kNames.begin(), kNames.end(), name);
  if (found == kNames.end()) return std::nullopt;
  return kAllMapKinds[static_cast<std::size_t>(found - kNames.begin())];
}

std::optional<OpenedMap> ResultMaps::find(MapKind kind) {
  const MutexLock lock(mutex_);
  return find_locked(kind);
}

std::optional<OpenedMap> ResultMaps::find_locked(MapKind kind) {
  std::optional<OpenedMap>& opened = opened_[static_cast<std::size_t>(kind)];
  if (opened) return opened;
  opened = open_locked(kind);
  if (opened) bytes_ += opened->rows->bytes();
  return opened;
}

std::optional<OpenedMap> ResultMaps::open_locked(MapKind kind) {
  const fs::path path = file_of(kind, folder_);
  if (path.empty()) return std::nullopt;
  const std::string tag = file_tag(path);
  if (kind == MapKind::kHeight) return OpenedMap{open_map_rows(path), tag};
  const std::optional<OpenedMap> heights = find_locked(MapKind::kHeight);
  if (kind == MapKind::kSigma) {
    OpenedMap sigma{open_map_rows(path), tag};
    check_size(path, sigma.rows->size(), heights);
    return sigma;
  }
  check_size(path, png_size(path), heights);  // before memory is taken for what the head tells
  return OpenedMap{open_png_rows(path), tag};
}

}  // namespace fvd
