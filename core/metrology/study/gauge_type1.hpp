#pragma once

/// Capability of a gauge from one part measured many times (type 1 study).

#include <optional>
#include <span>

namespace fvd::metrology {

struct GaugeType1Settings {
  double reference = 0.0;        ///< true value of the part
  double tolerance = 0.0;        ///< T = upper - lower limit, > 0
  double tolerance_share = 0.2;  ///< of T that the gauge may use
  double spread_sd = 6.0;        ///< width of the gauge's spread in standard deviations
  std::optional<double> resolution;
  double required = 1.33;  ///< of Cg and Cgk
};

struct GaugeType1 {
  int n = 0;
  double mean = 0.0;
  double bias = 0.0;                         ///< mean - reference
  double sd = 0.0;                           ///< s, n - 1
  std::optional<double> cg;                  ///< share T / (spread s); absent where s is 0
  std::optional<double> cgk;                 ///< (share/2 T - |bias|) / (spread/2 s); absent where s is 0
  std::optional<double> t;                   ///< |bias| sqrt(n) / s
  std::optional<double> p_value;             ///< two-sided, n - 1 degrees of freedom
  bool bias_significant = false;             ///< p below 0.05; where s is 0: any bias
  std::optional<double> resolution_percent;  ///< %RE = 100 resolution / T; 5 is the usual limit
  bool capable = false;                      ///< Cg and Cgk reach what is required; where s is 0: no bias above share/2
};

/// Usual practice of the motor industry (MSA 4, VDA 5 as "MPE"-free type 1 study). At least 2 values; 25 is the usual
/// least number and the caller's matter. Throws Error(kBadInput) for fewer than 2 values or T <= 0. context: pure.
[[nodiscard]] GaugeType1 gauge_type1(std::span<const double> values, const GaugeType1Settings& settings);

}  // namespace fvd::metrology
