#include "daemon/ctl/export_command.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include <CLI/CLI.hpp>

#include "core/base/error.hpp"
#include "daemon/base/version.hpp"
#include "daemon/ctl/exit_codes.hpp"
#include "daemon/ctl/kept_slices.hpp"
#include "daemon/ctl/pitch_option.hpp"
#include "daemon/export/durable_file.hpp"
#include "daemon/export/ome_tiff.hpp"
#include "daemon/export/surface_writers.hpp"
#include "daemon/surface_files/result_folder.hpp"
#include "daemon/surface_files/texture_image.hpp"

namespace fvd::ctl {

namespace {

namespace fs = std::filesystem;

constexpr const char* kSlices = "ome-tiff";  ///< of the slices, not of the surface

std::vector<std::string> formats() {
  std::vector<std::string> names{kSlices};
  for (const SurfaceWriter& writer : surface_writers()) names.emplace_back(writer.format);
  return names;
}

void write(const ExportArguments& arguments, const SurfaceView& view) {
  const SurfaceWriter& writer = *find_surface_writer(arguments.format);  // the parser lets only known names through
  write_new_file(arguments.out, [&](const ByteSink& sink) { write_surface(writer, view, sink); });
}

void print_summary(const ExportArguments& arguments, const Surface& surface, const Terminal& terminal) {
  const auto pixels = surface.height_m.pixels();
  const auto holes = std::count_if(pixels.begin(), pixels.end(), [](float height) { return std::isnan(height); });
  terminal.out << "points    " << surface.width() << " x " << surface.height() << ", " << holes << " holes\n"
               << "pitch     " << surface.pitch_x_um << " x " << surface.pitch_y_um << " um\n"
               << "file      " << arguments.out << "\n"
               << std::flush;
}

int export_slices(const ExportArguments& arguments, const SurfaceReadOptions& options, const Terminal& terminal) {
  KeptSlices slices(arguments.source, options);
  const OmeStack& stack = slices.stack();
  write_ome_tiff(arguments.out, stack, [&slices](int index) { return slices.read(index); });
  terminal.out << "slices    " << stack.slices() << " of " << stack.width << " x " << stack.height << " pixels, "
               << significant_bits(stack.format) << " bit\n";
  if (stack.pitch_x_um && stack.pitch_y_um) {
    terminal.out << "pitch     " << *stack.pitch_x_um << " x " << *stack.pitch_y_um << " um\n";
  }
  terminal.out << "z         " << stack.z_um.front() << " to " << stack.z_um.back() << " um\n"
               << "file      " << arguments.out << "\n"
               << std::flush;
  return kExitOk;
}

}  // namespace

void add_export_options(CLI::App& command, ExportArguments& a) {
  command.add_option("source", a.source, "folder of a result, or a file of a surface: X3P, GSF, SDF, float TIFF, CSV")
      ->required();
  command
      .add_option("--format", a.format,
                  "of the new file; gsf_sigma: the standard errors; ome-tiff: the slices that a job kept")
      ->required()
      ->check(CLI::IsMember(formats()));
  command.add_option("--out", a.out, "the new file; must not exist")->required();
  add_pitch_option(command, a.pitch_um);
}

int run_export(const ExportArguments& arguments, const Terminal& terminal) {
  const SurfaceReadOptions options = read_options(arguments.pitch_um);
  if (arguments.format == kSlices) return export_slices(arguments, options, terminal);
  if (fs::is_directory(arguments.source)) {
    const ResultSurface read = read_result_surface(arguments.source, options);
    const TextureImage texture = read_texture(arguments.source, read.surface, read.result);
    SurfaceView view = surface_view(read.surface, surface_origin(read.result));
    if (!texture.colour.empty()) view.colour = texture.colour.view();
    if (!texture.grey.empty()) view.grey = texture.grey.view();
    view.max_grey = max_grey_level(texture.format);
    write(arguments, view);
    print_summary(arguments, read.surface, terminal);
    return kExitOk;
  }
  const Surface surface = read_surface(arguments.source, options);
  SurfaceOrigin origin;
  origin.title = surface.title;
  origin.source = fs::path(arguments.source).filename().string();
  origin.software_version = kVersion;
  write(arguments, surface_view(surface, origin));
  print_summary(arguments, surface, terminal);
  return kExitOk;
}

}  // namespace fvd::ctl
