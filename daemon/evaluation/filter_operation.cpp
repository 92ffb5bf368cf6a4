#include "daemon/evaluation/filter_operation.hpp"

#include <sstream>
#include <string>
#include <utility>

#include "core/base/error.hpp"
#include "core/metrology/filter/surface_filter.hpp"

namespace fvd {

namespace {

using metrology::FilterReport;
using metrology::OperationReport;

constexpr double kLeastWindows = 2.0;

template <typename... Parts>
std::string text_of(const Parts&... parts) {
  std::ostringstream text;
  text.precision(3);
  (text << ... << parts);
  return text.str();
}

OperationReport report_of(const FilterReport& filter, const PlannedOperation& step, double window_um) {
  OperationReport report;
  report.points_used = filter.points_in;
  report.points_removed = filter.points_lost;
  report.values = {{"nesting_x_px", filter.nesting_px_x, {}},
                   {"nesting_y_px", filter.nesting_px_y, {}},
                   {"margin_um", filter.margin_um, {}},
                   {"border_error_um", filter.border_error_um, {}}};
  if (step.robust) {
    report.values.push_back({"rounds", static_cast<double>(filter.rounds), {}});
    if (filter.cut_um) report.values.push_back({"cut_um", *filter.cut_um, {}});
  }
  if (!filter.converged) {
    report.warnings.push_back(text_of("the robust filter did not settle in ", filter.rounds, " rounds"));
  }
  if (filter.border_error_above_noise) {
    report.warnings.push_back(text_of("at borders and holes the filter moves the surface by up to ",
                                      filter.border_error_um, " um, more than the noise of ", *filter.noise_floor_um,
                                      " um: take the form away first, or a regression of a higher degree"));
  }
  if (step.side == "S" && step.nesting_um < kLeastWindows * window_um) {
    report.warnings.push_back(text_of("the S filter of ", step.nesting_um, " um is shorter than two focus windows of ",
                                      window_um, " um, which have taken those wavelengths already"));
  }
  return report;
}

}  // namespace

OperationReport filter_operation(const PlannedOperation& step, WorkerPool* pool, metrology::HeightField& field) {
  metrology::FilterSettings settings;
  settings.side = metrology::filter_side_from_name(step.side).value();
  settings.nesting_um = step.nesting_um;
  settings.method = metrology::filter_method_from_name(step.method).value();
  settings.robust = step.robust;
  settings.keep_margin = step.keep_margin;
  const double window_um = field.kernel.width_px() * field.pitch_x_um;
  try {
    metrology::FilteredSurface filtered = metrology::filter_surface(field, settings, pool);
    field = std::move(filtered.surface);
    return report_of(filtered.report, step, window_um);
  } catch (const Error& error) {
    return metrology::refusal(error.what());
  }
}

}  // namespace fvd
