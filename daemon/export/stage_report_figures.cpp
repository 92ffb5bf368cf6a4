#include "daemon/export/stage_report_figures.hpp"

#include <algorithm>
#include <cmath>

#include "daemon/report/axis_ticks.hpp"

namespace fvd {

namespace {

/// So many that the first digit of the standard error is seen, but not more than two beyond the usual.
int decimals_for(double standard_error, int usual) {
  if (!(standard_error > 0.0)) return usual;
  return std::clamp(static_cast<int>(std::ceil(-std::log10(standard_error))), usual, usual + 2);
}

class Lines {
 public:
  void heading(const std::string& text) { heading_ = text; }
  /// A heading appears with its first line.
  void add(const std::string& name, const std::string& value) {
    if (!heading_.empty()) list_.push_back({heading_, ""});
    heading_.clear();
    list_.push_back({name, value});
  }
  void add(const std::string& name, const std::optional<double>& value, int decimals, const std::string& unit) {
    if (value) add(name, fixed_text(*value, decimals) + unit);
  }
  void add(const std::string& name, const std::optional<Estimate>& e, int decimals, const std::string& unit) {
    if (!e) return;
    if (e->standard_error) decimals = decimals_for(*e->standard_error, decimals);
    std::string text = fixed_text(e->value, decimals);
    if (e->standard_error) text += " +- " + fixed_text(*e->standard_error, decimals);
    add(name, text + unit);
  }
  std::vector<FigureLine> take() { return std::move(list_); }

 private:
  std::string heading_;
  std::vector<FigureLine> list_;
};

void add_errors(Lines& lines, const std::string& title, const std::optional<ErrorFigures>& f) {
  if (!f) return;
  lines.heading(title);
  lines.add("mean", f->mean_um, 3, " um");
  lines.add("sd", f->sd_um, 3, " um");
  lines.add("max |e|", f->max_um, 3, " um");
  lines.add("P95 |e|", f->p95_um, 3, " um");
}

}  // namespace

std::vector<FigureLine> figure_lines(const StageReport& report) {
  Lines lines;
  add_errors(lines, "Position error", report.error);
  add_errors(lines, "Error of one step", report.increment_error);
  if (!report.observable) add_errors(lines, "Quantisation", report.quantisation);
  lines.heading("Response");
  if (report.fit) lines.add("alpha_z", report.fit->alpha_z, 6, "");
  if (report.linear) {
    lines.add("alpha_z of the line", report.linear->alpha_z.value, 6, "");
    lines.add("l_z", report.linear->l_z_um, 3, " um");
  }
  if (report.fit && report.fit->lead) {
    const LeadTerm& lead = *report.fit->lead;
    lines.add("lead error A", lead.amplitude_um, 3, " um");
    lines.add("phase", lead.phase_deg, 1, " deg");
  }
  if (report.fit) lines.add("residual rms", report.fit->residual_rms_um, 3, " um");
  lines.heading("Reversal, repeatability");
  if (report.reversal) {
    lines.add("reversal mean", report.reversal->mean_um, 3, " um");
    lines.add("reversal max", report.reversal->max_um, 3, " um");
  }
  if (report.repeatability) {
    lines.add("s pooled", report.repeatability->pooled_sd_um, 3, " um");
    lines.add("s max", report.repeatability->max_sd_um, 3, " um");
  }
  lines.heading("Drift");
  if (report.fit) {
    lines.add("linear", report.fit->drift_um_per_min, 3, " um/min");
    lines.add("thermal", report.fit->drift_um_per_k, 3, " um/K");
  }
  if (report.settle) {
    lines.heading("Settling");
    lines.add("p50 / p95 / max", fixed_text(report.settle->p50_ms, 0) + " / " + fixed_text(report.settle->p95_ms, 0) +
                                     " / " + fixed_text(report.settle->max_ms, 0) + " ms");
  }
  lines.heading("Uncertainty floors");
  lines.add("step quantum / sqrt 12", report.step_quantum_floor_um, 4, " um");
  lines.add("feedback / sqrt 12", report.feedback_floor_um, 4, " um");
  return lines.take();
}

}  // namespace fvd
