#include "daemon/ctl/process_command.hpp"

#include <algorithm>
#include <iomanip>
#include <sstream>

#include <CLI/CLI.hpp>

#include "daemon/ctl/exit_codes.hpp"
#include "daemon/ctl/process_stack.hpp"
#include "daemon/ctl/progress_line.hpp"

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

ZSource z_source(const ProcessArguments& arguments) {
  if (!arguments.z_file.empty()) return ZFile{arguments.z_file, *length_unit_from_name(arguments.z_unit)};
  if (arguments.z_step_um == 0.0) {
    throw UsageError("the z of the slices is not known: give --z-step-um (not 0) or --z-file");
  }
  return ZSpacing{arguments.z_start_um, arguments.z_step_um};
}

ProcessOptions options_of(const ProcessArguments& arguments) {
  ProcessOptions options;
  options.source = arguments.source;
  options.out = arguments.out;
  options.part_id = arguments.part_id;
  options.z = z_source(arguments);
  options.focus.focus_operator = *focus_operator_from_name(arguments.focus_operator);
  options.focus.window_px = options.focus.focus_operator == FocusOperator::kIntensity ? 1 : arguments.window_px;
  options.focus.distance_px = arguments.distance_px;
  options.focus.min_prominence = arguments.min_prominence;
  options.focus.min_significance = arguments.min_significance;
  options.focus.bin_slices = arguments.bin_slices;
  options.focus.stage_correction = arguments.stage_correction;
  options.peak = *peak_method_from_name(arguments.peak);  // the parser lets only known names through
  for (const auto& name : arguments.extra_peaks) options.extra_peaks.push_back(*peak_method_from_name(name));
  if (arguments.pixel_pitch_um != 0.0) options.pixel_pitch_um = arguments.pixel_pitch_um;
  options.threads = arguments.threads;
  return options;
}

void print_summary(std::ostream& out, const ProcessReport& report, const std::filesystem::path& directory) {
  const Result& result = report.result;
  const auto um = [&result](std::string_view name) { return result.find(name)->value; };
  std::ostringstream text;
  text << std::fixed << std::setprecision(3);
  text << "slices    " << report.slices_text << ", " << result.focus.width_px << " x " << result.focus.height_px
       << " pixels\n";
  text << "valid     " << 100.0 * result.valid_fraction() << " %\n";
  if (um("height_median")) {
    text << "heights   " << *um("height_min") << " to " << *um("height_max") << " um, median " << *um("height_median")
         << " um\n";
  } else {
    text << "heights   none: every point is a hole, see hole_points in result.json\n";
  }
  if (result.verdict) text << "verdict   " << verdict_name(*result.verdict) << "\n";
  for (const Warning& warning : result.warnings) text << "warning   " << warning.text << "\n";
  text << "memory    " << std::setprecision(1) << result.focus.state_bytes_per_pixel
       << " bytes per pixel, whatever the number of slices\n";
  text << "result    " << directory.string() << "\n";
  out << text.str() << std::flush;
}

}  // namespace

void add_process_options(CLI::App& command, ProcessArguments& a) {
  command.add_option("source", a.source, "folder of slices (PNG, TIFF, JPEG, PGM), or a multi-page TIFF")->required();
  command.add_option("--out", a.out, "directory to make for the result; must not exist")->required();
  CLI::Option* step = command.add_option("--z-step-um", a.z_step_um, "z from one slice to the next, may be negative");
  command.add_option("--z-start-um", a.z_start_um, "z of the first slice")->needs(step)->capture_default_str();
  CLI::Option* file = command.add_option("--z-file", a.z_file, "z of each slice, one number a line, # for comments");
  file->excludes(step);
  command.add_option("--z-unit", a.z_unit, "unit of the z file")
      ->needs(file)
      ->check(CLI::IsMember({"um", "mm", "m"}))
      ->capture_default_str();
  command.add_option("--window", a.window_px, "side of the focus window in pixels, odd, 3..63; the intensity has none")
      ->capture_default_str();
  command.add_option("--operator", a.focus_operator, "what is summed over the window as the measure of sharpness")
      ->check(CLI::IsMember(operator_names()))
      ->capture_default_str();
  command.add_option("--distance", a.distance_px, "from a pixel to the neighbours its operator looks at, 1..7 pixels")
      ->capture_default_str();
  command.add_option("--bin", a.bin_slices, "slices summed to one sample of the focus curve, 1..64")
      ->capture_default_str();
  command.add_option("--peak", a.peak, "how heights are taken from the focus curve")
      ->check(CLI::IsMember(peak_names()))
      ->capture_default_str();
  command.add_option("--extra-peak", a.extra_peaks, "further height maps, may be repeated")
      ->check(CLI::IsMember(peak_names()));
  command.add_option("--min-prominence", a.min_prominence, "points with a flatter focus curve become holes, 0..1")
      ->capture_default_str();
  command.add_option("--min-significance", a.min_significance, "points whose curve rises by less noise become holes")
      ->capture_default_str();
  command.add_flag("--stage-correction", a.stage_correction,
                   "seek the stage's errors in the focus curves and correct heights by them");
  command.add_option("--pixel-pitch-um", a.pixel_pitch_um, "distance of pixels on the object");
  command.add_option("--part", a.part_id, "part id to write into the result; default: the name of the source");
  command.add_option("--threads", a.threads, "0: one a core")->check(CLI::Range(0, 256))->capture_default_str();
}

int run_process(const ProcessArguments& arguments, const Terminal& terminal) {
  const ProcessOptions options = options_of(arguments);
  ProgressLine progress(terminal.err, terminal.err_is_terminal);
  const ProcessReport report = process_stack(options, [&progress](int done, int total) {
    progress.update(static_cast<double>(done) / total, "slice " + std::to_string(done) + "/" + std::to_string(total));
  });
  progress.end();
  print_summary(terminal.out, report, options.out);
  return kExitOk;
}

}  // namespace fvd::ctl
