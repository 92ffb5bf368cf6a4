#include "core/metrology/operations/chosen_points.hpp"

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <limits>

#include "core/metrology/operations/bands.hpp"
#include "core/metrology/region_bounds.hpp"

namespace fvd::metrology {
namespace {

struct Block {
  int first_column = 0;
  int end_column = 0;
  int first_row = 0;
  int end_row = 0;
  std::size_t points = 0;
};

Block block_of_rows(const HeightField& field, const Region& region, int begin_row, int end_row) {
  Block block{field.width(), 0, field.height(), 0, 0};
  for (int row = begin_row; row < end_row; ++row) {
    const double* z = field.z_um.row(row);
    const std::uint8_t* inside = region.empty() ? nullptr : region.row(row);
    const auto is_chosen = [z, inside](int column) {
      return z[column] == z[column] && (inside == nullptr || inside[column] != 0);
    };
    const int from = inside == nullptr ? 0 : region_bounds::first_inside(inside, field.width());
    if (from == field.width()) continue;
    const int to = inside == nullptr ? field.width() : region_bounds::end_inside(inside, field.width());
    std::size_t points = 0;
    for (int column = from; column < to; ++column) points += is_chosen(column) ? 1U : 0U;
    if (points == 0) continue;
    int first = from;
    while (!is_chosen(first)) ++first;
    int end = to;
    while (!is_chosen(end - 1)) --end;
    block.first_column = std::min(block.first_column, first);
    block.end_column = std::max(block.end_column, end);
    block.first_row = std::min(block.first_row, row);
    block.end_row = row + 1;
    block.points += points;
  }
  return block;
}

Block block_of(const HeightField& field, const Region& region, WorkerPool* pool) {
  std::vector<Block> of_bands(static_cast<std::size_t>(band_count(field.height())));
  run_bands(pool, field.height(), [&](int band, int first, int end) {
    of_bands[static_cast<std::size_t>(band)] = block_of_rows(field, region, first, end);
  });
  Block block{field.width(), 0, field.height(), 0, 0};
  for (const Block& band : of_bands) {
    block.first_column = std::min(block.first_column, band.first_column);
    block.end_column = std::max(block.end_column, band.end_column);
    block.first_row = std::min(block.first_row, band.first_row);
    block.end_row = std::max(block.end_row, band.end_row);
    block.points += band.points;
  }
  return block;
}

/// (2 i + 1 - count) / count: exactly the negative of its mirror image.
std::vector<double> normal_coordinates(int count) {
  std::vector<double> coordinates;
  for (int i = 0; i < count; ++i) coordinates.push_back(static_cast<double>(2 * i + 1 - count) / count);
  return coordinates;
}

}  // namespace

ChosenPoints choose_points(const HeightField& field, const Region& region, bool with_sigma, WorkerPool* pool) {
  assert(region.empty() || (region.width() == field.width() && region.height() == field.height()));
  const Block block = block_of(field, region, pool);
  ChosenPoints chosen;
  if (block.points == 0) return chosen;
  const int columns = block.end_column - block.first_column;
  const int rows = block.end_row - block.first_row;
  chosen.points = block.points;
  chosen.x = normal_coordinates(columns);
  chosen.y = normal_coordinates(rows);
  chosen.half_x_um = 0.5 * columns * field.pitch_x_um;
  chosen.half_y_um = 0.5 * rows * field.pitch_y_um;
  chosen.centre_x_um = 0.5 * (block.first_column + block.end_column) * field.pitch_x_um;
  chosen.centre_y_um = 0.5 * (block.first_row + block.end_row) * field.pitch_y_um;
  chosen.z_um = Plane<double>::unset(columns, rows);
  if (with_sigma && field.has_sigma()) chosen.sigma_um = Plane<float>::unset(columns, rows);
  run_bands(pool, rows, [&](int, int first, int end) {
    for (int row = first; row < end; ++row) {
      const int y = block.first_row + row;
      std::copy_n(field.z_um.row(y) + block.first_column, columns, chosen.z_um.row(row));
      if (!chosen.sigma_um.empty()) {
        std::copy_n(field.sigma_um.row(y) + block.first_column, columns, chosen.sigma_um.row(row));
      }
      if (region.empty()) continue;
      const std::uint8_t* inside = region.row(y) + block.first_column;
      double* z = chosen.z_um.row(row);
      for (int column = 0; column < columns; ++column) {
        if (inside[column] == 0) z[column] = std::numeric_limits<double>::quiet_NaN();
      }
    }
  });
  return chosen;
}

}  // namespace fvd::metrology
