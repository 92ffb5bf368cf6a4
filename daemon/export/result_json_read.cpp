/// From the text of result.json back to the typed result.

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <type_traits>
#include <utility>

#include <nlohmann/json.hpp>

#include "config/field_reader.hpp"
#include "core/base/error.hpp"
#include "core/focus/lateral_period.hpp"
#include "daemon/export/json_values.hpp"
#include "daemon/export/result_json.hpp"

namespace fvd {

namespace {

using Json = nlohmann::ordered_json;

/// A value of the document and where it stands.
class Node {
 public:
  Node(const Json& json, std::string pointer) : json_(&json), pointer_(std::move(pointer)) {}

  [[noreturn]] void refuse(const std::string& expected) const {
    throw Error(ErrorCode::kBadInput, "result.json: " + (pointer_.empty() ? "/" : pointer_) + ": expected " + expected);
  }

  [[nodiscard]] const Json& json() const { return *json_; }
  [[nodiscard]] const std::string& pointer() const { return pointer_; }
  [[nodiscard]] bool has(const char* key) const { return json_->is_object() && json_->contains(key); }
  [[nodiscard]] bool is_null() const { return json_->is_null(); }

  [[nodiscard]] Node at(const std::string& key) const {
    if (!json_->is_object()) refuse("an object");
    const auto found = json_->find(key);
    if (found == json_->end()) refuse("the key " + key);
    return {*found, pointer_ + "/" + key};
  }

  /// Calls visit(key, node) for each member of an object.
  template <typename Visit>
  void members(const Visit& visit) const {
    if (!json_->is_object()) refuse("an object");
    for (const auto& [key, value] : json_->items()) visit(key, Node(value, pointer_ + "/" + key));
  }

  /// Calls visit(node) for each element of a list.
  template <typename Visit>
  void elements(const Visit& visit) const {
    if (!json_->is_array()) refuse("a list");
    std::size_t index = 0;
    for (const Json& value : *json_) visit(Node(value, pointer_ + "/" + std::to_string(index++)));
  }

  [[nodiscard]] bool boolean() const {
    if (!json_->is_boolean()) refuse("true or false");
    return json_->get<bool>();
  }

  [[nodiscard]] double number() const {
    if (json_->is_null()) return std::numeric_limits<double>::quiet_NaN();
    if (!json_->is_number()) refuse("a number or null");
    return json_->get<double>();
  }

  /// null and what is out of range are refused.
  [[nodiscard]] double finite() const {
    if (!json_->is_number() || !std::isfinite(json_->get<double>())) refuse("a number");
    return json_->get<double>();
  }

  [[nodiscard]] std::optional<double> optional_number() const {
    return json_->is_null() ? std::nullopt : std::optional(number());
  }

  /// Of any width; refuses what does not fit.
  template <typename Integer>
  [[nodiscard]] Integer integer() const {
    if (!json_->is_number_integer()) refuse("an integer");
    const bool fits = json_->is_number_unsigned() ? std::in_range<Integer>(json_->get<std::uint64_t>())
                                                  : std::in_range<Integer>(json_->get<std::int64_t>());
    if (!fits) {
      refuse("an integer from " + std::to_string(std::numeric_limits<Integer>::min()) + " to " +
             std::to_string(std::numeric_limits<Integer>::max()));
    }
    return json_->get<Integer>();
  }

  [[nodiscard]] std::string text() const {
    if (!json_->is_string()) refuse("a text");
    return json_->get<std::string>();
  }

  /// Empty for null.
  [[nodiscard]] std::string text_or_empty() const { return json_->is_null() ? std::string() : text(); }

  /// By one of the functions that read a name.
  template <typename FromName>
  [[nodiscard]] auto named(const FromName& from_name, const char* what) const {
    const auto value = from_name(text());
    if (!value) refuse(what);
    return *value;
  }

 private:
  const Json* json_;
  std::string pointer_;
};

Verdict verdict(const Node& node) { return node.named(verdict_from_name, "pass, fail, uncertain or invalid"); }
PeakMethod peak(const Node& node) { return node.named(peak_method_from_name, "the name of a peak method"); }

MeasuredValue measurement(const std::string& name, const Node& node) {
  MeasuredValue measured;
  measured.name = name;
  measured.kind = node.at("kind").text();
  measured.value = node.at("value").optional_number();
  measured.unit = node.at("unit").text();
  if (node.has("u")) measured.u = node.at("u").number();
  if (node.has("U")) measured.expanded_u = node.at("U").number();
  if (node.has("k")) measured.k = node.at("k").number();
  measured.points = node.at("points").integer<std::size_t>();
  measured.valid_fraction = node.at("valid_fraction").number();
  if (node.has("limits")) {
    const Node limits = node.at("limits");
    measured.limits = Limits{limits.at("lower").optional_number(), limits.at("upper").optional_number()};
  }
  if (node.has("verdict")) measured.verdict = verdict(node.at("verdict"));
  return measured;
}

HoleCounts holes(const Node& node) {
  const auto count = [&node](const char* key) { return node.at(key).integer<std::size_t>(); };
  // Results of 0.1.0 know the first seven alone.
  const auto later = [&node, &count](const char* key) { return node.has(key) ? count(key) : 0; };
  return {count("low_prominence"), count("first_slice"),   count("last_slice"),    count("not_bracketed"),
          count("saturated"),      count("insignificant"), count("edge_bleeding"), later("broad_curve"),
          later("narrow_curve"),   later("second_peak"),   later("edge_band"),     later("max_sigma"),
          later("out_of_view")};
}

/// What a result does not tell was not looked for.
PointTests point_tests(const Node& node) {
  const auto limit = [&node](const char* key) { return node.has(key) ? node.at(key).number() : 0.0; };
  PointTests tests;
  tests.broad_curve = limit("broad_curve");
  tests.narrow_curve = limit("narrow_curve");
  tests.second_peak = limit("second_peak");
  tests.clipped_share = limit("clipped_share");
  tests.edge_band_slices = node.has("edge_band_slices") ? node.at("edge_band_slices").integer<int>() : 0;
  tests.max_sigma_um = limit("max_sigma_um");
  return tests;
}

Result::Focus focus(const Node& node) {
  Result::Focus focus;
  focus.width_px = node.at("width_px").integer<int>();
  focus.height_px = node.at("height_px").integer<int>();
  focus.pixel_pitch_x_um = node.at("pixel_pitch_x_um").optional_number();
  focus.pixel_pitch_y_um = node.at("pixel_pitch_y_um").optional_number();
  focus.settings.focus_operator = node.at("operator").named(focus_operator_from_name, "the name of a focus operator");
  // Results of 0.2.0 had a box alone, and no smoothed map.
  focus.settings.window = node.has("window")
                              ? node.at("window").named(focus_window_from_name, "the name of a focus window")
                              : FocusWindow::kBox;
  focus.settings.window_px = node.at("window_px").integer<int>();
  if (node.has("smooth_px")) focus.smooth_px = node.at("smooth_px").optional_number();
  focus.lateral_period_px =
      node.has("lateral_period_px") ? node.at("lateral_period_px").number() : lateral_period_px(focus.settings, {});
  if (node.has("smooth_lateral_period_px")) {
    focus.smooth_lateral_period_px = node.at("smooth_lateral_period_px").optional_number();
  }
  focus.settings.distance_px = node.at("distance_px").integer<int>();
  focus.settings.min_prominence = node.at("min_prominence").number();
  focus.settings.min_significance = node.at("min_significance").number();
  focus.settings.bin_slices = node.at("bin_slices").integer<int>();
  // Of before 0.3.0, when the recipe alone chose.
  focus.bins_by = node.has("bins_by") ? node.at("bins_by").named(bin_choice_from_name, "the name of a choice of bins")
                                      : BinChoice::kRecipe;
  if (node.has("holes")) {
    focus.settings.tests = point_tests(node.at("holes"));
  } else {  // a result of 0.1.0
    focus.settings.tests = {.broad_curve = 0.0, .narrow_curve = 0.0, .clipped_share = 0.0, .edge_band_slices = 0};
  }
  focus.noise_grey = node.at("noise_grey").number();
  focus.curve_width_um = node.at("curve_width_um").optional_number();
  focus.peak = peak(node.at("peak"));
  node.at("extra_peaks").elements([&focus](const Node& further) {
    const Node height = further.at("height");
    const auto um = [&height](const char* key) { return height.at(key).optional_number(); };
    focus.extra_peaks.push_back({peak(further.at("peak")), um("min_um"), um("max_um"), um("mean_um"), um("median_um")});
  });
  focus.state_bytes_per_pixel = node.at("state_bytes_per_pixel").number();
  if (node.has("texture_max_grey")) focus.texture_max_grey = node.at("texture_max_grey").integer<int>();
  return focus;
}

FrameCounts frames(const Node& node) {
  const auto count = [&node](const char* key) { return node.at(key).integer<std::uint64_t>(); };
  return {count("expected"), count("ok"), count("incomplete"), count("missing"), count("stale"), count("underrun")};
}

std::optional<ScanMode> scan_mode_from_name(std::string_view name) {
  if (name == "step") return ScanMode::kStep;
  return name == "continuous" ? std::optional(ScanMode::kContinuous) : std::nullopt;
}

SuspectSlice suspect_slice(const Node& node) {
  SuspectSlice slice;
  slice.index = node.at("index").integer<int>();
  slice.z_um = node.at("z_um").number();
  slice.reason = node.at("reason").named(suspect_reason_from_name, "a reason to suspect a slice");
  slice.figure = node.at("figure").number();
  slice.done = node.at("done").named(suspect_done_from_name, "left_out or taken_again");
  if (node.has("file")) slice.file = node.at("file").text();
  return slice;
}

std::optional<Result::Drift> drift(const Node& node) {
  if (node.is_null()) return std::nullopt;
  return Result::Drift{node.at("x").number(), node.at("y").number(), node.at("x_per_um").number(),
                       node.at("y_per_um").number(),
                       node.at("undone").named(drift_undone_from_name, "nothing, recipe or slices")};
}

Result::Slices slices(const Node& node) {
  Result::Slices slices;
  slices.planned = node.at("planned").integer<int>();
  slices.measured = node.at("measured").integer<int>();
  slices.first_um = node.at("first_um").optional_number();
  slices.last_um = node.at("last_um").optional_number();
  if (node.has("exposure_us")) slices.exposure_us = node.at("exposure_us").optional_number();
  slices.mode = node.at("scan_mode").named(scan_mode_from_name, "step or continuous");
  if (slices.mode == ScanMode::kContinuous) {
    slices.speed_um_per_s = node.at("speed_um_per_s").number();
    slices.ramp_frames = node.at("ramp_frames").integer<int>();
  }
  node.at("suspect").elements([&slices](const Node& suspect) { slices.suspect.push_back(suspect_slice(suspect)); });
  // Results of 0.1.0 had none of these.
  if (node.has("retaken")) slices.retaken = node.at("retaken").integer<int>();
  if (node.has("flicker_percent")) slices.flicker_percent = node.at("flicker_percent").optional_number();
  if (node.has("drift_px")) slices.drift = drift(node.at("drift_px"));
  if (node.has("scale_percent")) slices.scale_percent = node.at("scale_percent").optional_number();
  return slices;
}

StepSummary steps(const Node& node) {
  return {node.at("steps").integer<int>(),           node.at("error_mean_um").number(),
          node.at("error_sd_um").number(),           node.at("error_max_um").number(),
          node.at("increment_error_sd_um").number(), node.at("increment_error_max_um").number(),
          node.at("move_median_ms").number(),        node.at("move_max_ms").number()};
}

PhaseTimes times(const Node& node) {
  PhaseTimes times{node.at("prepare_ms").number(), node.at("scan_ms").number(), node.at("finish_ms").number(),
                   node.at("write_ms").number()};
  if (node.has("evaluate_ms")) times.evaluate_ms = node.at("evaluate_ms").optional_number();
  if (node.has("follow_ms")) times.follow_ms = node.at("follow_ms").optional_number();
  return times;
}

Result::Provenance provenance(const Node& node) {
  return {node.at("software_version").text_or_empty(), node.at("simulated").boolean(),
          node.at("created").named(from_iso8601_utc, "a time such as 2026-11-28T12:00:00.000Z"),
          node.at("source").text_or_empty()};
}

ResultFile file(const Node& node) {
  ResultFile file;
  file.name = node.at("name").text();
  if (node.has("files")) file.files = node.at("files").integer<std::uint64_t>();
  // Results of 0.3.0 had neither state nor digest: their files were written before anybody knew of the result.
  if (node.has("state")) file.state = node.at("state").named(file_state_from_name, "written, pending or not_made");
  if (file.state == FileState::kWritten) file.size_bytes = node.at("size_bytes").integer<std::uint64_t>();
  if (node.has("sha256")) file.sha256 = node.at("sha256").text();
  if (node.has("reason")) file.reason = node.at("reason").text();
  return file;
}

/// What has a description of its own.
template <typename Described>
Described described(const Node& node) {
  Described value;
  Problems problems;
  const nlohmann::json members = node.json();
  FieldReader reader(members, problems, node.pointer());
  describe(value, reader);
  reader.finish();
  if (!problems.empty()) throw Error(ErrorCode::kBadInput, to_text(problems, "result.json"));
  return value;
}

/// What results of before 0.4.0 do not tell.
void read_conditions(const Node& root, Result& result) {
  const auto is_told = [&root](const char* key) { return root.has(key) && !root.at(key).is_null(); };
  if (is_told("objective")) result.objective = root.at("objective").text();
  if (is_told("temperature")) {
    const Node node = root.at("temperature");
    result.temperature = Temperature{node.at("celsius").finite(), node.at("source").text(), node.at("age_s").finite()};
  }
  if (is_told("calibration")) result.calibration = described<Calibration>(root.at("calibration"));
  if (!is_told("repeatability")) return;
  root.at("repeatability").members([&result](const std::string& name, const Node& node) {
    result.repeatability.emplace(name, described<Repeatability>(node));
  });
}

}  // namespace

Result read_result_json(std::string_view text) {
  const Json json = Json::parse(text, nullptr, false);
  const Node root(json, "");
  if (json.is_discarded()) root.refuse("JSON");
  if (root.at("format").integer<std::int64_t>() != Result::kFormat) {
    root.at("format").refuse(std::to_string(Result::kFormat) + ", the format that this version reads");
  }
  Result result;
  const Node job = root.at("job");
  result.job.id = job.at("job_id").text_or_empty();
  if (!job.at("seq").is_null()) result.job.seq = job.at("seq").integer<std::int64_t>();
  result.job.part_id = job.at("part_id").text_or_empty();
  result.recipe = {root.at("recipe").at("id").text_or_empty(), root.at("recipe").at("sha256").text_or_empty()};
  if (!root.at("verdict").is_null()) result.verdict = verdict(root.at("verdict"));
  root.at("measurements").members([&result](const std::string& name, const Node& node) {
    result.measurements.push_back(measurement(name, node));
  });
  root.at("warnings").elements([&result](const Node& warning) {
    result.warnings.push_back({warning.at("code").text(), warning.at("text").text()});
  });
  const Node values = root.at("values");
  result.points = values.at("points").integer<std::size_t>();
  result.valid_points = values.at("valid_points").integer<std::size_t>();
  result.holes = holes(values.at("hole_points"));
  result.focus = focus(root.at("focus"));
  result.frames = frames(root.at("frames"));
  result.slices = slices(root.at("slices"));
  if (root.has("repeat")) {
    const Node repeat = root.at("repeat");
    result.repeat = Result::Repeat{repeat.at("scans").integer<int>(), repeat.at("sd_rms_um").optional_number()};
  }
  result.steps = steps(root.at("steps"));
  if (root.at("steps").has("encoder_resolution_um")) {
    result.encoder_resolution_um = root.at("steps").at("encoder_resolution_um").number();
  }
  if (root.has("evaluation")) result.evaluation = described<Evaluation>(root.at("evaluation"));
  read_conditions(root, result);
  const Node stage = root.at("stage_in_curves");
  result.stage = {stage.at("corrected").boolean(), stage.at("reason").text_or_empty(),
                  stage.at("offsets_rms_um").number(), stage.at("offset_error_um").number()};
  result.times = times(root.at("times"));
  result.provenance = provenance(root.at("provenance"));
  root.at("files").elements([&result](const Node& node) { result.files.push_back(file(node)); });
  return result;
}

}  // namespace fvd
