#pragma once

/// The constants of an instrument that were found on artefacts and accepted by a person.

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "config/fields.hpp"

namespace fvd {

/// Where constants come from, and until when they are trusted.
struct ConstantsOrigin {
  std::string study;        ///< identifier of the study that proposed them
  std::string person;       ///< who accepted them
  std::string certificate;  ///< number of the artefact's certificate; empty = none
  std::string accepted;     ///< UTC, "2026-11-29T20:15:00Z"
  std::string renew_by;     ///< the last day that they are trusted on, "2027-11-29"; empty = no end
  bool simulated = false;   ///< found with a simulator: they say nothing of an instrument
  bool operator==(const ConstantsOrigin&) const = default;
};

/// ISO 25178-600:2019, 3.1.10 and 3.1.11.
struct ZConstants {
  double alpha_z = 1.0;            ///< measured height over true height: heights are divided by it; 0.5..2
  double u_alpha_z = 0.0;          ///< standard uncertainty
  double linearity_um = 0.0;       ///< l_z: the largest residual, absolute; 0 = not known, as from one step
  double lead_amplitude_um = 0.0;  ///< of the screw's periodic error, 0 = not known
  double lead_um = 0.0;            ///< its period
  ConstantsOrigin origin;
  bool operator==(const ZConstants&) const = default;
};

/// ISO 25178-600:2019, 3.1.12.
struct FlatnessConstants {
  double flatness_um = 0.0;     ///< z_FLT: Sz of the mean map of a flat after a plane
  double u_reference_um = 0.0;  ///< standard error of the reference map, quadratic mean over its points
  std::string reference;        ///< file of the reference map in the calibration's folder; empty = none is kept
  ConstantsOrigin origin;
  bool operator==(const FlatnessConstants&) const = default;
};

/// ISO 25178-600:2019, 3.1.15.
struct NoiseConstants {
  double noise_um = 0.0;  ///< N_M
  ConstantsOrigin origin;
  bool operator==(const NoiseConstants&) const = default;
};

/// ISO 25178-600:2019, 3.1.10 and 3.1.13; the places of points as in core/metrology/operations/lateral.hpp.
struct LateralConstants {
  double pitch_x_um = 0.0;  ///< > 0
  double pitch_y_um = 0.0;  ///< > 0
  double u_pitch_x_um = 0.0;
  double u_pitch_y_um = 0.0;
  double shear = 0.0;
  double deviation_rms_um = 0.0;  ///< mapping deviations
  double drift_px_per_um_x = 0.0;
  double drift_px_per_um_y = 0.0;
  ConstantsOrigin origin;
  bool operator==(const LateralConstants&) const = default;
};

/// What texture values of one surface differ by from place to place and day to day.
struct TextureConstants {
  double reproducibility_percent = 0.0;  ///< standard uncertainty in percent of the value
  ConstantsOrigin origin;
  bool operator==(const TextureConstants&) const = default;
};

/// One version of all constants of one objective. A version never changes; what is accepted makes a new one.
struct Calibration {
  std::string id;         ///< "cal-0003": numbered over all objectives
  std::string objective;  ///< empty where the configuration names none
  std::string created;    ///< UTC, as ConstantsOrigin::accepted
  std::optional<ZConstants> z;
  std::optional<FlatnessConstants> flatness;
  std::optional<NoiseConstants> noise;
  std::optional<LateralConstants> lateral;
  std::optional<TextureConstants> texture;
  bool operator==(const Calibration&) const = default;
};

/// Written and read back by config/field_writer.hpp and field_reader.hpp.
void describe(Calibration& calibration, Fields& fields);

/// Whether a part of it was found with a simulator.
[[nodiscard]] bool has_simulated(const Calibration& calibration);
/// Takes such parts out.
void drop_simulated(Calibration& calibration);

/// The day in UTC, "2026-11-29".
[[nodiscard]] std::string calendar_day(std::chrono::system_clock::time_point time);

/// The origins whose last day is before this one ("2026-11-29"), as "z", "flatness", ...
[[nodiscard]] std::vector<std::string> lapsed(const Calibration& calibration, const std::string& today);

/// lapsed() as a list for people, "z, flatness"; empty where nothing has.
[[nodiscard]] std::string lapsed_text(const Calibration& calibration, const std::string& today);

}  // namespace fvd
