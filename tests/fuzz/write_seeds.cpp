/// write_seeds FOLDER: one small good file of each format in FOLDER/<format>/, for the fuzzers to begin with.

#include <filesystem>
#include <fstream>
#include <iostream>
#include <limits>

#include "daemon/export/height_tiff.hpp"
#include "daemon/export/surface_writers.hpp"

namespace {

void write(const std::filesystem::path& folder, const std::string& format, const std::string& bytes) {
  std::filesystem::create_directories(folder / format);
  std::ofstream(folder / format / "seed", std::ios::binary) << bytes;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: write_seeds FOLDER\n";
    return 64;
  }
  const std::filesystem::path folder = argv[1];
  fvd::Surface surface;
  surface.height_m = fvd::Plane<float>(3, 2, 1e-6F);
  surface.height_m.at(1, 1) = std::numeric_limits<float>::quiet_NaN();
  surface.pitch_x_um = surface.pitch_y_um = 0.5;
  const fvd::SurfaceView view = fvd::surface_view(surface, {});
  for (const std::string format : {"x3p", "gsf", "sdf", "csv"}) {
    write(folder, format, fvd::surface_bytes(*fvd::find_surface_writer(format), view));
  }
  const std::string x3p = fvd::surface_bytes(*fvd::find_surface_writer("x3p"), view);
  const auto xml = x3p.find("<?xml");
  constexpr std::string_view kRootEnd = "</p:ISO5436_2>\n";
  write(folder, "x3p_main", x3p.substr(xml, x3p.find(kRootEnd) + kRootEnd.size() - xml));
  write(folder, "tiff", fvd::encode_height_tiff(surface.height_m, {"", "", {}, {}}));
  std::ofstream(folder / "sdf" / "ascii")
      << "aISO-1.0\nNumPoints = 3\nNumProfiles = 2\nXscale = 5e-7\nYscale = 5e-7\nZscale = 1e-9\nDataType = 6\n*\n"
         "1 2 BAD\n4 5 6\n*\n";
  return 0;
}
