#include "daemon/ctl/suggest_confocal.hpp"

#include <iomanip>
#include <sstream>

#include "core/base/error.hpp"
#include "core/focus/confocal_width.hpp"
#include "core/focus/measure/focus_settings.hpp"
#include "daemon/ctl/exit_codes.hpp"

namespace fvd::ctl {

void add_confocal_options(CLI::App& command, CLI::Option& source, ConfocalOptics& optics) {
  CLI::Option* na = command.add_option("--na", optics.na, "of a confocal microscope: numerical aperture");
  CLI::Option* wavelength =
      command.add_option("--wavelength-nm", optics.wavelength_nm, "of a confocal microscope: wavelength in vacuum");
  na->needs(wavelength)->excludes(&source);
  wavelength->needs(na);
  command.add_option("--index", optics.index, "refractive index between lens and surface")
      ->needs(na)
      ->capture_default_str();
}

int run_suggest_confocal(const ConfocalOptics& optics, const Terminal& terminal) {
  constexpr double kStep_widths = 0.33;  // from there on closer slices tell more of noise than of the curve
  constexpr double kFine_widths = 0.05;
  if (optics.na == 0.0) {
    throw Error(ErrorCode::kBadInput,
                "name slices or an image of a surface, or, of a confocal microscope, --na and --wavelength-nm");
  }
  const double width_um = confocal_width_um(optics.na, optics.wavelength_nm / 1000.0, optics.index);
  const double step_um = kStep_widths * width_um;
  std::ostringstream text;
  text << std::fixed << std::setprecision(3) << "\"scan\": { \"step_um\": " << step_um << " }\n"
       << "\"focus\": { \"operator\": \"intensity\", \"window_px\": 1, \"curve_width_um\": " << width_um << " }\n"
       << "curve     " << width_um << " um wide at half its height; a pinhole that is no point, and the sine "
       << "condition, widen it\n"
       << "steps     up to " << width_um / 2.0 << " um; of closer ones several are summed by themselves, "
       << choose_bin_slices(kFine_widths * width_um, width_um) << " of " << kFine_widths * width_um << " um\n";
  terminal.out << text.str() << std::flush;
  return kExitOk;
}

}  // namespace fvd::ctl
