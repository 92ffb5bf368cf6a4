#pragma once

/// One of the twenty cases with known figures: what is measured against the sampling's own value and the closed form.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <string_view>

#include <gtest/gtest.h>

namespace fvd::metrology::reference {

inline constexpr long double kPi = 3.14159265358979323846264338327950288L;

/// Records the worst relative deviation as the property reference_NN, and the number of points as points_NN.
class ReferenceCase {
 public:
  ReferenceCase(int number, long points) : number_(number), points_(points) {}
  ReferenceCase(const ReferenceCase&) = delete;
  ReferenceCase& operator=(const ReferenceCase&) = delete;
  ~ReferenceCase() {
    const std::string name = (number_ < 10 ? "0" : "") + std::to_string(number_);
    char text[32];
    static_cast<void>(std::snprintf(text, sizeof text, "%.3e", worst_));
    ::testing::Test::RecordProperty("reference_" + name, text);
    ::testing::Test::RecordProperty("points_" + name, std::to_string(points_));
  }

  /// measured: by the code under test. exact: of the same sample points, made in long double in another way. closed:
  /// the figure that is printed for the surface itself, which exact may miss by `bound`. scale: what deviations are
  /// relative to where the figure is 0.
  void compare(std::string_view name, double measured, long double exact, double closed, double bound,
               double scale = 0.0) {
    const double relative = std::abs(measured - static_cast<double>(exact)) / std::max(std::abs(closed), scale);
    EXPECT_LT(relative, 1e-6) << number_ << ' ' << name << ": " << measured << " instead of "
                              << static_cast<double>(exact);
    EXPECT_NEAR(static_cast<double>(exact), closed, bound) << number_ << ' ' << name;
    worst_ = std::max(worst_, relative);
  }

 private:
  int number_;
  long points_;
  double worst_ = 0.0;
};

}  // namespace fvd::metrology::reference
