#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include <gtest/gtest.h>

#include "core/metrology/filter/profile_filter.hpp"
#include "core/metrology/filter/surface_filter.hpp"
#include "core/metrology/profile/profile_evaluation.hpp"
#include "tests/core/metrology/reference/reference_case.hpp"

namespace fvd::metrology::reference {
namespace {

/// ISO 16610-21 clause 4: the Gaussian's density at a distance, nesting index 1.
long double gaussian(long double distance) {
  const long double alpha_squared = std::log(2.0L) / kPi;
  return std::exp(-kPi * distance * distance / alpha_squared);
}

/// What a sampled Gaussian passes of a wave, both in points.
long double passes(long double nesting, long double wavelength) {
  long double sum = 1.0L;
  long double wave = 1.0L;
  for (int i = 1; static_cast<long double>(i) < 3.0L * nesting; ++i) {
    const long double weight = 2.0L * gaussian(i / nesting);
    sum += weight;
    wave += weight * std::cos(2.0L * kPi * i / wavelength);
  }
  return wave / sum;
}

double wave(double x, double wavelength) {
  return static_cast<double>(std::sin(2.0L * kPi * static_cast<long double>(x) / static_cast<long double>(wavelength)));
}

TEST(FilterCase, EightIsTheGaussiansTransmission) {
  constexpr int kPoints = 1201;
  ReferenceCase reference(8, kPoints);
  struct Case {
    double ratio;
    double percent;
  };
  for (const Case& expected : {Case{0.5, 6.25}, Case{1.0, 50.0}, Case{2.0, 84.08964}}) {
    const double wavelength = 100.0 * expected.ratio;
    std::vector<double> z;
    for (int i = 0; i < kPoints; ++i) z.push_back(wave(i - 600 + wavelength / 4.0, wavelength));

    const FilteredProfile smooth = filter_profile(z, 1.0, {.side = FilterSide::kS, .nesting_um = 100.0});

    reference.compare("transmission", 100.0 * smooth.z_um[600],
                      100.0L * passes(100.0L, static_cast<long double>(wavelength)), expected.percent, 1e-5);
  }
}

TEST(FilterCase, EightPassesAQuarterOfAWaveInTwoDirections) {
  constexpr int kSize = 501;
  ReferenceCase reference(8, kSize * kSize);
  HeightField field{Plane<double>(kSize, kSize), {}, 1.0, 1.0, {}};
  for (int y = 0; y < kSize; ++y) {
    for (int x = 0; x < kSize; ++x) field.z_um.at(x, y) = 5.0 * wave(x - 225, 100.0) * wave(y - 225, 100.0);
  }

  const FilteredSurface smooth = filter_surface(field, {.side = FilterSide::kS, .nesting_um = 100.0});

  const long double both = passes(100.0L, 100.0L) * passes(100.0L, 100.0L);
  reference.compare("egg box", 20.0 * smooth.surface.z_um.at(250, 250), 100.0L * both, 25.0, 1e-9);
}

TEST(FilterCase, NinePartsWavinessAndRoughness) {
  constexpr int kPoints = 3200;
  ReferenceCase reference(9, kPoints);
  Profile profile{{}, 1.0};
  for (int i = 0; i < kPoints; ++i) profile.z_um.push_back(5.0 * wave(i + 0.5, 800.0) + wave(i + 0.5, 80.0));
  const ProfileSettings settings{
      .nesting_um = 250.0, .method = FilterMethod::kGaussian, .sections = 5, .section_length_um = 320.0};
  const std::array<ProfileParameter, 2> asked{ProfileParameter::kRq, ProfileParameter::kWq};

  const ProfileResult made = evaluate_profile(profile, asked, settings);
  const FilteredProfile rest = filter_profile(profile.z_um, 1.0, {.side = FilterSide::kL, .nesting_um = 250.0});

  const long double smooth_long = 5.0L * passes(250.0L, 800.0L);
  const long double smooth_short = passes(250.0L, 80.0L);
  const long double rest_long = 5.0L - smooth_long;
  const long double rest_short = 1.0L - smooth_short;
  double in_phase_with_long = 0.0;
  double in_phase_with_short = 0.0;
  for (std::size_t i = 800; i < 2400; ++i) {  // whole periods of both
    const double x = static_cast<double>(i) + 0.5;
    in_phase_with_long += rest.z_um[i] * wave(x, 800.0) / 800.0;
    in_phase_with_short += rest.z_um[i] * wave(x, 80.0) / 800.0;
  }
  reference.compare("R, 800", in_phase_with_long, rest_long, 0.3272500, 2e-7);
  reference.compare("R, 80", in_phase_with_short, rest_short, 0.9988512, 2e-7);
  reference.compare("Rq", made.values.at(0).value.value(),
                    std::sqrt((rest_long * rest_long + rest_short * rest_short) / 2.0L), 0.7432349, 1e-6);
  reference.compare("Wq", made.values.at(1).value.value(),
                    std::sqrt((smooth_long * smooth_long + smooth_short * smooth_short) / 2.0L), 3.304133, 1e-6);
}

TEST(FilterCase, FifteenIsASlopeBesideABorder) {
  constexpr int kPoints = 2000;
  constexpr long double kPitch = 0.25L;
  ReferenceCase reference(15, kPoints);
  std::vector<double> z;
  for (int i = 0; i < kPoints; ++i) z.push_back(0.1 * (i + 0.5) * static_cast<double>(kPitch));
  // At the border itself, half a pitch before the first point: the parabola through the first three values.
  const auto at_border = [](const auto& three) { return (15 * three[0] - 10 * three[1] + 3 * three[2]) / 8; };
  std::array<long double, 3> exact{};
  for (std::size_t i = 0; i < exact.size(); ++i) {
    long double sum = 0.0L;
    long double weights = 0.0L;
    for (int j = 0; static_cast<long double>(j) * kPitch < 240.0L; ++j) {
      const long double weight = gaussian((j - static_cast<long double>(i)) * kPitch / 80.0L);
      sum += weight * 0.1L * (j + 0.5L) * kPitch;
      weights += weight;
    }
    exact[i] = sum / weights;
  }

  for (const FilterMethod method :
       {FilterMethod::kGaussian, FilterMethod::kGaussianRegression1, FilterMethod::kGaussianRegression2}) {
    const FilteredProfile smooth =
        filter_profile(z, static_cast<double>(kPitch), {.side = FilterSide::kS, .nesting_um = 80.0, .method = method});

    const double measured = at_border(smooth.z_um);
    if (method == FilterMethod::kGaussian) {
      reference.compare("order 0", measured, at_border(exact), 1.19613, 2e-5);
    } else {
      reference.compare("orders 1 and 2", measured, 0.0L, 0.0, 0.0, 1.19613);
    }
  }
}

}  // namespace
}  // namespace fvd::metrology::reference
