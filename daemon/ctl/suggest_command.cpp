#include "daemon/ctl/suggest_command.hpp"

#include <iomanip>
#include <sstream>

#include "core/focus/focus_suggestion.hpp"
#include "daemon/ctl/exit_codes.hpp"
#include "drivers/replay/slice_image.hpp"

namespace fvd::ctl {

int run_suggest(const std::string& image, const Terminal& terminal) {
  SliceImage slice;
  read_slice({image, std::nullopt}, slice);
  const FocusSuggestion suggestion = suggest_focus(slice.view());
  std::ostringstream text;
  text << std::fixed << std::setprecision(2) << "\"focus\": { \"distance_px\": " << suggestion.distance_px
       << ", \"window_px\": " << suggestion.window_px << " }\n"
       << "noise     " << suggestion.noise_grey << " grey levels per pixel\n"
       << "texture   " << suggestion.response_grey << " grey levels of mean modified Laplacian above the noise\n"
       << "sample    noise " << 100.0 * suggestion.sample_noise << " % of the peak\n";
  terminal.out << text.str() << std::flush;
  return kExitOk;
}

}  // namespace fvd::ctl
