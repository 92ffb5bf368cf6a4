#include "core/metrology/artefact/grid_lattice.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <vector>

#include <Eigen/Dense>

#include "core/metrology/real_fft.hpp"

namespace fvd::metrology {
namespace {

constexpr double kTurn = 2.0 * 3.14159265358979323846;
constexpr double kFewestPeriods = 1.8;  ///< in the image, of a wave that may be a grid's
constexpr double kShortestPeriod_px = 6.0;
constexpr double kSmallestTurn = 0.819;  ///< sine of 55 degrees: between the two waves
constexpr double kWeakestWave = 0.15;    ///< amplitude of the second over that of the first
constexpr double kSmallestAmplitude = 0.02;

/// A wave cos(2 pi frequency . place + phase).
struct Wave {
  Eigen::Vector2d frequency = Eigen::Vector2d::Zero();  ///< periods a pixel
  double phase = 0.0;
};

double hann(int i, int n) { return 0.5 - 0.5 * std::cos(kTurn * (i + 0.5) / n); }

/// Shares less their mean, under a Hann window; 0 in holes.
struct Windowed {
  Plane<double> values;
  double weight = 0.0;
};

Windowed windowed(const Plane<float>& shares) {
  Windowed result{Plane<double>(shares.width(), shares.height()), 0.0};
  double sum = 0.0;
  for (int pass = 0; pass < 2; ++pass) {
    const double mean = pass == 0 ? 0.0 : sum / result.weight;
    for (int y = 0; y < shares.height(); ++y) {
      const double row = hann(y, shares.height());
      for (int x = 0; x < shares.width(); ++x) {
        const double share = static_cast<double>(shares.at(x, y));
        if (std::isnan(share)) continue;
        const double weight = row * hann(x, shares.width());
        if (pass == 0) {
          sum += weight * share;
          result.weight += weight;
        } else {
          result.values.at(x, y) = weight * (share - mean);
        }
      }
    }
  }
  return result;
}

/// |spectrum| with frequencies (column, row) / size, rows beyond the middle negative.
struct Spectrum {
  Plane<double> amplitude;
  int width = 0;
  int height = 0;

  [[nodiscard]] double at(int u, int v) const {
    if (u < 0) {
      u = -u;
      v = -v;
    }
    return amplitude.at(std::min(u, amplitude.width() - 1), ((v % height) + height) % height);
  }
};

Spectrum spectrum_of(const Windowed& picture) {
  const int width = RealFft::good_size(picture.values.width());
  const int height = RealFft::good_size(picture.values.height());
  RealFft fft(width, height);
  std::fill(fft.plane().begin(), fft.plane().end(), 0.0);
  for (int y = 0; y < picture.values.height(); ++y) {
    std::copy_n(picture.values.row(y), picture.values.width(),
                fft.plane().begin() + static_cast<std::ptrdiff_t>(y) * width);
  }
  fft.forward();
  Spectrum spectrum{Plane<double>(width / 2 + 1, height), width, height};
  std::transform(fft.spectrum().begin(), fft.spectrum().end(), spectrum.amplitude.pixels().begin(),
                 [](const std::complex<double>& value) { return std::abs(value); });
  return spectrum;
}

/// The top of a parabola through the logarithms of three neighbours, from the middle one.
double top(double before, double here, double after) {
  const double tiny = 1e-12 * here;
  const double a = std::log(before + tiny);
  const double b = std::log(here);
  const double c = std::log(after + tiny);
  const double bend = a - 2.0 * b + c;
  return bend < 0.0 ? std::clamp(0.5 * (a - c) / bend, -0.5, 0.5) : 0.0;
}

/// The strongest wave, of those at least 55 degrees from `other` if that is given.
std::optional<Wave> strongest(const Spectrum& spectrum, const Plane<float>& shares, const Wave* other) {
  double best = 0.0;
  int best_u = 0;
  int best_v = 0;
  for (int u = 0; u < spectrum.amplitude.width(); ++u) {
    for (int row = 0; row < spectrum.height; ++row) {
      const int v = row <= spectrum.height / 2 ? row : row - spectrum.height;
      const Eigen::Vector2d frequency(1.0 * u / spectrum.width, 1.0 * v / spectrum.height);
      const double length = frequency.norm();
      if (length * kShortestPeriod_px > 1.0) continue;
      if (std::hypot(frequency.x() * shares.width(), frequency.y() * shares.height()) < kFewestPeriods) continue;
      if (other != nullptr) {
        const Eigen::Vector2d& first = other->frequency;
        const double sine = std::abs(first.x() * frequency.y() - first.y() * frequency.x()) / (length * first.norm());
        if (sine < kSmallestTurn) continue;
      }
      const double here = spectrum.at(u, v);
      if (here <= best) continue;
      best = here;
      best_u = u;
      best_v = v;
    }
  }
  if (best == 0.0) return std::nullopt;
  const auto at = [&](int du, int dv) { return spectrum.at(best_u + du, best_v + dv); };
  Wave wave;
  wave.frequency = {(best_u + top(at(-1, 0), best, at(1, 0))) / spectrum.width,
                    (best_v + top(at(0, -1), best, at(0, 1))) / spectrum.height};
  return wave;
}

/// The wave's phase; its amplitude is returned.
double set_phase(Wave& wave, const Windowed& picture) {
  std::vector<std::complex<double>> columns(static_cast<std::size_t>(picture.values.width()));
  for (std::size_t x = 0; x < columns.size(); ++x) {
    columns[x] = std::polar(1.0, -kTurn * wave.frequency.x() * static_cast<double>(x));
  }
  std::complex<double> sum;
  for (int y = 0; y < picture.values.height(); ++y) {
    std::complex<double> row;
    for (std::size_t x = 0; x < columns.size(); ++x) row += picture.values.at(static_cast<int>(x), y) * columns[x];
    sum += row * std::polar(1.0, -kTurn * wave.frequency.y() * y);
  }
  wave.phase = std::arg(sum);
  return 2.0 * std::abs(sum) / picture.weight;
}

GridLattice lattice_of(const Wave& first, const Wave& second) {
  Eigen::Matrix2d frequencies;
  frequencies.row(0) = first.frequency.transpose();
  frequencies.row(1) = second.frequency.transpose();
  Eigen::Matrix2d steps = frequencies.inverse();
  GridLattice lattice;
  lattice.origin = steps * Eigen::Vector2d(-first.phase / kTurn, -second.phase / kTurn);
  const auto flatness = [&](int i) { return std::abs(steps.col(i).x()) / steps.col(i).norm(); };
  const int x = flatness(0) >= flatness(1) ? 0 : 1;
  lattice.step_x = steps.col(x);
  lattice.step_y = steps.col(1 - x);
  if (lattice.step_x.x() < 0.0) lattice.step_x *= -1.0;
  const double turn = lattice.step_x.x() * lattice.step_y.y() - lattice.step_x.y() * lattice.step_y.x();
  if (turn < 0.0) lattice.step_y *= -1.0;
  return lattice;
}

/// Mean share near crossings, half-way between them on the lines, and in the cells, of a lattice through the places
/// where both waves are highest.
std::array<double, 3> mean_shares(const Plane<float>& shares, const GridLattice& lattice) {
  std::array<double, 3> sums{};
  std::array<int, 3> counts{};
  for (int y = 0; y < shares.height(); ++y) {
    for (int x = 0; x < shares.width(); ++x) {
      const double share = static_cast<double>(shares.at(x, y));
      if (std::isnan(share)) continue;
      const Eigen::Vector2d index = lattice.index({1.0 * x, 1.0 * y});
      std::size_t cells = 0;
      bool near = true;
      for (const double coordinate : {index.x(), index.y()}) {
        const double off = std::abs(coordinate - std::round(coordinate));
        near = near && (off < 0.1 || off > 0.4);
        cells += off > 0.4 ? 1 : 0;
      }
      if (!near) continue;
      sums[cells] += share;
      ++counts[cells];
    }
  }
  for (std::size_t i = 0; i < 3; ++i) sums[i] /= std::max(counts[i], 1);
  return sums;
}

}  // namespace

Eigen::Vector2d GridLattice::index(const Eigen::Vector2d& place) const {
  const Eigen::Vector2d from = place - origin;
  const double turn = step_x.x() * step_y.y() - step_x.y() * step_y.x();
  return {(from.x() * step_y.y() - from.y() * step_y.x()) / turn,
          (step_x.x() * from.y() - step_x.y() * from.x()) / turn};
}

double GridLattice::spacing_px(int family) const {
  const double area = step_x.x() * step_y.y() - step_x.y() * step_y.x();
  return area / (family == 0 ? step_y : step_x).norm();
}

Eigen::Vector2d GridLattice::along(int family) const { return (family == 0 ? step_y : step_x).normalized(); }

Eigen::Vector2d GridLattice::across(int family) const {
  const Eigen::Vector2d line = along(family);
  return family == 0 ? Eigen::Vector2d(line.y(), -line.x()) : Eigen::Vector2d(-line.y(), line.x());
}

std::optional<FoundLattice> find_lattice(const Plane<float>& shares) {
  const Windowed picture = windowed(shares);
  if (!(picture.weight > 0.0)) return std::nullopt;
  const Spectrum spectrum = spectrum_of(picture);
  std::optional<Wave> first = strongest(spectrum, shares, nullptr);
  if (!first) return std::nullopt;
  std::optional<Wave> second = strongest(spectrum, shares, &*first);
  if (!second) return std::nullopt;
  const double amplitude = set_phase(*first, picture);
  const double other = set_phase(*second, picture);
  if (amplitude < kSmallestAmplitude || other < kWeakestWave * amplitude) return std::nullopt;

  FoundLattice found;
  found.lattice = lattice_of(*first, *second);
  const std::array<double, 3> means = mean_shares(shares, found.lattice);
  found.raised = 2.0 * means[1] > means[0] + means[2];
  // Sunk lines cross where both waves are lowest.
  if (!found.raised) found.lattice.origin = found.lattice.place(0.5, 0.5);
  return found;
}

}  // namespace fvd::metrology
