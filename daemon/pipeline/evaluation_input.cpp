#include "daemon/pipeline/evaluation_input.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "core/focus/lateral_period.hpp"
#include "core/focus/window_kernel.hpp"
#include "core/metrology/uncertainty/budget.hpp"

namespace fvd {

namespace {

constexpr double kLogDigits = 1e6;    ///< step_log.csv has so many parts of a um
constexpr double kWidthDigits = 1e4;  ///< result.json likewise

/// A slice that the focus curves have.
struct StoredSlice {
  double z_um = 0.0;
  double sd_um = 0.0;
  int position_samples = 0;
};

double rounded(double value, double parts) { return std::round(value * parts) / parts; }

/// The samples of the curves: slices, or bins of them, of which the last may be incomplete.
std::vector<CurveSample> samples_of(const std::vector<StoredSlice>& slices, int bin_slices,
                                    std::optional<double> resolution_um) {
  const bool positions_known =
      std::any_of(slices.begin(), slices.end(), [](const StoredSlice& slice) { return slice.position_samples > 0; });
  if (!positions_known || !resolution_um) return {};
  std::vector<CurveSample> samples;
  const auto bin = static_cast<std::size_t>(std::max(bin_slices, 1));
  for (std::size_t first = 0; first < slices.size(); first += bin) {
    const std::size_t end = std::min(first + bin, slices.size());
    const auto count = static_cast<double>(end - first);
    double z_um = 0.0;
    double squares = 0.0;
    for (std::size_t i = first; i < end; ++i) {
      z_um += slices[i].z_um;
      const double u_um = metrology::slice_z_uncertainty_um(slices[i].sd_um, *resolution_um);
      squares += u_um * u_um;
    }
    samples.push_back({z_um / count, std::sqrt(squares) / count});
  }
  return samples;
}

std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream text(line);
  for (std::string cell; std::getline(text, cell, ',');) cells.push_back(cell);
  return cells;
}

class StepLogReader {
 public:
  explicit StepLogReader(const std::filesystem::path& path) : path_(path), file_(path) {
    std::string line;
    std::getline(file_, line);
    header_ = cells_of(line);
  }

  [[nodiscard]] std::vector<StoredSlice> slices() {
    const std::size_t measured = column("measured");
    const std::size_t z = column("measured_um");
    const std::size_t sd = column("measured_sd_um");
    const std::size_t samples = column("position_samples");
    std::vector<StoredSlice> slices;
    for (std::string line; std::getline(file_, line);) {
      ++row_;
      const std::vector<std::string> cells = cells_of(line);
      if (cells.size() <= std::max({measured, z, sd, samples})) refuse("has too few columns");
      if (cells[measured] == "0") continue;
      slices.push_back({number(cells[z]), number(cells[sd]), static_cast<int>(number(cells[samples]))});
    }
    return slices;
  }

 private:
  [[noreturn]] void refuse(const std::string& why) const {
    throw Error(ErrorCode::kBadInput, path_.string() + ": row " + std::to_string(row_) + " " + why);
  }
  [[nodiscard]] std::size_t column(const std::string& name) const {
    const auto found = std::find(header_.begin(), header_.end(), name);
    if (found == header_.end()) refuse("has no column " + name + ": is it the log of a scan?");
    return static_cast<std::size_t>(found - header_.begin());
  }
  [[nodiscard]] double number(const std::string& cell) const {
    std::istringstream text(cell);
    text.imbue(std::locale::classic());
    double value = 0.0;
    if (!(text >> value) || !std::isfinite(value)) refuse("has \"" + cell + "\" in place of a number");
    return value;
  }

  std::filesystem::path path_;
  std::ifstream file_;
  std::vector<std::string> header_;
  int row_ = 1;
};

}  // namespace

Surface evaluated_surface(const ResultData& data) {
  Surface surface;
  surface.height_m = data.map.height_m.clone();
  surface.sigma_m = data.map.sigma_m.clone();
  surface.mask = data.map.mask.clone();
  surface.pitch_x_um = data.pixel_pitch_x_um.value_or(1.0);
  surface.pitch_y_um = data.pixel_pitch_y_um.value_or(1.0);
  Result::Focus focus;
  focus.settings = data.focus;
  note_window(focus, surface);
  return surface;
}

EvaluationContext evaluation_context(const ResultData& data) {
  std::vector<StoredSlice> slices;
  for (const StepRecord& step : data.steps) {
    if (!step.measured) continue;
    slices.push_back(
        {rounded(step.measured_um, kLogDigits), rounded(step.measured_sd_um, kLogDigits), step.position_samples});
  }
  EvaluationContext context;
  context.samples = samples_of(slices, data.focus.bin_slices, data.encoder_resolution_um);
  context.curve_width_um = rounded(data.map.curve_width_um, kWidthDigits);
  context.calibration = data.calibration;
  context.flatness_reference = data.flatness_reference;
  if (data.temperature) context.temperature_c = data.temperature->celsius;
  context.repeatability = data.repeatability;
  return context;
}

SurfaceRef surface_to_evaluate(const ResultData& data) {
  Surface noted;  // no planes
  noted.pitch_x_um = data.pixel_pitch_x_um.value_or(1.0);
  noted.pitch_y_um = data.pixel_pitch_y_um.value_or(1.0);
  Result::Focus focus;
  focus.settings = data.focus;
  note_window(focus, noted);
  SurfaceRef surface(noted);
  surface.height_m = data.map.height_m.view();
  surface.sigma_m = data.map.sigma_m.view();
  surface.mask = data.map.mask.view();
  return surface;
}

void note_window(const Result::Focus& focus, Surface& surface) {
  surface.kernel = window_kernel(focus.settings);
  surface.lateral_period_um = lateral_period_px(focus.settings, {}) * std::max(surface.pitch_x_um, surface.pitch_y_um);
}

EvaluationContext read_evaluation_context(const std::filesystem::path& folder, const Result& result) {
  EvaluationContext context;
  context.curve_width_um = result.focus.curve_width_um.value_or(0.0);
  context.calibration = result.calibration;
  if (result.temperature) context.temperature_c = result.temperature->celsius;
  context.repeatability = result.repeatability;
  const std::filesystem::path log = folder / "step_log.csv";
  if (!std::filesystem::exists(log)) return context;
  context.samples =
      samples_of(StepLogReader(log).slices(), result.focus.settings.bin_slices, result.encoder_resolution_um);
  return context;
}

void keep_repeatability_of(const Recipe& recipe, const Result& result, EvaluationContext& context) {
  const bool same_text = !recipe.sha256.empty() && recipe.sha256 == result.recipe.sha256;
  if (recipe.id != result.recipe.id && !same_text) context.repeatability.clear();
}

}  // namespace fvd
