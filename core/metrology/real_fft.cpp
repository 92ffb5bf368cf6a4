#include "core/metrology/real_fft.hpp"

#include <cassert>
#include <cstddef>
#include <new>

#include <fftw3.h>

#include "core/base/mutex.hpp"

namespace fvd::metrology {
namespace {

/// FFTW's planner has one state for the whole process; only executing a plan is safe from several threads.
Mutex& planner_mutex() {
  static Mutex mutex;
  return mutex;
}

struct FreeFftw {
  void operator()(void* memory) const { fftw_free(memory); }
};

}  // namespace

struct RealFft::Plans {
  int width = 0;
  int height = 0;
  std::unique_ptr<double[], FreeFftw> plane;
  std::unique_ptr<fftw_complex[], FreeFftw> spectrum;
  fftw_plan forward = nullptr;
  fftw_plan inverse = nullptr;

  [[nodiscard]] std::size_t plane_size() const {
    return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  }
  [[nodiscard]] std::size_t spectrum_size() const {
    return static_cast<std::size_t>(width / 2 + 1) * static_cast<std::size_t>(height);
  }
};

RealFft::RealFft(int width, int height) : plans_(std::make_unique<Plans>()) {
  assert(width >= 1 && height >= 1);
  plans_->width = width;
  plans_->height = height;
  plans_->plane.reset(fftw_alloc_real(plans_->plane_size()));
  plans_->spectrum.reset(fftw_alloc_complex(plans_->spectrum_size()));
  if (!plans_->plane || !plans_->spectrum) throw std::bad_alloc();
  MutexLock lock(planner_mutex());
  plans_->forward = fftw_plan_dft_r2c_2d(height, width, plans_->plane.get(), plans_->spectrum.get(),
                                         FFTW_ESTIMATE | FFTW_PRESERVE_INPUT);
  plans_->inverse = fftw_plan_dft_c2r_2d(height, width, plans_->spectrum.get(), plans_->plane.get(), FFTW_ESTIMATE);
}

RealFft::~RealFft() {
  MutexLock lock(planner_mutex());
  fftw_destroy_plan(plans_->forward);
  fftw_destroy_plan(plans_->inverse);
}

std::span<double> RealFft::plane() { return {plans_->plane.get(), plans_->plane_size()}; }

std::span<std::complex<double>> RealFft::spectrum() {
  // FFTW's complex numbers are two doubles, as std::complex<double> is (FFTW 3.3 manual, "Complex numbers").
  return {reinterpret_cast<std::complex<double>*>(plans_->spectrum.get()), plans_->spectrum_size()};
}

void RealFft::forward() { fftw_execute(plans_->forward); }

void RealFft::inverse() {
  fftw_execute(plans_->inverse);
  const double scale = 1.0 / static_cast<double>(plans_->plane_size());
  for (double& value : plane()) value *= scale;
}

int RealFft::good_size(int n) {
  for (int size = n;; ++size) {
    int rest = size;
    for (const int factor : {2, 3, 5, 7}) {
      while (rest % factor == 0) rest /= factor;
    }
    if (rest == 1) return size;
  }
}

}  // namespace fvd::metrology
