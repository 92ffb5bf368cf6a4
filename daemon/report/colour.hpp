#pragma once

/// Colours of drawn pages.

namespace fvd {

/// sRGB, each part 0..1.
struct Colour {
  double red = 0.0;
  double green = 0.0;
  double blue = 0.0;
};

namespace colour {
inline constexpr Colour kInk{0.13, 0.13, 0.13};
inline constexpr Colour kPaleInk{0.42, 0.42, 0.42};
inline constexpr Colour kRule{0.78, 0.78, 0.78};
inline constexpr Colour kGrid{0.90, 0.90, 0.90};
inline constexpr Colour kPaper{1.0, 1.0, 1.0};
inline constexpr Colour kHole{0.67, 0.67, 0.67};
inline constexpr Colour kLine{0.08, 0.25, 0.55};
inline constexpr Colour kRegion{0.45, 0.62, 0.85};
inline constexpr Colour kFit{0.85, 0.35, 0.05};
inline constexpr Colour kGood{0.05, 0.50, 0.20};
inline constexpr Colour kBad{0.75, 0.08, 0.08};
inline constexpr Colour kDoubt{0.80, 0.48, 0.00};
}  // namespace colour

}  // namespace fvd
