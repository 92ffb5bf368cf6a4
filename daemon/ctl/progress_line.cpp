#include "daemon/ctl/progress_line.hpp"

#include <algorithm>
#include <cmath>

namespace fvd::ctl {

namespace {

constexpr int kBarCells = 30;

}  // namespace

void ProgressLine::update(double fraction, const std::string& text) {
  if (text == last_) return;
  last_ = text;
  if (!terminal_) {
    out_ << text << std::endl;  // flushed: whoever reads a pipe wants it now
    return;
  }
  const double clamped = std::isfinite(fraction) ? std::clamp(fraction, 0.0, 1.0) : 0.0;
  const auto filled = static_cast<std::size_t>(std::lround(clamped * kBarCells));
  // \x1b[K clears what is left of a longer line before.
  out_ << "\r[" << std::string(filled, '#') << std::string(kBarCells - filled, '.') << "] " << text << "\x1b[K"
       << std::flush;
  open_ = true;
}

void ProgressLine::end() {
  if (open_) out_ << std::endl;
  open_ = false;
}

}  // namespace fvd::ctl
