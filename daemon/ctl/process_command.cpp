#include "daemon/ctl/process_command.hpp"

#include <algorithm>
#include <iomanip>
#include <sstream>

#include <CLI/CLI.hpp>

#include "config/strict_json.hpp"
#include "core/focus/fit/smooth_heights.hpp"
#include "daemon/ctl/evaluation_text.hpp"
#include "daemon/ctl/exit_codes.hpp"
#include "daemon/ctl/process_stack.hpp"
#include "daemon/ctl/progress_line.hpp"
#include "daemon/ctl/readable_range.hpp"
#include "daemon/export/exporter_table.hpp"
#include "daemon/export/recorded_slices.hpp"
#include "daemon/recipes/recipe_masks.hpp"

namespace fvd::ctl {

namespace {

std::vector<std::string> peak_names() {
  std::vector<std::string> names;
  for (const PeakMethod method : kAllPeakMethods) names.emplace_back(peak_method_name(method));
  return names;
}

std::vector<std::string> operator_names() {
  std::vector<std::string> names;
  for (const FocusOperator op : kAllFocusOperators) names.emplace_back(focus_operator_name(op));
  return names;
}

/// Beside slices that a job recorded.
constexpr const char* kRecordedHeights = "z.txt";

/// What was typed, else the slices' own file, else their names, else the recipe.
ZSource z_source(const ProcessArguments& arguments, const Recipe& recipe, const SliceList& slices) {
  if (!arguments.z_file.empty())
    return ZFile{arguments.z_file, *length_unit_from_name(arguments.z_unit.value_or("um"))};
  if (arguments.recipe.empty() && arguments.z_start_um && !arguments.z_step_um) {
    throw UsageError("--z-start-um says nothing without --z-step-um or --recipe");
  }
  const bool named = !slices.z_um.empty() && !arguments.z_step_um && !arguments.z_start_um;
  if (arguments.recipe.empty() && !arguments.z_step_um && !named) {
    throw UsageError(
        "the z of the slices is not known, and names such as " + slices.slices.front().name() +
        " do not say it with a unit: give --z-step-um, --z-file, --recipe, or --pattern with {z_um} or {z_mm}");
  }
  const std::filesystem::path recorded = std::filesystem::path(arguments.source) / kRecordedHeights;
  if (!arguments.recipe.empty() && !arguments.z_step_um && !arguments.z_start_um && std::filesystem::exists(recorded))
    return ZFile{recorded, LengthUnit::kMicrometre};
  if (named) return ZNames{};
  if (!arguments.recipe.empty() && recipe.downwards && !arguments.z_step_um && !arguments.z_start_um) {
    return ZSpacing{recipe.start_um + recipe.step_um * (recipe.slices - 1), -recipe.step_um};
  }
  return ZSpacing{arguments.z_start_um.value_or(arguments.recipe.empty() ? 0.0 : recipe.start_um),
                  arguments.z_step_um.value_or(recipe.step_um)};
}

/// Puts what was typed in the place of what the recipe says, and remembers the names of the options.
class Overrides {
 public:
  template <typename Value, typename Typed>
  void set(const char* option, const std::optional<Typed>& typed, Value& value) {
    if (!typed) return;
    value = *typed;
    note(option);
  }
  void note(const char* option) { options_ += (options_.empty() ? "" : ", ") + std::string(option); }
  [[nodiscard]] const std::string& options() const { return options_; }

 private:
  std::string options_;
};

template <typename Value, typename FromName>
std::optional<Value> named(const std::optional<std::string>& name, FromName from_name) {
  return name ? from_name(*name) : std::nullopt;  // the parser lets only known names through
}

/// Files that are asked for by an option are made, whatever the recipe's `export` lists.
void also_export(ExportNeed need, Recipe& recipe) {
  if (!recipe.exports) return;
  for (const Exporter& exporter : exporter_table()) {
    const std::string name(exporter.name);
    const bool listed = std::find(recipe.exports->begin(), recipe.exports->end(), name) != recipe.exports->end();
    if (exporter.need == need && !listed) recipe.exports->push_back(name);
  }
}

Overrides apply(const ProcessArguments& arguments, Recipe& recipe) {
  Overrides overrides;
  overrides.set("--operator", named<FocusOperator>(arguments.focus_operator, focus_operator_from_name),
                recipe.focus.focus_operator);
  overrides.set("--window-shape", named<FocusWindow>(arguments.window, focus_window_from_name), recipe.focus.window);
  if (arguments.smooth_px) {
    recipe.smooth_px = arguments.smooth_px;
    also_export(ExportNeed::kSmoothedMap, recipe);
    overrides.note("--smooth");
  }
  overrides.set("--window", arguments.window_px, recipe.focus.window_px);
  overrides.set("--distance", arguments.distance_px, recipe.focus.distance_px);
  overrides.set("--min-prominence", arguments.min_prominence, recipe.focus.min_prominence);
  overrides.set("--min-significance", arguments.min_significance, recipe.focus.min_significance);
  overrides.set("--broad-curve", arguments.broad_curve, recipe.focus.tests.broad_curve);
  overrides.set("--narrow-curve", arguments.narrow_curve, recipe.focus.tests.narrow_curve);
  overrides.set("--second-peak", arguments.second_peak, recipe.focus.tests.second_peak);
  overrides.set("--clipped-share", arguments.clipped_share, recipe.focus.tests.clipped_share);
  overrides.set("--edge-band", arguments.edge_band_slices, recipe.focus.tests.edge_band_slices);
  overrides.set("--max-sigma", arguments.max_sigma_um, recipe.focus.tests.max_sigma_um);
  if (arguments.drift) overrides.note("--drift");
  overrides.set("--bin", arguments.bin_slices, recipe.bin_slices);
  overrides.set("--peak", named<PeakMethod>(arguments.peak, peak_method_from_name), recipe.peak);
  overrides.set("--pixel-pitch-um", arguments.pixel_pitch_um, recipe.pixel_pitch_x_um);
  if (arguments.pixel_pitch_um) recipe.pixel_pitch_y_um = *arguments.pixel_pitch_um;
  if (arguments.stage_correction) {
    recipe.focus.stage_correction = true;
    overrides.note("--stage-correction");
  }
  if (!arguments.extra_peaks.empty()) {
    recipe.extra_peaks.clear();
    for (const auto& name : arguments.extra_peaks) {
      recipe.extra_peaks.push_back(*peak_method_from_name(name));
      if (recipe.extra_peaks.back() == recipe.peak) {
        throw UsageError("--extra-peak " + name + " is the peak of height.tiff already: name others only");
      }
    }
    also_export(ExportNeed::kEachExtraMap, recipe);
    overrides.note("--extra-peak");
  }
  return overrides;
}

ProcessOptions options_of(const ProcessArguments& arguments) {
  if (arguments.z_step_um == 0.0) throw UsageError("--z-step-um must not be 0: slices at one z make no height map");
  if (arguments.out.empty()) throw UsageError("--out is empty: it must name a directory to make");
  ProcessOptions options;
  options.source = arguments.source;
  options.out = arguments.out;
  options.part_id = arguments.part_id;
  if (arguments.recipe.empty()) {
    options.recipe.focus.stage_correction = false;  // recorded z are taken as they are unless asked for
  } else {
    options.recipe = read_recipe_file(arguments.recipe);
  }
  options.simulated = recorded_of_simulation(options.source);
  options.recipe_plans_scan = !arguments.recipe.empty();
  options.slices = find_slices(options.source, arguments.choice);
  options.significant_bits = arguments.significant_bits.value_or(0);
  options.z = z_source(arguments, options.recipe, options.slices);
  options.z_unit_assumed = std::holds_alternative<ZFile>(options.z) && !arguments.z_unit;
  const Overrides overrides = apply(arguments, options.recipe);
  if (!arguments.recipe.empty() && !overrides.options().empty()) {
    options.recipe.sha256.clear();  // of what the file says
    options.warnings.push_back({"recipe_overridden", "the recipe was changed by " + overrides.options()});
  }
  if (options.recipe_plans_scan) options.allowed_lost_slices = options.recipe.allowed_lost_slices;
  if (arguments.allowed_lost_slices) options.allowed_lost_slices = *arguments.allowed_lost_slices;
  if (arguments.drift) options.undo_drift = *arguments.drift == "auto";
  options.knows_pixel_pitch = arguments.pixel_pitch_um || !arguments.recipe.empty();
  options.threads = arguments.threads;
  return options;
}

/// What made the verdict, e.g. "valid_fraction is 0.31, the recipe asks for at least 0.5".
std::string limit_text(const MeasuredValue& measured) {
  std::ostringstream text;
  const std::string unit = measured.unit == "1" ? "" : " " + measured.unit;
  text << measured.name;
  if (measured.value) {
    text << " is " << *measured.value << unit;
  } else {
    text << " could not be measured";
  }
  text << ", the recipe asks for";
  if (measured.limits->lower) text << " at least " << *measured.limits->lower << unit;
  if (measured.limits->lower && measured.limits->upper) text << " and";
  if (measured.limits->upper) text << " at most " << *measured.limits->upper << unit;
  return text.str();
}

/// "drift     0.042, -0.020 px/um undone; 14 % of the points are not in every slice"; nothing where none was.
std::string drift_text(const Result& result) {
  if (!result.slices.drift || result.slices.drift->undone == DriftUndone::kNothing) return {};
  const Result::Drift& drift = *result.slices.drift;
  std::ostringstream text;
  text << std::fixed << std::setprecision(3) << "drift     " << drift.x_px_per_um << ", " << drift.y_px_per_um
       << " px/um " << (drift.undone == DriftUndone::kRecipe ? "measured, the recipe's undone; " : "undone; ")
       << std::setprecision(1)
       << 100.0 * static_cast<double>(result.holes.out_of_view) / static_cast<double>(result.points)
       << " % of the points are not in every slice\n";
  return text.str();
}

void print_summary(std::ostream& out, const ProcessReport& report, const std::filesystem::path& directory) {
  const Result& result = report.result;
  const auto um = [&result](std::string_view name) { return result.find(name)->value; };
  std::ostringstream text;
  text << std::fixed << std::setprecision(3);
  text << "slices    " << report.slices_text << ", " << result.focus.width_px << " x " << result.focus.height_px
       << " pixels\nfiles     " << report.files_text << "\n";
  text << "valid     " << 100.0 * result.valid_fraction() << " %\n";
  if (um("height_median")) {
    text << "heights   " << *um("height_min") << " to " << *um("height_max") << " um, median " << *um("height_median")
         << " um\n";
  } else {
    text << "heights   none: every point is a hole, see hole_points in result.json\n";
  }
  text << drift_text(result);
  if (result.evaluation) text << evaluation_text(*result.evaluation);
  if (result.verdict) text << "verdict   " << verdict_name(*result.verdict) << "\n";
  for (const MeasuredValue& measured : result.measurements) {
    if (measured.verdict.value_or(Verdict::kPass) == Verdict::kPass) continue;
    text << "limit     " << limit_text(measured) << "\n";
  }
  for (const Warning& warning : result.warnings) text << "warning   " << warning.text << "\n";
  text << "memory    " << std::setprecision(1) << result.focus.state_bytes_per_pixel
       << " bytes per pixel, whatever the number of slices\n";
  text << "result    " << directory.string() << "\n";
  out << text.str() << std::flush;
}

/// The range of a window's side.
std::string check_window(const std::string& text) {
  int side = 0;
  const bool number = CLI::detail::lexical_cast(text, side);
  if (number && (side == 1 || (side % 2 == 1 && side >= kMinWindowPx && side <= kMaxWindowPx))) return {};
  return text + " is not an odd number of " + std::to_string(kMinWindowPx) + " to " + std::to_string(kMaxWindowPx) +
         " pixels, or 1 for the intensity";
}

/// Where the slices are in z.
void add_z_options(CLI::App& command, ProcessArguments& a) {
  command
      .add_option("--significant-bits", a.significant_bits,
                  "of grey levels in files of 16 bit, at their lower or upper end; default: seen from the levels")
      ->check(CLI::Range(8, 16));
  CLI::Option* step = command.add_option(
      "--z-step-um", a.z_step_um,
      "z from one slice to the next, may be negative; default: z in the names that have a unit (z-20um, "
      "1.15mm), the recipe's");
  CLI::Option* start =
      command.add_option("--z-start-um", a.z_start_um, "z of the first slice; default: the recipe's, else 0");
  CLI::Option* file = command.add_option("--z-file", a.z_file,
                                         "z of each slice in their order, one number per line, UTF-8 or UTF-16, # for "
                                         "comments; with a recipe, the source's own z.txt is used by itself");
  file->excludes(step)->excludes(start);
  command.add_option("--z-unit", a.z_unit, "unit of the z file, default um")
      ->needs(file)
      ->check(CLI::IsMember({"um", "mm", "m"}));
}

}  // namespace

void add_choice_options(CLI::App& command, StackChoice& choice) {
  command.add_option("--pattern", choice.pattern,
                     "names of the slices, such as 'z_{z_um}um_*.png': {n} a count, {z_um}, {z_mm} or {z_nm} z with "
                     "sign and decimals, * any text; default: by the names themselves");
  command.add_option("--channel", choice.channel, "of the pages of a TIFF that has several, from 1")
      ->check(PositiveCheck());
  command.add_option("--time", choice.time, "of the pages of a TIFF that has several times, from 1")
      ->check(PositiveCheck());
}

namespace {

/// What becomes a hole.
void add_hole_options(CLI::App& command, ProcessArguments& a) {
  command
      .add_option("--min-prominence", a.min_prominence,
                  "points with a flatter focus curve become holes, 0..1, default 0.5")
      ->check(NumberRangeCheck(0.0, 1.0));
  command
      .add_option("--min-significance", a.min_significance,
                  "points whose curve rises by less noise become holes, default 6")
      ->check(NumberRangeCheck(0.0, 1e6));
  command
      .add_option("--broad-curve", a.broad_curve,
                  "points whose focus curve bends less than so many medians become holes, 0 = off, default 0.2")
      ->check(NumberRangeCheck(0.0, 1.0));
  command
      .add_option("--narrow-curve", a.narrow_curve,
                  "points whose focus curve is less than so many medians wide become holes, 0 = off, default 0.55")
      ->check(NumberRangeCheck(0.0, 1.0));
  command
      .add_option("--second-peak", a.second_peak,
                  "points whose focus curve has a second peak higher than so much of the first become holes, 0.8 is "
                  "usual, 0.5 the least; takes 2 bytes more per pixel; 0 = off, the default")
      ->check(NumberRangeCheck(0.0, 1.0));
  command
      .add_option("--clipped-share", a.clipped_share,
                  "points with more of their window at full scale become holes, 0 = off, default 0.7")
      ->check(NumberRangeCheck(0.0, 1.0));
  command
      .add_option("--edge-band", a.edge_band_slices,
                  "a strip beside heights that jump by more slices becomes holes, 0 = off, default 3")
      ->check(CLI::Range(0, kMaxEdgeBandSlices));
  command
      .add_option("--max-sigma", a.max_sigma_um,
                  "points with a larger standard error in um become holes, 0 = off, the default")
      ->check(NumberRangeCheck(0.0, kMaxSigmaLimit_um));
}

}  // namespace

void add_process_options(CLI::App& command, ProcessArguments& a) {
  command.add_option("source", a.source, "folder of slices (PNG, TIFF, JPEG, PGM, BMP), or a multi-page TIFF")
      ->required();
  command.add_option("--out", a.out, "directory to make for the result; must not exist")->required();
  command.add_option("--recipe", a.recipe, "file of a recipe: as a live job of it would; the options below change it")
      ->check(CLI::ExistingFile);
  add_choice_options(command, a.choice);
  add_z_options(command, a);
  command
      .add_option("--window", a.window_px,
                  "side of the focus window in pixels, odd, 3..63, default 9; the intensity has none")
      ->check(CLI::Validator(check_window, "ODD"));
  command
      .add_option("--operator", a.focus_operator,
                  "what is summed over the window as the measure of sharpness, default diagonal_laplacian")
      ->check(CLI::IsMember(operator_names()));
  command.add_option("--window-shape", a.window, "weights of the window, default double_box")
      ->check(CLI::IsMember({"box", "double_box"}));
  command.add_option("--smooth", a.smooth_px, "also a smoothed map, standard deviation of the weights in pixels")
      ->check(NumberRangeCheck(kMinSmoothPx, kMaxSmoothPx));
  command
      .add_option("--distance", a.distance_px,
                  "from a pixel to the neighbours its operator looks at, 1..7 pixels, default 2")
      ->check(CLI::Range(1, kMaxDistancePx));
  command
      .add_option("--bin", a.bin_slices,
                  "slices summed to one sample of the focus curve, 1..64; default: by the curve's width")
      ->check(CLI::Range(1, kMaxBinSlices));
  command.add_option("--peak", a.peak, "how heights are taken from the focus curve, default five_sample")
      ->check(CLI::IsMember(peak_names()));
  command.add_option("--extra-peak", a.extra_peaks, "further height maps, may be repeated")
      ->check(CLI::IsMember(peak_names()));
  add_hole_options(command, a);
  command.add_flag("--stage-correction", a.stage_correction,
                   "seek the stage's errors in the focus curves and correct heights by them");
  command
      .add_option("--allowed-lost-slices", a.allowed_lost_slices,
                  "so many slices that must not be believed are left out, one more is an error; default: the recipe's, "
                  "else 2")
      ->check(CLI::Range(0, 65532));
  command
      .add_option(
          "--drift", a.drift,
          "lateral drift of the slices: auto = measured in a first pass and undone by whole pixels, off = left as "
          "it is; default: the recipe's, else off")
      ->check(CLI::IsMember({"auto", "off"}));
  command
      .add_option("--pixel-pitch-um", a.pixel_pitch_um,
                  "distance of pixels on the object; default: the recipe's, else what an OME-TIFF says")
      ->check(PositiveCheck());
  command.add_option("--part", a.part_id, "part id to write into the result; default: the name of the source");
  command.add_option("--threads", a.threads, "threads that compute, 0 = one per core")
      ->check(CLI::Range(0, 256))
      ->capture_default_str();
}

int run_process(const ProcessArguments& arguments, const Terminal& terminal) {
  const ProcessOptions options = options_of(arguments);
  ProgressLine progress(terminal.err, terminal.err_is_terminal);
  const ProcessReport report = process_stack(options, [&progress](int done, int total) {
    progress.update(static_cast<double>(done) / total, "slice " + std::to_string(done) + "/" + std::to_string(total));
  });
  progress.end();
  print_summary(terminal.out, report, options.out);
  return exit_code_of(report.result.verdict);
}

}  // namespace fvd::ctl
