#pragma once

/// Capability of a measuring system and process, VDA 5 and ISO 22514-7.

#include <optional>

#include "core/metrology/study/gauge_rr.hpp"
#include "core/metrology/study/gauge_type1.hpp"

namespace fvd::metrology {

/// Standard uncertainties in the unit of the value; 0 = does not apply.
struct CapabilityInputs {
  double calibration = 0.0;   ///< of the reference, u_CAL
  double linearity = 0.0;     ///< u_LIN
  double stability = 0.0;     ///< u_STAB
  double object = 0.0;        ///< of the part's form, u_OBJ
  double temperature = 0.0;   ///< u_T
  double rest_system = 0.0;   ///< u_MS-REST
  double rest_process = 0.0;  ///< u_REST
  double tolerance = 0.0;     ///< T, > 0
  double k = 2.0;
};

struct Capability {
  double u_system = 0.0;           ///< u_MS
  double u_process = 0.0;          ///< u_MP
  double q_system_percent = 0.0;   ///< Q_MS = 100 * 2 U_MS / T
  double q_process_percent = 0.0;  ///< Q_MP
  bool system_capable = false;     ///< Q_MS <= 15
  bool process_capable = false;    ///< Q_MP <= 30
};

/// u_MS^2 = CAL^2 + max(EVR, RE)^2 + BI^2 + LIN^2 + MS-REST^2 and
/// u_MP^2 = CAL^2 + max(EVR, EVO, RE)^2 + BI^2 + LIN^2 + AV^2 + IA^2 + STAB^2 + OBJ^2 + T^2 + MS-REST^2 + REST^2, with
/// EVR = s of the type 1 study, EVO, AV, IA = EV, AV, INT of the ANOVA, BI = |bias| / sqrt(3), RE = resolution /
/// sqrt(12). VDA 5:2010, 4.5 and 5; ISO 22514-7:2021. Throws Error(kBadInput) for T <= 0. context: pure.
[[nodiscard]] Capability capability(const GaugeType1& type1, std::optional<double> resolution, const GaugeRr& rr,
                                    const CapabilityInputs& inputs);

}  // namespace fvd::metrology
