#include "daemon/ctl/suggest_command.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iomanip>
#include <optional>
#include <sstream>
#include <thread>

#include "core/base/error.hpp"
#include "core/focus/focus_suggestion.hpp"
#include "core/focus/streaming_focus_stack.hpp"
#include "core/runtime/worker_pool.hpp"
#include "daemon/ctl/exit_codes.hpp"
#include "drivers/replay/recorded_stack.hpp"
#include "drivers/replay/slice_image.hpp"
#include "drivers/replay/tiff_pages.hpp"

namespace fvd::ctl {

namespace {

constexpr double kLeastWidth_slices = 2.0;

/// What a suggestion rests on.
struct Evidence {
  FocusSuggestion suggestion;
  std::optional<double> width_slices;  ///< of the focus curve
};

/// The surface in focus everywhere, and the noise where it is not.
Evidence look_at_stack(const std::filesystem::path& source, const StackChoice& choice) {
  const RecordedStack stack(find_slices(source, choice));
  WorkerPool pool(std::max(1, static_cast<int>(std::thread::hardware_concurrency())));
  StreamingFocusStack focus(stack.width(), stack.height(), stack.format(), {}, pool);
  SliceImage image;
  for (int index = 0; index < stack.slices(); ++index) {
    stack.read(index, image);
    focus.push(image.view(), index);
  }
  const HeightMap map = focus.finish(PeakMethod::kFiveSample);
  Evidence evidence;
  if (map.curve_width_um > 0.0) evidence.width_slices = map.curve_width_um;  // slices are 1 apart
  if (stack.format() == PixelFormat::kMono8) {
    Plane<std::uint8_t> sharp(stack.width(), stack.height());
    for (int y = 0; y < sharp.height(); ++y) {
      const auto narrow = [](std::uint16_t level) { return static_cast<std::uint8_t>(level); };
      std::transform(map.texture.row(y), map.texture.row(y) + sharp.width(), sharp.row(y), narrow);
    }
    evidence.suggestion = suggest_focus(image_view(sharp.view(), stack.format()), map.noise_grey);
  } else {
    evidence.suggestion = suggest_focus(image_view(map.texture.view(), stack.format()), map.noise_grey);
  }
  return evidence;
}

Evidence look_at(const std::filesystem::path& source, const StackChoice& choice) {
  if (!std::filesystem::exists(source)) {
    throw Error(ErrorCode::kBadInput, "there is no file or folder " + source.string());
  }
  if (std::filesystem::is_directory(source) || tiff_content(source).size() > 1) return look_at_stack(source, choice);
  if (!choice.pattern.empty() || choice.channel || choice.time) {
    throw Error(ErrorCode::kBadInput, source.string() + " is one image: --pattern, --channel and --time choose among " +
                                          "the files or pages of a stack");
  }
  SliceImage slice;
  read_slice({source, std::nullopt}, slice);
  return {suggest_focus(slice.view()), std::nullopt};
}

}  // namespace

int run_suggest(const std::string& source, const StackChoice& choice, const Terminal& terminal) {
  const auto [suggestion, width_slices] = look_at(source, choice);
  const FocusSettings usual;
  std::ostringstream text;
  text << std::fixed << std::setprecision(2) << "\"focus\": { \"distance_px\": " << suggestion.distance_px
       << ", \"window_px\": " << suggestion.window_px << " }"
       << (suggestion.distance_px == usual.distance_px && suggestion.window_px == usual.window_px ? "  (the defaults)"
                                                                                                  : "")
       << "\nnoise     " << suggestion.noise_grey << " grey levels per pixel\n"
       << "texture   " << suggestion.response_grey << " grey levels of mean modified Laplacian above the noise\n"
       << "sample    noise " << 100.0 * suggestion.sample_noise << " % of the peak\n";
  if (width_slices) {
    text << "curve     " << *width_slices << " slices wide at half its height; bins of "
         << choose_bin_slices(1.0, *width_slices) << " slice(s) are chosen by themselves\n";
    if (*width_slices < kLeastWidth_slices) {
      text << "steps     coarser than half of the curve's width: heights are less certain, take slices closer "
              "together\n";
    }
  }
  terminal.out << text.str() << std::flush;
  return kExitOk;
}

}  // namespace fvd::ctl
