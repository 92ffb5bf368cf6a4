#pragma once

/// Fourier transforms of real planes, by FFTW 3 in double precision.

#include <complex>
#include <memory>
#include <span>

namespace fvd::metrology {

/// One size, both directions, with buffers of its own. Results are the same bytes in every run on one machine: plans
/// are estimated, never timed. context: one thread an object; making and destroying them is safe from several.
class RealFft {
 public:
  /// width, height >= 1; height 1 for a profile. Best where both have no prime factor above 7, see good_size().
  RealFft(int width, int height);
  ~RealFft();
  RealFft(const RealFft&) = delete;
  RealFft& operator=(const RealFft&) = delete;

  /// Row-major, width * height.
  [[nodiscard]] std::span<double> plane();
  /// Row-major, (width / 2 + 1) * height.
  [[nodiscard]] std::span<std::complex<double>> spectrum();
  /// plane() -> spectrum(), not scaled; plane() keeps its values.
  void forward();
  /// spectrum() -> plane(), divided by width * height; spectrum() is destroyed.
  void inverse();

  /// The smallest size >= n whose only prime factors are 2, 3, 5 and 7.
  [[nodiscard]] static int good_size(int n);

 private:
  struct Plans;
  std::unique_ptr<Plans> plans_;
};

}  // namespace fvd::metrology
