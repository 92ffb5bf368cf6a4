#include "daemon/result/value_digits.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <locale>
#include <sstream>

namespace fvd {

namespace {

constexpr int kMostDigits = 6;
constexpr int kDigitsWithoutU = 4;
constexpr std::string_view kNotches = "notches";  ///< the only value that counts something

}  // namespace

int digits_behind_point(std::string_view key, const EvaluatedValue& value) {
  if (key == kNotches) return 0;
  const double scale = value.expanded_u.value_or(0.0);
  if (!(scale > 0.0)) return kDigitsWithoutU;
  return std::clamp(1 - static_cast<int>(std::floor(std::log10(scale))), 0, kMostDigits);
}

std::string fixed_digits(double number, int digits) {
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text << std::fixed << std::setprecision(digits) << number;
  return text.str();
}

}  // namespace fvd
