#include "core/metrology/filter/moment_rows.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "core/metrology/real_fft.hpp"

namespace fvd::metrology {
namespace {

/// Waves of which the kernel passes less than this share of its sum are rounding.
constexpr double kNothing = 2e-15;
constexpr std::int64_t kBandBytes = 128'000'000;
/// Complex numbers of one cache line.
constexpr std::size_t kWavesOfABlock = 4;

/// Place of the first wave of a block in one row.
std::size_t block_place(std::size_t block, std::size_t rows, std::size_t row) {
  return (block * rows + row) * kWavesOfABlock;
}

int reach_of(const std::vector<double>& half, int size) {
  return std::min(static_cast<int>(half.size()) - 1, std::max(size - 1, 0));
}

/// Transform of d^power * half(|d|) on a circle of n points: real for even powers, else i times what this returns.
std::vector<double> transform_of(const std::vector<double>& half, int reach, double unit, int power, int n) {
  std::vector<double> wave(static_cast<std::size_t>(n));
  for (int i = 0; i < n; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / n;
    wave[static_cast<std::size_t>(i)] = power % 2 == 0 ? std::cos(angle) : -std::sin(angle);
  }
  std::vector<double> weighted(static_cast<std::size_t>(reach) + 1);
  for (int d = 0; d <= reach; ++d) {
    weighted[static_cast<std::size_t>(d)] = std::pow(d / unit, power) * half[static_cast<std::size_t>(d)];
  }
  std::vector<double> result(static_cast<std::size_t>(n / 2 + 1));
  for (int f = 0; f <= n / 2; ++f) {
    double sum = 0.0;
    int place = 0;
    for (int d = 1; d <= reach; ++d) {
      place += f;
      if (place >= n) place -= n;
      sum += weighted[static_cast<std::size_t>(d)] * wave[static_cast<std::size_t>(place)];
    }
    result[static_cast<std::size_t>(f)] = 2.0 * sum + (power == 0 ? weighted[0] : 0.0);
  }
  return result;
}

/// Waves from the longest one on that any of the transforms passes.
std::size_t waves_that_pass(const std::vector<std::vector<double>>& transforms) {
  std::size_t count = 1;
  for (const std::vector<double>& transform : transforms) {
    for (std::size_t f = count; f < transform.size(); ++f) {
      if (std::abs(transform[f]) > kNothing) count = f + 1;
    }
  }
  return count;
}

/// out = in times the transform, for the first count waves.
void multiply(const std::complex<double>* in, const double* transform, bool odd, std::size_t count,
              std::complex<double>* out) {
  for (std::size_t f = 0; f < count; ++f) {
    const double re = transform[f] * in[f].real();
    const double im = transform[f] * in[f].imag();
    out[f] = odd ? std::complex<double>(-im, re) : std::complex<double>(re, im);
  }
}

}  // namespace

struct MomentRows::Impl {
  int width = 0;
  int height = 0;
  int reach_x = 0;
  int reach_y = 0;
  int band_rows = 0;
  int fft_width = 0;
  int fft_height = 0;
  std::size_t waves_x = 0;
  std::size_t blocks = 0;  ///< of waves_x
  std::size_t waves_y = 0;
  WorkerPool* pool = nullptr;
  std::vector<std::vector<double>> along_x;  ///< transforms of the kernel, one for each power
  std::vector<std::vector<double>> along_y;
  std::vector<std::unique_ptr<RealFft>> rows;  ///< one for each lane
  std::vector<std::unique_ptr<RealFft>> columns;

  [[nodiscard]] int bands() const { return (height + band_rows - 1) / band_rows; }
  [[nodiscard]] int first_row(int band) const { return std::min(band * band_rows, height); }
  [[nodiscard]] int first_source_row(int band) const { return std::max(first_row(band) - reach_y, 0); }
  [[nodiscard]] int end_source_row(int band) const { return std::min(first_row(band + 1) + reach_y, height); }
  [[nodiscard]] int lanes() const { return static_cast<int>(rows.size()); }
  /// Past the ends of the plane zeros keep the circle's two ends apart; elsewhere what wraps is not used.
  [[nodiscard]] int needed_height() const {
    int needed = 1;
    for (int band = 0; band < bands(); ++band) {
      const int before = first_row(band) - first_source_row(band);
      const int after = end_source_row(band) - first_row(band + 1);
      needed = std::max(needed, end_source_row(band) - first_source_row(band) + reach_y - std::min(before, after));
    }
    return needed;
  }
  /// body(lane, index) for [0, count), a piece for each lane.
  void share_out(int count, const std::function<void(int, int)>& body) const {
    const auto piece = [&](int lane) {
      const int end = static_cast<int>(static_cast<std::int64_t>(count) * (lane + 1) / lanes());
      for (int i = static_cast<int>(static_cast<std::int64_t>(count) * lane / lanes()); i < end; ++i) body(lane, i);
    };
    run_lanes(pool, lanes(), std::ref(piece));
  }
  [[nodiscard]] std::vector<std::complex<double>> transform_rows(const Plane<double>& source, int band) const;
  void sum_column(const std::vector<std::complex<double>>& from, int source_rows, std::size_t wave, int offset,
                  int lane, Band& to) const;
};

/// Blocks as those of a band, with the rows that it is made from.
std::vector<std::complex<double>> MomentRows::Impl::transform_rows(const Plane<double>& source, int band) const {
  const int first = first_source_row(band);
  const int count = end_source_row(band) - first;
  std::vector<std::complex<double>> result(static_cast<std::size_t>(count) * blocks * kWavesOfABlock);
  share_out(count, [&](int lane, int i) {
    RealFft& fft = *rows[static_cast<std::size_t>(lane)];
    std::copy_n(source.row(first + i), width, fft.plane().begin());
    std::fill(fft.plane().begin() + width, fft.plane().end(), 0.0);
    fft.forward();
    for (std::size_t block = 0; block < blocks; ++block) {
      const std::size_t from = block * kWavesOfABlock;
      const std::size_t place = block_place(block, static_cast<std::size_t>(count), static_cast<std::size_t>(i));
      std::copy_n(fft.spectrum().data() + from, std::min(kWavesOfABlock, waves_x - from), result.data() + place);
    }
  });
  return result;
}

/// One wave along x: its real and its imaginary part are rows along y, each summed with every power.
void MomentRows::Impl::sum_column(const std::vector<std::complex<double>>& from, int source_rows, std::size_t wave,
                                  int offset, int lane, Band& to) const {
  RealFft& fft = *columns[static_cast<std::size_t>(lane)];
  const std::span<double> plane = fft.plane();
  const std::size_t band_points = to.waves.front().size() / (blocks * kWavesOfABlock);
  const std::size_t block = wave / kWavesOfABlock;
  const std::size_t in_block = wave % kWavesOfABlock;
  const std::complex<double>* column =
      from.data() + block_place(block, static_cast<std::size_t>(source_rows), 0) + in_block;
  std::vector<std::complex<double>> spectrum(waves_y);
  for (const bool imaginary : {false, true}) {
    for (std::size_t y = 0; y < static_cast<std::size_t>(source_rows); ++y) {
      const std::complex<double>& value = column[y * kWavesOfABlock];
      plane[y] = imaginary ? value.imag() : value.real();
    }
    std::fill(plane.begin() + source_rows, plane.end(), 0.0);
    fft.forward();
    std::copy_n(fft.spectrum().begin(), waves_y, spectrum.begin());
    for (std::size_t power = 0; power < to.waves.size(); ++power) {
      multiply(spectrum.data(), along_y[power].data(), power % 2 == 1, waves_y, fft.spectrum().data());
      std::fill(fft.spectrum().begin() + static_cast<std::ptrdiff_t>(waves_y), fft.spectrum().end(), 0.0);
      fft.inverse();
      for (std::size_t y = 0; y < band_points; ++y) {
        std::complex<double>& value = to.waves[power][block_place(block, band_points, y) + in_block];
        const double found = plane[y + static_cast<std::size_t>(offset)];
        value = imaginary ? std::complex<double>(value.real(), found) : std::complex<double>(found, 0.0);
      }
    }
  }
}

MomentRows::MomentRows(int width, int height, const SeparableKernel& kernel, int highest_power, int kept,
                       WorkerPool* pool)
    : impl_(std::make_unique<Impl>()) {
  assert(width >= 1 && height >= 1 && highest_power >= 0 && kept >= 1);
  impl_->width = width;
  impl_->height = height;
  impl_->pool = pool;
  impl_->reach_x = reach_of(kernel.half_x, width);
  impl_->reach_y = reach_of(kernel.half_y, height);
  impl_->fft_width = RealFft::good_size(width + impl_->reach_x);
  for (int power = 0; power <= highest_power; ++power) {
    impl_->along_x.push_back(transform_of(kernel.half_x, impl_->reach_x, kernel.unit_x_px, power, impl_->fft_width));
  }
  impl_->waves_x = waves_that_pass(impl_->along_x);
  impl_->blocks = (impl_->waves_x + kWavesOfABlock - 1) / kWavesOfABlock;
  const auto bytes = static_cast<std::int64_t>(impl_->waves_x * sizeof(std::complex<double>)) * (kept + 1) * height;
  const auto count = static_cast<int>((bytes + kBandBytes - 1) / kBandBytes);
  impl_->band_rows = (height + count - 1) / count;
  impl_->fft_height = RealFft::good_size(impl_->needed_height());
  for (int power = 0; power <= highest_power; ++power) {
    impl_->along_y.push_back(transform_of(kernel.half_y, impl_->reach_y, kernel.unit_y_px, power, impl_->fft_height));
  }
  impl_->waves_y = waves_that_pass(impl_->along_y);
  for (int lane = 0; lane < (pool == nullptr ? 1 : pool->threads()); ++lane) {
    impl_->rows.push_back(std::make_unique<RealFft>(impl_->fft_width, 1));
    impl_->columns.push_back(std::make_unique<RealFft>(impl_->fft_height, 1));
  }
}

MomentRows::~MomentRows() = default;

int MomentRows::bands() const { return impl_->bands(); }

int MomentRows::first_row(int band) const { return impl_->first_row(band); }

int MomentRows::lanes() const { return impl_->lanes(); }

MomentRows::Band MomentRows::load(const Plane<double>& source, int band, int highest_y) {
  assert(source.width() == impl_->width && source.height() == impl_->height);
  const std::vector<std::complex<double>> transformed = impl_->transform_rows(source, band);
  Band result;
  result.first_row = first_row(band);
  result.waves.resize(static_cast<std::size_t>(highest_y) + 1);
  for (auto& waves : result.waves) {
    waves.resize(static_cast<std::size_t>(first_row(band + 1) - first_row(band)) * impl_->blocks * kWavesOfABlock);
  }
  const int first_source = impl_->first_source_row(band);
  impl_->share_out(static_cast<int>(impl_->waves_x), [&](int lane, int wave) {
    impl_->sum_column(transformed, impl_->end_source_row(band) - first_source, static_cast<std::size_t>(wave),
                      first_row(band) - first_source, lane, result);
  });
  return result;
}

void MomentRows::sum_row(const Band& band, int row, MomentPower power, int lane, double* sums) {
  RealFft& fft = *impl_->rows[static_cast<std::size_t>(lane)];
  const std::vector<std::complex<double>>& waves = band.waves[static_cast<std::size_t>(power.y)];
  const std::vector<double>& transform = impl_->along_x[static_cast<std::size_t>(power.x)];
  const std::size_t rows = waves.size() / (impl_->blocks * kWavesOfABlock);
  const auto row_of_band = static_cast<std::size_t>(row - band.first_row);
  for (std::size_t block = 0; block < impl_->blocks; ++block) {
    const std::size_t from = block * kWavesOfABlock;
    multiply(waves.data() + block_place(block, rows, row_of_band), transform.data() + from, power.x % 2 == 1,
             std::min(kWavesOfABlock, impl_->waves_x - from), fft.spectrum().data() + from);
  }
  std::fill(fft.spectrum().begin() + static_cast<std::ptrdiff_t>(impl_->waves_x), fft.spectrum().end(), 0.0);
  fft.inverse();
  std::copy_n(fft.plane().begin(), impl_->width, sums);
}

void MomentRows::each_row(int band, const std::function<void(int, int)>& body) {
  const int first = first_row(band);
  impl_->share_out(first_row(band + 1) - first, [&](int lane, int i) { body(lane, first + i); });
}

void run_lanes(WorkerPool* pool, int lanes, const std::function<void(int)>& body) {
  if (pool != nullptr) {
    pool->run(lanes, body);
    return;
  }
  for (int lane = 0; lane < lanes; ++lane) body(lane);
}

}  // namespace fvd::metrology
