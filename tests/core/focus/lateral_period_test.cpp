#include "core/focus/lateral_period.hpp"

#include "gtest/gtest.h"

namespace fvd {
namespace {

/// Measured by bench_accuracy on sines of 3 um, white texture.
struct Measured {
  FocusSettings settings;
  std::optional<double> smooth_px;
  double period_px;
};

TEST(LateralPeriod, IsWhatTheBenchMeasured) {
  using enum FocusOperator;
  const FocusWindow box = FocusWindow::kBox;
  const FocusWindow both = FocusWindow::kDoubleBox;
  for (const auto& [settings, smooth_px, period_px] :
       {Measured{{.focus_operator = kModifiedLaplacian, .window = box, .window_px = 9, .distance_px = 2}, {}, 15.31},
        Measured{{.focus_operator = kModifiedLaplacian, .window = box, .window_px = 13, .distance_px = 3}, {}, 22.61},
        Measured{{.focus_operator = kModifiedLaplacian, .window = both, .window_px = 5, .distance_px = 1}, {}, 6.72},
        Measured{{.focus_operator = kDiagonalLaplacian, .window = both, .window_px = 9, .distance_px = 2}, {}, 14.29},
        Measured{{.focus_operator = kDiagonalLaplacian, .window = both, .window_px = 13, .distance_px = 3}, {}, 21.23},
        Measured{{.focus_operator = kTenengrad, .window = box, .window_px = 5, .distance_px = 3}, {}, 15.80},
        Measured{{.focus_operator = kTenengrad, .window = both, .window_px = 13, .distance_px = 2}, {}, 21.91},
        Measured{{.focus_operator = kDiagonalLaplacian, .window = both, .window_px = 5, .distance_px = 2}, 2.0, 9.44},
        Measured{{.focus_operator = kDiagonalLaplacian, .window = both, .window_px = 5, .distance_px = 2}, 4.0, 14.65},
        Measured{
            {.focus_operator = kDiagonalLaplacian, .window = both, .window_px = 5, .distance_px = 2}, 4.5, 16.30}}) {
    EXPECT_NEAR(lateral_period_px(settings, smooth_px) / period_px, 1.0, 0.05)
        << focus_operator_name(settings.focus_operator) << " " << settings.window_px << " " << settings.distance_px;
  }
}

TEST(LateralPeriod, GrowsWithWindowDistanceAndSmoothing) {
  const FocusSettings five{.window_px = 5};
  EXPECT_LT(lateral_period_px(five, {}), lateral_period_px({.window_px = 7}, {}));
  EXPECT_LT(lateral_period_px(five, {}), lateral_period_px({.window_px = 5, .distance_px = 3}, {}));
  EXPECT_LT(lateral_period_px(five, {}), lateral_period_px(five, 2.0));
  EXPECT_LT(lateral_period_px(five, 2.0), lateral_period_px(five, 4.0));
}

}  // namespace
}  // namespace fvd
