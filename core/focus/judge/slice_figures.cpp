#include "core/focus/judge/slice_figures.hpp"

#include <algorithm>
#include <cstring>
#include <numeric>

namespace fvd {

namespace {

constexpr int kMaxTiles = 12;
constexpr int kMinTile_px = 24;
constexpr int kReach_px = 2;        // of a second difference
constexpr int kRowsPerTile = 6;     // looked at closely
constexpr int kSampleColumns = 40;  // at most, of a row of a tile

template <typename Pixel>
std::uint64_t sum_of(const Pixel* row, int count) noexcept {
  std::uint32_t sum = 0;  // of at most 65536 pixels of 16 bit
  std::uint64_t total = 0;
  while (count > 0) {
    const int part = std::min(count, 65536);
    sum = 0;
    for (int x = 0; x < part; ++x) sum += row[x];
    total += sum;
    row += part;
    count -= part;
  }
  return total;
}

/// Adds the squared second differences of `count` pixels; the first of 8 bit fit 32 bits for up to 4096 pixels.
template <typename Pixel>
void add_energies(const Pixel* above, const Pixel* row, const Pixel* below, int count,
                  std::array<double, kDirections>& energies) noexcept {
  using Sum = std::conditional_t<sizeof(Pixel) == 1, std::uint32_t, float>;
  Sum along = 0;
  Sum down = 0;
  Sum falling = 0;
  Sum rising = 0;
  for (int x = 0; x < count; ++x) {
    const int twice = 2 * row[x];
    const auto square = [](int difference) {
      if constexpr (sizeof(Pixel) == 1) return static_cast<Sum>(difference * difference);
      if constexpr (sizeof(Pixel) == 2) return static_cast<Sum>(difference) * static_cast<Sum>(difference);
    };
    along += square(twice - row[x - kReach_px] - row[x + kReach_px]);
    down += square(twice - above[x] - below[x]);
    falling += square(twice - above[x - kReach_px] - below[x + kReach_px]);
    rising += square(twice - above[x + kReach_px] - below[x - kReach_px]);
  }
  energies[0] += static_cast<double>(along);
  energies[1] += static_cast<double>(down);
  energies[2] += static_cast<double>(falling);
  energies[3] += static_cast<double>(rising);
}

/// Of one tile: its right and bottom ends are not of it.
struct TileArea {
  int left, right, top, bottom;
};

template <typename Pixel>
double mean_of(PlaneView<const Pixel> image, const TileArea& area) noexcept {
  std::uint64_t sum = 0;
  int rows = 0;
  for (int y = area.top; y < area.bottom; y += 2, ++rows)
    sum += sum_of(image.row(y) + area.left, area.right - area.left);
  return static_cast<double>(sum) / (static_cast<double>(rows) * (area.right - area.left));
}

template <typename Pixel>
void look_closely(PlaneView<const Pixel> image, const TileArea& area, int columns, std::uint16_t* samples,
                  std::array<double, kDirections>& energies) noexcept {
  const int left = std::max(area.left, kReach_px);
  const int right = std::min(area.right, image.width - kReach_px);
  const int top = std::max(area.top, kReach_px);
  const int bottom = std::min(area.bottom, image.height - kReach_px);
  for (int i = 0; i < kRowsPerTile; ++i) {
    const int y = top + (bottom - top) * i / kRowsPerTile;
    const Pixel* row = image.row(y);
    for (int x = left; x < right; x += 4096) {
      add_energies(image.row(y - kReach_px) + x, row + x, image.row(y + kReach_px) + x, std::min(4096, right - x),
                   energies);
    }
    for (int column = 0; column < columns; ++column) *samples++ = row[left + (right - left) * column / columns];
  }
  for (double& energy : energies) energy /= static_cast<double>(kRowsPerTile) * (right - left);
}

template <typename Pixel>
SliceFigures figures_of(PlaneView<const Pixel> image, const TileGrid& grid) {
  SliceFigures figures;
  figures.columns = grid.columns;
  figures.rows = grid.rows;
  const auto tiles = static_cast<std::size_t>(grid.tiles());
  const int columns = std::min(kSampleColumns, image.width / grid.columns - 2 * kReach_px);
  figures.samples_per_tile = kRowsPerTile * columns;
  figures.means.resize(tiles);
  figures.energies.resize(tiles);
  figures.samples.resize(tiles * static_cast<std::size_t>(figures.samples_per_tile));
  std::size_t tile = 0;
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column, ++tile) {
      const TileArea area{grid.left(column), grid.left(column + 1), grid.top(row), grid.top(row + 1)};
      figures.means[tile] = mean_of(image, area);
      look_closely(image, area, columns,
                   figures.samples.data() + tile * static_cast<std::size_t>(figures.samples_per_tile),
                   figures.energies[tile]);
    }
  }
  return figures;
}

std::size_t row_bytes(const ImageView& slice) noexcept {
  return static_cast<std::size_t>(slice.width) * static_cast<std::size_t>(bytes_per_pixel(slice.format));
}

const std::byte* row_of(const ImageView& slice, int y) noexcept {
  return slice.data + static_cast<std::ptrdiff_t>(y) * slice.row_stride_bytes;
}

}  // namespace

TileGrid::TileGrid(int width_px, int height_px) noexcept
    : width(width_px),
      height(height_px),
      columns(std::clamp(width_px / kMinTile_px, 1, kMaxTiles)),
      rows(std::clamp(height_px / kMinTile_px, 1, kMaxTiles)) {}

double SliceFigures::sharpness(int tile) const noexcept {
  const auto& energy = energies[static_cast<std::size_t>(tile)];
  return std::accumulate(energy.begin(), energy.end(), 0.0) / kDirections;
}

double SliceFigures::brightness() const noexcept {
  return means.empty() ? 0.0 : std::accumulate(means.begin(), means.end(), 0.0) / static_cast<double>(means.size());
}

SliceFigures slice_figures(const ImageView& slice) {
  const TileGrid grid(slice.width, slice.height);
  if (!grid.judged()) return {};
  SliceFigures figures = slice.format == PixelFormat::kMono8 ? figures_of(slice.as<std::uint8_t>(), grid)
                                                             : figures_of(slice.as<std::uint16_t>(), grid);
  figures.full_scale = max_grey_level(slice.format);
  return figures;
}

bool is_constant(const ImageView& slice) noexcept {
  // A row is constant if it equals itself moved by one pixel; all others equal the first.
  const std::size_t bytes = row_bytes(slice);
  const auto pixel = static_cast<std::size_t>(bytes_per_pixel(slice.format));
  const std::byte* first = slice.data;
  if (std::memcmp(first, first + pixel, bytes - pixel) != 0) return false;
  for (int y = 1; y < slice.height; ++y) {
    if (std::memcmp(first, row_of(slice, y), bytes) != 0) return false;
  }
  return true;
}

bool is_identical(const ImageView& a, const ImageView& b) noexcept {
  if (a.width != b.width || a.height != b.height || a.format != b.format) return false;
  for (int y = 0; y < a.height; ++y) {
    if (std::memcmp(row_of(a, y), row_of(b, y), row_bytes(a)) != 0) return false;
  }
  return true;
}

std::uint64_t content_hash(const ImageView& slice) noexcept {
  constexpr std::uint64_t kPrime = 0x9E3779B97F4A7C15U;
  std::array<std::uint64_t, 4> lanes{1, 2, 3, 4};
  const std::size_t bytes = row_bytes(slice);
  for (int y = 0; y < slice.height; ++y) {
    const std::byte* row = row_of(slice, y);
    std::size_t at = 0;
    std::array<std::uint64_t, 4> words{};
    for (; at + sizeof words <= bytes; at += sizeof words) {
      std::memcpy(words.data(), row + at, sizeof words);
      for (std::size_t i = 0; i < 4; ++i) lanes[i] = (lanes[i] ^ words[i]) * kPrime;
    }
    words = {};
    std::memcpy(words.data(), row + at, bytes - at);
    for (std::size_t i = 0; i < 4; ++i) lanes[i] = ((lanes[i] ^ words[i]) * kPrime) ^ (lanes[i] >> 29U);
  }
  std::uint64_t hash = 0;
  for (const std::uint64_t lane : lanes) hash = (hash ^ lane ^ (lane >> 31U)) * kPrime;
  return hash;
}

}  // namespace fvd
