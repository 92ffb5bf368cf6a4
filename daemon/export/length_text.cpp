#include "daemon/export/length_text.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <limits>

namespace fvd {

namespace {

constexpr long double kMicrometresPerMetre = 1e6L;
constexpr int kMostDigits = 21;  // of a long double

}  // namespace

std::string metres_text(double um, int count) {
  const long double metres = static_cast<long double>(um) * count / kMicrometresPerMetre;
  std::array<char, 64> text{};
  std::string_view written;
  for (int digits = 1; digits <= kMostDigits; ++digits) {
    const auto end =
        std::to_chars(text.data(), text.data() + text.size(), metres, std::chars_format::general, digits).ptr;
    written = {text.data(), static_cast<std::size_t>(end - text.data())};
    if (micrometres_of_text(written, count) == um) break;
  }
  return std::string(written);
}

std::optional<double> micrometres_of_text(std::string_view metres, int count) {
  long double value = 0.0L;
  const auto [end, error] = std::from_chars(metres.data(), metres.data() + metres.size(), value);
  if (error != std::errc() || end != metres.data() + metres.size()) return std::nullopt;
  return static_cast<double>(value * kMicrometresPerMetre / count);
}

double micrometres_of(double metres) {
  if (!std::isfinite(metres)) return metres;
  std::array<char, 32> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), metres).ptr;
  return micrometres_of_text({text.data(), static_cast<std::size_t>(end - text.data())}).value_or(metres);
}

double metres_of(double um) {
  const auto nearest = static_cast<double>(static_cast<long double>(um) / kMicrometresPerMetre);
  constexpr double kUp = std::numeric_limits<double>::infinity();
  for (const double metres : {nearest, std::nextafter(nearest, 0.0), std::nextafter(nearest, kUp)}) {
    if (micrometres_of(metres) == um) return metres;
  }
  return nearest;
}

}  // namespace fvd
