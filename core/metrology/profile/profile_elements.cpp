#include "core/metrology/profile/profile_elements.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace fvd::metrology {
namespace {

/// What lies between two crossings, on one side of the line.
struct Piece {
  bool is_hill = false;
  double begin_um = 0.0;
  double end_um = 0.0;
  double extreme_um = 0.0;  ///< height of a hill, depth of a dale, not negative
};

/// Pieces of the points [first, end), none of them a hole. Points on the line belong to the piece before them.
std::vector<Piece> pieces_of(std::span<const double> z, double pitch_um) {
  std::vector<Piece> pieces;
  std::size_t last_off_line = 0;
  for (std::size_t i = 0; i < z.size(); ++i) {
    if (z[i] == 0.0) continue;
    const bool is_hill = z[i] > 0.0;
    if (pieces.empty()) {
      pieces.push_back({is_hill, 0.0, 0.0, 0.0});
    } else if (pieces.back().is_hill != is_hill) {
      // Straight between neighbours; the middle of the points that lie on the line.
      const auto a = static_cast<double>(last_off_line);
      const auto b = static_cast<double>(i);
      const double share = i == last_off_line + 1 ? z[last_off_line] / (z[last_off_line] - z[i]) : 0.5;
      const double crossing_um = (a + share * (b - a)) * pitch_um;
      pieces.back().end_um = crossing_um;
      pieces.push_back({is_hill, crossing_um, 0.0, 0.0});
    }
    pieces.back().extreme_um = std::max(pieces.back().extreme_um, std::abs(z[i]));
    last_off_line = i;
  }
  if (!pieces.empty()) pieces.back().end_um = static_cast<double>(z.size() - 1) * pitch_um;
  return pieces;
}

/// Leaves out what does not count and joins neighbours of one kind.
template <typename Counts>
std::vector<Piece> joined(const std::vector<Piece>& pieces, const Counts& counts) {
  std::vector<Piece> result;
  for (const Piece& piece : pieces) {
    if (!counts(piece)) continue;
    if (!result.empty() && result.back().is_hill == piece.is_hill) {
      result.back().end_um = piece.end_um;
      result.back().extreme_um = std::max(result.back().extreme_um, piece.extreme_um);
    } else {
      result.push_back(piece);
    }
  }
  return result;
}

struct Sums {
  std::size_t crossings = 0;
  std::size_t elements = 0;
  double length_um = 0.0;
  double height_um = 0.0;
};

void add_run(std::span<const double> z, double pitch_um, const ElementDiscrimination& least, Sums& sums) {
  // Heights first: a hill that noise splits near the line is whole again before its length is asked for.
  const std::vector<Piece> high = joined(pieces_of(z, pitch_um), [&](const Piece& piece) {
    return piece.extreme_um >= (piece.is_hill ? least.hill_um : least.dale_um);
  });
  const std::vector<Piece> pieces =
      joined(high, [&](const Piece& piece) { return piece.end_um - piece.begin_um >= least.length_um; });
  if (pieces.size() < 2) return;
  sums.crossings += pieces.size() - 1;
  const auto crossing_um = [&](std::size_t k) { return 0.5 * (pieces[k].end_um + pieces[k + 1].begin_um); };
  for (std::size_t k = 1; k + 2 < pieces.size(); ++k) {
    ++sums.elements;
    sums.length_um += crossing_um(k + 1) - crossing_um(k - 1);
    sums.height_um += pieces[k].extreme_um + pieces[k + 1].extreme_um;
  }
}

}  // namespace

ProfileElements find_profile_elements(std::span<const double> z_um, double pitch_um,
                                      const ElementDiscrimination& discrimination) {
  Sums sums;
  for (std::size_t first = 0; first < z_um.size();) {
    std::size_t end = first;
    while (end < z_um.size() && !std::isnan(z_um[end])) ++end;
    add_run(z_um.subspan(first, end - first), pitch_um, discrimination, sums);
    first = end + 1;
  }
  ProfileElements result{sums.crossings, sums.elements, {}, {}};
  if (sums.elements > 0) {
    result.mean_length_um = sums.length_um / static_cast<double>(sums.elements);
    result.mean_height_um = sums.height_um / static_cast<double>(sums.elements);
  }
  return result;
}

}  // namespace fvd::metrology
