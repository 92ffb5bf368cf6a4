#include "daemon/report/condition_lines.hpp"

#include <locale>
#include <sstream>
#include <string_view>
#include <utility>

#include <nlohmann/json.hpp>

#include "daemon/report/axis_ticks.hpp"
#include "daemon/report/value_rows.hpp"

namespace fvd {

namespace {

/// Keys in the order of the alphabet: a result that was read back tells the same words.
using nlohmann::json;

std::string number_text(double number) {
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text.precision(4);
  text << number;
  return text.str();
}

/// At most 100 only where it is all of them.
std::string percent_text(double fraction) {
  const std::string text = fixed_text(100.0 * fraction, 1);
  return (text == "100.0" && fraction < 1.0 ? "99.9" : text) + " %";
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

/// A key with its unit at its end as words: "nesting_um", 80 is "nesting 80 µm".
std::string entry_text(const std::string& key, const std::string& value) {
  constexpr std::pair<std::string_view, const char*> kUnits[] = {
      {"_um", " µm"}, {"_deg", "°"}, {"_percent", " %"}, {"_px", " px"}};
  for (const auto& [suffix, unit] : kUnits) {
    if (key.ends_with(suffix)) return key.substr(0, key.size() - suffix.size()) + " " + value + unit;
  }
  return key + " " + value;
}

std::string scalar_text(const json& value) {
  if (value.is_string()) return value.get<std::string>();
  if (value.is_boolean()) return value.get<bool>() ? "yes" : "no";
  if (value.is_number_integer()) return value.dump();
  return value.is_number() ? number_text(value.get<double>()) : std::string();
}

/// Of a list of plain values "a, b"; of anything else nothing.
std::string value_text(const json& value) {
  if (!value.is_array()) return scalar_text(value);
  std::vector<std::string> words;
  for (const json& item : value) {
    if (const std::string word = scalar_text(item); !word.empty()) words.push_back(word);
  }
  return joined(words);
}

std::string done_text(const json& did) {
  std::vector<std::string> words;
  if (did.contains("points_used")) words.push_back(scalar_text(did.at("points_used")) + " points used");
  if (did.value("points_removed", 0.0) > 0.0) words.push_back(scalar_text(did.at("points_removed")) + " removed");
  if (did.contains("values")) {
    for (const auto& [name, value] : did.at("values").items()) {
      std::string number = scalar_text(value.at("value"));
      if (value.contains("standard_error")) number += " ± " + scalar_text(value.at("standard_error"));
      words.push_back(entry_text(name, number));
    }
  }
  return joined(words);
}

std::string step_text(const json& step) {
  std::vector<std::string> settings;
  std::string done;
  for (const auto& [key, value] : step.items()) {
    if (key == "op") continue;
    if (key == "did") {
      done = done_text(value);
    } else if (const std::string text = value_text(value); !text.empty() && text != "no" && text != "0") {
      settings.push_back(entry_text(key, text));
    }
  }
  std::string text = step.value("op", "");
  if (!settings.empty()) text += " (" + joined(settings) + ")";
  if (!done.empty()) text += ": " + done;
  return text;
}

std::string steps_text(const std::string& steps_json) {
  const auto steps = json::parse(steps_json, nullptr, false);
  if (!steps.is_array() || steps.empty()) return "as measured";
  std::string text;
  for (const json& step : steps) {
    if (step.is_object()) text += (text.empty() ? "" : "; ") + step_text(step);
  }
  return text;
}

/// Figures of a measurement's details that are conditions of texture values.
std::string texture_text(const EvaluatedMeasurement& made) {
  const auto details = json::parse(made.details, nullptr, false);
  if (!details.is_object()) return {};
  constexpr std::pair<const char*, const char*> kKeys[] = {{"noise_floor_Sq_um", "noise floor Sq_um"},
                                                           {"window_um", "focus window_um"},
                                                           {"S_um", "S_um"},
                                                           {"L_um", "L_um"},
                                                           {"S_effective_um", "S effective_um"},
                                                           {"evaluation_length_um", "evaluation length_um"}};
  std::string text;
  for (const auto& [key, words] : kKeys) {
    if (details.contains(key) && details.at(key).is_number()) {
      text += "; " + entry_text(words, scalar_text(details.at(key)));
    }
  }
  return text;
}

std::string made_how_text(const EvaluatedMeasurement& made) {
  std::string text = made.kind + (made.method.empty() ? "" : " " + made.method) + " on " + made.surface;
  if (!made.region.empty()) text += ", region " + made.region;
  text += "; " + std::to_string(made.points) + " points, " + percent_text(made.valid_fraction) + " valid";
  text += texture_text(made);
  if (!made.not_evaluated.empty()) text += "; U does not contain: " + joined(made.not_evaluated);
  if (!made.reason.empty()) text += "; invalid: " + made.reason;
  for (const EvaluationWarning& warning : made.warnings) text += "; warning: " + warning.text;
  for (const auto& [key, value] : made.values) {
    if (!value.value && made.reason.empty()) text += "; no " + key + ": " + value.reason;
    for (const EvaluationWarning& warning : value.warnings) text += "; " + key + ": " + warning.text;
  }
  return text;
}

std::string surface_text(const Result& result) {
  const Result::Focus& focus = result.focus;
  std::string text = std::to_string(focus.width_px) + " x " + std::to_string(focus.height_px) + " points";
  if (focus.pixel_pitch_x_um && focus.pixel_pitch_y_um) {
    text += ", pitch " + number_text(*focus.pixel_pitch_x_um) + " x " + number_text(*focus.pixel_pitch_y_um) + " µm";
  } else {
    text += ", pitch not known";
  }
  text += ", " + percent_text(result.valid_fraction()) + " valid; focus window " +
          std::to_string(focus.settings.window_px) + " px, half amplitude at a period of " +
          number_text(focus.lateral_period_px) + " px; " + std::to_string(result.slices.measured) + " slices";
  if (result.slices.first_um && result.slices.last_um) {
    text += " from " + number_text(*result.slices.first_um) + " to " + number_text(*result.slices.last_um) + " µm";
  }
  if (const MeasuredValue* sigma = result.find("sigma_median"); sigma != nullptr && sigma->value) {
    text += "; median standard error of a height " + number_text(*sigma->value) + " µm";
  }
  return text;
}

std::string rule_text(const Evaluation& evaluation) {
  return evaluation.rule + ", probability " + number_text(evaluation.probability) + "; calibration " +
         evaluation.calibration;
}

}  // namespace

std::vector<ConditionLine> condition_lines(const Result& result) {
  std::vector<ConditionLine> lines;
  if (result.evaluation) {
    for (const std::string& name : result.evaluation->order) {
      const auto found = result.evaluation->measurements.find(name);
      if (found != result.evaluation->measurements.end()) lines.push_back({name, made_how_text(found->second)});
    }
    for (const auto& [name, steps] : result.evaluation->surfaces) {
      lines.push_back({"Surface " + name, steps_text(steps)});
    }
    lines.push_back({"Decision", rule_text(*result.evaluation)});
  }
  lines.push_back({"Measured surface", surface_text(result)});
  for (const Warning& warning : result.warnings) lines.push_back({"Warning", warning.text});
  for (ConditionLine& line : lines) line.text = with_micro_sign(std::move(line.text));
  return lines;
}

}  // namespace fvd
