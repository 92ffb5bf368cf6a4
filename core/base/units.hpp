#pragma once

/// Lengths along the optical axis as types, so that a stage count can never be taken for a micrometre.

#include <compare>
#include <cstdint>

namespace fvd {

/// A length or position in micrometres. Any finite value.
struct Micrometers {
  double value = 0.0;

  constexpr auto operator<=>(const Micrometers&) const = default;
  constexpr Micrometers& operator+=(Micrometers other) {
    value += other.value;
    return *this;
  }
  constexpr Micrometers& operator-=(Micrometers other) {
    value -= other.value;
    return *this;
  }
};

constexpr Micrometers operator+(Micrometers a, Micrometers b) { return {a.value + b.value}; }
constexpr Micrometers operator-(Micrometers a, Micrometers b) { return {a.value - b.value}; }
constexpr Micrometers operator-(Micrometers a) { return {-a.value}; }
constexpr Micrometers operator*(Micrometers a, double factor) { return {a.value * factor}; }
constexpr Micrometers operator*(double factor, Micrometers a) { return a * factor; }
constexpr double operator/(Micrometers a, Micrometers b) { return a.value / b.value; }
constexpr Micrometers abs(Micrometers a) { return a.value < 0 ? -a : a; }

/// A position in the drive's own steps, as it stands in a 32-bit register.
struct StageCounts {
  std::int32_t value = 0;

  constexpr auto operator<=>(const StageCounts&) const = default;
};

inline namespace literals {
constexpr Micrometers operator""_um(long double value) { return {static_cast<double>(value)}; }
constexpr Micrometers operator""_um(unsigned long long value) { return {static_cast<double>(value)}; }
}  // namespace literals

/// Metres in files and metrics, micrometres everywhere else.
constexpr double kMetresPerMicrometer = 1e-6;

}  // namespace fvd
