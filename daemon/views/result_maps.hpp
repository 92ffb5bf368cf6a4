#pragma once

/// The maps of a stored result, as viewers ask for them.

#include <array>
#include <atomic>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "core/base/mutex.hpp"
#include "daemon/surface_files/map_rows.hpp"

namespace fvd {

enum class MapKind {
  kHeight,   ///< metres
  kSigma,    ///< standard errors, metres
  kTexture,  ///< grey levels of the all-in-focus image, as recorded
  kReason    ///< sums of mask_reason bits; 0 = valid
};
inline constexpr std::array kAllMapKinds{MapKind::kHeight, MapKind::kSigma, MapKind::kTexture, MapKind::kReason};

/// "height", "sigma", "texture", "reason".
[[nodiscard]] std::string_view map_kind_name(MapKind kind) noexcept;
[[nodiscard]] std::optional<MapKind> map_kind_from_name(std::string_view name) noexcept;

struct OpenedMap {
  std::shared_ptr<const MapRows> rows;
  std::string tag;  ///< another one once the file is another; letters, digits and "-"
};

/// Each map is opened when it is first asked for: heights and standard errors stay in their file where the format
/// allows, pictures are held in memory. context: thread-safe; one caller at a time opens.
class ResultMaps {
 public:
  explicit ResultMaps(std::filesystem::path folder) : folder_(std::move(folder)) {}

  [[nodiscard]] const std::filesystem::path& folder() const noexcept { return folder_; }
  /// Nothing where the result has no such file; a link is none. Throws Error kSurfaceFile where it cannot be read, or
  /// is not of the heights' size.
  [[nodiscard]] std::optional<OpenedMap> find(MapKind kind);
  /// What is held in memory. Waits for nobody.
  [[nodiscard]] std::size_t bytes() const noexcept { return bytes_.load(); }

 private:
  std::optional<OpenedMap> find_locked(MapKind kind) FVD_REQUIRES(mutex_);
  [[nodiscard]] std::optional<OpenedMap> open_locked(MapKind kind) FVD_REQUIRES(mutex_);

  const std::filesystem::path folder_;
  std::atomic<std::size_t> bytes_{0};
  Mutex mutex_;
  std::array<std::optional<OpenedMap>, kAllMapKinds.size()> opened_ FVD_GUARDED_BY(mutex_);
};

}  // namespace fvd
