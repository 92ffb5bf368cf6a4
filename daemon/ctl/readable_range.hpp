#pragma once

/// Checks of numbers whose refusals people can read: CLI11's own write the largest double with 309 digits.

#include <cmath>
#include <cstdint>
#include <locale>
#include <sstream>
#include <string>

#include <CLI/CLI.hpp>

namespace fvd::ctl {

/// As CLI::Range for real numbers, with the bounds as people write them. NaN and infinity are refused.
class NumberRangeCheck : public CLI::Validator {
 public:
  NumberRangeCheck(double least, double most) {
    std::ostringstream range;
    range.imbue(std::locale::classic());
    range << least << " to " << most;
    description("FLOAT in [" + range.str() + "]");
    func_ = [least, most, bounds = range.str()](const std::string& text) {
      double value = 0.0;
      const bool is_number = CLI::detail::lexical_cast(text, value) && std::isfinite(value);
      if (is_number && value >= least && value <= most) return std::string();
      return "'" + text + "' is no number from " + bounds;
    };
  }
};

/// A finite number above 0.
class PositiveCheck : public CLI::Validator {
 public:
  PositiveCheck() {
    description("FLOAT above 0");
    func_ = [](const std::string& text) {
      double value = 0.0;
      const bool is_number = CLI::detail::lexical_cast(text, value) && std::isfinite(value);
      return is_number && value > 0.0 ? std::string() : "'" + text + "' is no number above 0";
    };
  }
};

/// A whole number, 0 or above.
class CountCheck : public CLI::Validator {
 public:
  CountCheck() {
    description("INT, 0 or above");
    func_ = [](const std::string& text) {
      std::int64_t value = 0;
      const bool is_number = CLI::detail::lexical_cast(text, value);
      return is_number && value >= 0 ? std::string() : "'" + text + "' is no whole number of 0 or above";
    };
  }
};

}  // namespace fvd::ctl
