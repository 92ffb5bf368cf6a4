#pragma once

/// The query of a request for heights.

#include <map>
#include <optional>
#include <string>
#include <variant>

#include "daemon/surface_files/file_bytes.hpp"
#include "daemon/views/height_view.hpp"
#include "daemon/views/result_maps.hpp"

namespace fvd {

/// No side of an answer is longer, whatever is asked for.
inline constexpr int kLongestViewSide = 2048;

struct HeightQuery {
  MapKind kind = MapKind::kHeight;
  int x = 0;  ///< of the window, in points, as the next ones
  int y = 0;
  std::optional<int> width;  ///< absent = all that remains, as the next one
  std::optional<int> height;
  int most = 512;  ///< no side of the answer is longer
};

/// kind, x, y, w, h and max. A text instead: what is wrong with the query.
[[nodiscard]] std::variant<HeightQuery, std::string> read_height_query(const std::map<std::string, std::string>& query);

/// The window in a map of that size; nothing where it leaves the map.
[[nodiscard]] std::optional<ViewWindow> window_in(const HeightQuery& query, const GridSize& size);

}  // namespace fvd
