#include "daemon/result/calibration.hpp"

#include <cstdio>

namespace fvd {

namespace {

constexpr std::size_t kMaxText_bytes = 256;
constexpr NumberRange kAlpha{0.5, 2.0};
constexpr NumberRange kLength_um{0.0, 1e6};
constexpr NumberRange kShift{-10.0, 10.0};

void describe(ConstantsOrigin& origin, Fields& fields) {
  fields.text("study", origin.study, kMaxText_bytes, "that proposed them");
  fields.text("person", origin.person, kMaxText_bytes, "who accepted them");
  fields.text("certificate", origin.certificate, kMaxText_bytes, "number of the artefact's certificate");
  fields.text("accepted", origin.accepted, kMaxText_bytes, "when, UTC");
  fields.text("renew_by", origin.renew_by, kMaxText_bytes, "the last day that they are trusted on; empty = no end");
  fields.boolean("simulated", origin.simulated, "found with a simulator: not used by an instrument");
}

void describe(ZConstants& z, Fields& fields) {
  fields.number("alpha_z", z.alpha_z, kAlpha, "measured height over true height: heights are divided by it");
  fields.require("alpha_z");
  fields.number("u_alpha_z", z.u_alpha_z, {0.0, 1.0}, "its standard uncertainty");
  fields.require("u_alpha_z");
  fields.number("linearity_um", z.linearity_um, kLength_um, "l_z: the largest residual of the steps, absolute");
  fields.require("linearity_um");
  fields.number("lead_amplitude_um", z.lead_amplitude_um, kLength_um, "of the screw's periodic error; 0 = not known");
  fields.number("lead_um", z.lead_um, kLength_um, "its period");
}

void describe(FlatnessConstants& flatness, Fields& fields) {
  fields.number("flatness_um", flatness.flatness_um, kLength_um, "z_FLT: Sz of the mean map of a flat after a plane");
  fields.require("flatness_um");
  fields.number("u_reference_um", flatness.u_reference_um, kLength_um, "standard error of the reference map");
  fields.require("u_reference_um");
  fields.text("reference", flatness.reference, kMaxText_bytes, "file of the reference map; empty = none");
}

void describe(NoiseConstants& noise, Fields& fields) {
  fields.number("noise_um", noise.noise_um, kLength_um, "N_M: the measurement noise");
  fields.require("noise_um");
}

void describe(LateralConstants& lateral, Fields& fields) {
  fields.number("pitch_x_um", lateral.pitch_x_um, positive(1e6), "of neighbouring columns");
  fields.require("pitch_x_um");
  fields.number("pitch_y_um", lateral.pitch_y_um, positive(1e6), "of neighbouring rows");
  fields.require("pitch_y_um");
  fields.number("u_pitch_x_um", lateral.u_pitch_x_um, kLength_um, "standard uncertainty");
  fields.require("u_pitch_x_um");
  fields.number("u_pitch_y_um", lateral.u_pitch_y_um, kLength_um, "standard uncertainty");
  fields.require("u_pitch_y_um");
  fields.number("shear", lateral.shear, {-1.0, 1.0}, "x that a step of one row adds, over pitch_y_um");
  fields.require("shear");
  fields.number("deviation_rms_um", lateral.deviation_rms_um, kLength_um, "mapping deviations, quadratic mean");
  fields.number("drift_px_per_um_x", lateral.drift_px_per_um_x, kShift, "the image moves right by so much per um of z");
  fields.number("drift_px_per_um_y", lateral.drift_px_per_um_y, kShift, "and down");
}

void describe(TextureConstants& texture, Fields& fields) {
  fields.number("reproducibility_percent", texture.reproducibility_percent, {0.0, 100.0},
                "standard uncertainty of texture values in percent of the value");
  fields.require("reproducibility_percent");
}

/// A part that a calibration has or has not, with its origin.
template <typename Constants>
void part(Fields& fields, const char* key, std::optional<Constants>& constants, const char* meaning) {
  fields.optional(key, constants, [&](Fields& in, Constants& present) {
    in.group(key, meaning, [&](Fields& group) {
      describe(present, group);
      group.group("origin", "where they come from", [&](Fields& origin) { describe(present.origin, origin); });
    });
  });
}

}  // namespace

void describe(Calibration& calibration, Fields& fields) {
  fields.text("id", calibration.id, kMaxText_bytes, "of this version, which never changes");
  fields.require("id");
  fields.text("objective", calibration.objective, kMaxText_bytes, "that it holds for; empty = none is named");
  fields.text("created", calibration.created, kMaxText_bytes, "when, UTC");
  part(fields, "z", calibration.z, "along the axis");
  part(fields, "flatness", calibration.flatness, "of the height map of a flat");
  part(fields, "noise", calibration.noise, "from scan to scan");
  part(fields, "lateral", calibration.lateral, "in the image");
  part(fields, "texture", calibration.texture, "of texture values");
}

bool has_simulated(const Calibration& calibration) {
  Calibration rest = calibration;
  drop_simulated(rest);
  return rest != calibration;
}

void drop_simulated(Calibration& calibration) {
  const auto drop = [](auto& constants) {
    if (constants && constants->origin.simulated) constants.reset();
  };
  drop(calibration.z);
  drop(calibration.flatness);
  drop(calibration.noise);
  drop(calibration.lateral);
  drop(calibration.texture);
}

std::string calendar_day(std::chrono::system_clock::time_point time) {
  const std::chrono::year_month_day day(std::chrono::floor<std::chrono::days>(time));
  char text[32];
  std::snprintf(text, sizeof text, "%04d-%02u-%02u", static_cast<int>(day.year()), static_cast<unsigned>(day.month()),
                static_cast<unsigned>(day.day()));
  return text;
}

std::vector<std::string> lapsed(const Calibration& calibration, const std::string& today) {
  std::vector<std::string> parts;
  const auto add = [&](const char* name, const auto& constants) {
    if (!constants || constants->origin.renew_by.empty()) return;
    if (constants->origin.renew_by < today) parts.emplace_back(name);  // dates of equal form sort as text
  };
  add("z", calibration.z);
  add("flatness", calibration.flatness);
  add("noise", calibration.noise);
  add("lateral", calibration.lateral);
  add("texture", calibration.texture);
  return parts;
}

std::string lapsed_text(const Calibration& calibration, const std::string& today) {
  std::string text;
  for (const std::string& part : lapsed(calibration, today)) text += (text.empty() ? "" : ", ") + part;
  return text;
}

}  // namespace fvd
