#include "daemon/ctl/report_command.hpp"

#include <CLI/CLI.hpp>

#include "core/surface/verdict.hpp"
#include "daemon/ctl/exit_codes.hpp"
#include "daemon/ctl/pitch_option.hpp"
#include "daemon/export/durable_file.hpp"
#include "daemon/report/report_pdf.hpp"
#include "daemon/surface_files/result_folder.hpp"

namespace fvd::ctl {

void add_report_options(CLI::App& command, ReportArguments& a) {
  command.add_option("source", a.source, "folder of a result")->required();
  command.add_option("--out", a.out, "the new PDF file; must not exist")->required();
  add_pitch_option(command, a.pitch_um);
}

int run_report(const ReportArguments& arguments, const Terminal& terminal) {
  const ResultSurface read = read_result_surface(arguments.source, read_options(arguments.pitch_um));
  const std::string pdf = report_pdf(read.result, picture_surface(read.surface));
  write_new_file(arguments.out, [&pdf](const ByteSink& sink) { sink(pdf); });
  if (read.result.verdict) terminal.out << "verdict   " << verdict_name(*read.result.verdict) << "\n";
  terminal.out << "file      " << arguments.out << "\n" << std::flush;
  return kExitOk;
}

}  // namespace fvd::ctl
