#include "daemon/surface_files/surface_files.hpp"

#include <cctype>

#include "daemon/surface_files/file_bytes.hpp"
#include "daemon/surface_files/result_folder.hpp"
#include "daemon/surface_files/surface_readers.hpp"

namespace fvd {

namespace {

constexpr std::size_t kHead_bytes = 32;

/// The name's ending without the point, in lower case.
std::string ending_of(const std::filesystem::path& path) {
  std::string ending = path.extension().string();
  for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return ending.empty() ? ending : ending.substr(1);
}

bool is_tiff(std::string_view head) {
  for (const std::string_view magic : {std::string_view("II*\0", 4), std::string_view("MM\0*", 4),
                                       std::string_view("II+\0", 4), std::string_view("MM\0+", 4)}) {
    if (head.starts_with(magic)) return true;
  }
  return false;
}

}  // namespace

Surface read_surface(const std::filesystem::path& path, const SurfaceReadOptions& options) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) return std::move(read_result_surface(path, options).surface);
  const std::string head = FileBytes(path).text(0, kHead_bytes);
  if (head.starts_with("PK")) return read_x3p(path, options);
  if (head.starts_with("Gwyddion Simple Field")) return read_gsf(path, options);
  if (head.starts_with("aISO") || head.starts_with("bISO") || head.starts_with("aBCR") || head.starts_with("bBCR")) {
    return read_sdf(path, options);
  }
  if (is_tiff(head)) return read_float_tiff(path, options);
  const std::string ending = ending_of(path);
  if (ending == "csv" || ending == "txt" || ending == "asc") return read_surface_csv(path, options);
  refuse(path, byte_place(0), "it is none of X3P, GSF, SDF, TIFF and, by its name, CSV");
}

}  // namespace fvd
