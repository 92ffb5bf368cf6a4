#include "core/metrology/filter/band_moments.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <complex>
#include <cstddef>
#include <memory>
#include <numbers>

#include "core/metrology/real_fft.hpp"

namespace fvd::metrology {
namespace {

/// Points of a band: all its sums of a local paraboloid take 21 * 8 bytes each.
constexpr std::int64_t kBandPoints = 1'200'000;

int reach_of(const std::vector<double>& half, int size) {
  return std::min(static_cast<int>(half.size()) - 1, std::max(size - 1, 0));
}

/// Transform of d^power * half(|d|) on a circle of n points: real for even powers, else i times what this returns.
std::vector<double> transform_of(const std::vector<double>& half, int reach, double unit, int power, int n, int count) {
  std::vector<double> wave(static_cast<std::size_t>(n));
  for (int i = 0; i < n; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / n;
    wave[static_cast<std::size_t>(i)] = power % 2 == 0 ? std::cos(angle) : -std::sin(angle);
  }
  std::vector<double> weighted(static_cast<std::size_t>(reach) + 1);
  for (int d = 0; d <= reach; ++d) {
    weighted[static_cast<std::size_t>(d)] = std::pow(d / unit, power) * half[static_cast<std::size_t>(d)];
  }
  std::vector<double> result(static_cast<std::size_t>(count));
  for (int f = 0; f < count; ++f) {
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

}  // namespace

struct BandMoments::Impl {
  int width = 0;
  int height = 0;
  int reach_x = 0;
  int reach_y = 0;
  int band_rows = 0;
  int fft_width = 0;
  int fft_height = 0;
  WorkerPool* pool = nullptr;
  std::vector<std::vector<double>> along_x;  ///< transforms of the kernel, one for each power
  std::vector<std::vector<double>> along_y;
  std::vector<std::unique_ptr<RealFft>> lanes;
  std::vector<std::complex<double>> spectrum;

  [[nodiscard]] int bands() const { return (height + band_rows - 1) / band_rows; }
  [[nodiscard]] int first_row(int band) const { return std::min(band * band_rows, height); }
  [[nodiscard]] int first_source_row(int band) const { return std::max(first_row(band) - reach_y, 0); }
  [[nodiscard]] int end_source_row(int band) const { return std::min(first_row(band + 1) + reach_y, height); }
  void set_sizes();
  void load(const Plane<double>& source, int band);
  void multiply(MomentPower power, std::span<std::complex<double>> out) const;
};

void BandMoments::Impl::set_sizes() {
  const std::int64_t points = static_cast<std::int64_t>(width) * height;
  const auto count = static_cast<int>((points + kBandPoints - 1) / kBandPoints);
  band_rows = (height + count - 1) / count;
  fft_width = RealFft::good_size(width + reach_x);
  int needed = 1;
  for (int band = 0; band < bands(); ++band) {
    // Past the ends of the plane zeros keep the circle's two ends apart; elsewhere what wraps is not used.
    const int rows = end_source_row(band) - first_source_row(band);
    const int before = first_row(band) - first_source_row(band);
    const int after = end_source_row(band) - first_row(band + 1);
    needed = std::max(needed, rows + std::max(reach_y - before, reach_y - after));
  }
  fft_height = RealFft::good_size(needed);
}

void BandMoments::Impl::load(const Plane<double>& source, int band) {
  const std::span<double> plane = lanes.front()->plane();
  std::fill(plane.begin(), plane.end(), 0.0);
  const int first = first_source_row(band);
  for (int y = first; y < end_source_row(band); ++y) {
    std::copy_n(source.row(y), width, plane.data() + static_cast<std::ptrdiff_t>(y - first) * fft_width);
  }
  lanes.front()->forward();
  const std::span<std::complex<double>> found = lanes.front()->spectrum();
  spectrum.assign(found.begin(), found.end());
}

void BandMoments::Impl::multiply(MomentPower power, std::span<std::complex<double>> out) const {
  const std::vector<double>& factor_x = along_x[static_cast<std::size_t>(power.x)];
  const std::vector<double>& factor_y = along_y[static_cast<std::size_t>(power.y)];
  const int odd = power.x % 2 + power.y % 2;
  const std::size_t columns = factor_x.size();
  for (std::size_t y = 0; y < factor_y.size(); ++y) {
    const double row_factor = odd == 2 ? -factor_y[y] : factor_y[y];  // i * i
    const std::complex<double>* in = spectrum.data() + y * columns;
    std::complex<double>* result = out.data() + y * columns;
    if (odd == 1) {
      for (std::size_t x = 0; x < columns; ++x) {
        const double factor = row_factor * factor_x[x];
        result[x] = {-factor * in[x].imag(), factor * in[x].real()};
      }
    } else {
      for (std::size_t x = 0; x < columns; ++x) {
        const double factor = row_factor * factor_x[x];
        result[x] = {factor * in[x].real(), factor * in[x].imag()};
      }
    }
  }
}

BandMoments::BandMoments(int width, int height, const SeparableKernel& kernel, int highest_power, WorkerPool* pool)
    : impl_(std::make_unique<Impl>()) {
  assert(width >= 1 && height >= 1 && highest_power >= 0);
  impl_->width = width;
  impl_->height = height;
  impl_->pool = pool;
  impl_->reach_x = reach_of(kernel.half_x, width);
  impl_->reach_y = reach_of(kernel.half_y, height);
  impl_->set_sizes();
  for (int power = 0; power <= highest_power; ++power) {
    impl_->along_x.push_back(transform_of(kernel.half_x, impl_->reach_x, kernel.unit_x_px, power, impl_->fft_width,
                                          impl_->fft_width / 2 + 1));
    impl_->along_y.push_back(
        transform_of(kernel.half_y, impl_->reach_y, kernel.unit_y_px, power, impl_->fft_height, impl_->fft_height));
  }
  const int lanes = pool == nullptr ? 1 : pool->threads();
  for (int lane = 0; lane < lanes; ++lane) {
    impl_->lanes.push_back(std::make_unique<RealFft>(impl_->fft_width, impl_->fft_height));
  }
}

BandMoments::~BandMoments() = default;

int BandMoments::bands() const { return impl_->bands(); }

int BandMoments::first_row(int band) const { return impl_->first_row(band); }

void BandMoments::compute(const Plane<double>& source, int band, std::span<const MomentPower> powers,
                          std::span<Plane<double>> sums) {
  assert(source.width() == impl_->width && source.height() == impl_->height && powers.size() == sums.size());
  impl_->load(source, band);
  const int rows = first_row(band + 1) - first_row(band);
  const int offset = first_row(band) - impl_->first_source_row(band);
  const auto lanes = static_cast<int>(impl_->lanes.size());
  const auto fill = [&](int lane) {
    RealFft& fft = *impl_->lanes[static_cast<std::size_t>(lane)];
    for (auto k = static_cast<std::size_t>(lane); k < powers.size(); k += static_cast<std::size_t>(lanes)) {
      impl_->multiply(powers[k], fft.spectrum());
      fft.inverse();
      if (sums[k].width() != impl_->width || sums[k].height() != rows) {
        sums[k] = Plane<double>::unset(impl_->width, rows);
      }
      for (int y = 0; y < rows; ++y) {
        std::copy_n(fft.plane().data() + static_cast<std::ptrdiff_t>(y + offset) * impl_->fft_width, impl_->width,
                    sums[k].row(y));
      }
    }
  };
  run_lanes(impl_->pool, lanes, std::ref(fill));
}

void run_lanes(WorkerPool* pool, int lanes, const std::function<void(int)>& body) {
  if (pool != nullptr) {
    pool->run(lanes, body);
    return;
  }
  for (int lane = 0; lane < lanes; ++lane) body(lane);
}

}  // namespace fvd::metrology
