/// Writes SDF (ISO 25178-71:2017), binary, version ISO-1.0.

#include <ctime>
#include <limits>

#include "core/base/error.hpp"
#include "daemon/export/binary_text.hpp"
#include "daemon/export/length_text.hpp"
#include "daemon/export/surface_writers.hpp"

namespace fvd {

namespace {

constexpr std::uint8_t kDoubleType = 7;
constexpr double kUnknownResolution = -1.0;

/// "DDMMYYYYHHMM" in UTC; blanks where the time is not known.
std::string date_text(const std::optional<std::chrono::system_clock::time_point>& time) {
  if (!time) return std::string(12, ' ');
  const std::time_t seconds = std::chrono::system_clock::to_time_t(*time);
  std::tm parts{};
  gmtime_r(&seconds, &parts);
  char text[16];
  const std::size_t length = std::strftime(text, sizeof text, "%d%m%Y%H%M", &parts);
  std::string date(text, length);
  date.resize(12, ' ');
  return date;
}

}  // namespace

void write_sdf(const SurfaceView& surface, const ByteSink& sink) {
  const PlaneView<const float>& height_m = surface.height_m;
  constexpr int kMostPoints = std::numeric_limits<std::uint16_t>::max();
  if (height_m.width > kMostPoints || height_m.height > kMostPoints) {
    throw Error(ErrorCode::kBadInput, "sdf holds at most 65535 points a side, the surface has " +
                                          std::to_string(height_m.width) + " x " + std::to_string(height_m.height));
  }
  BinaryText file(sink);
  file.add_text("bISO-1.0");
  file.add_text("fvd       ");  // ManufacID
  const std::string date = date_text(surface.origin.created);
  file.add_text(date);
  file.add_text(date);
  file.add(static_cast<std::uint16_t>(height_m.width));
  file.add(static_cast<std::uint16_t>(height_m.height));
  file.add(metres_of(surface.pitch_x_um.value()));
  file.add(metres_of(surface.pitch_y_um.value()));
  file.add(1.0);  // Zscale: metres
  file.add(kUnknownResolution);
  file.add(std::uint8_t{0});  // not compressed
  file.add(kDoubleType);
  file.add(std::uint8_t{0});  // no check
  for (int y = 0; y < height_m.height; ++y) {
    for (int x = 0; x < height_m.width; ++x) file.add(static_cast<double>(height_m.at(x, y)));
  }
  file.flush();
}

}  // namespace fvd
