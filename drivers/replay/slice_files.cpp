#include "drivers/replay/slice_files.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <map>
#include <system_error>
#include <tuple>
#include <utility>

#include "core/base/error.hpp"
#include "drivers/replay/name_columns.hpp"
#include "drivers/replay/name_fields.hpp"
#include "drivers/replay/name_order.hpp"
#include "drivers/replay/name_pattern.hpp"
#include "drivers/replay/tiff_pages.hpp"

namespace fvd {

namespace fs = std::filesystem;

namespace {

bool is_tiff(const fs::path& file) { return plain_extension(file.filename().string()) == ".tif"; }

bool is_image(const fs::path& file) {
  constexpr std::array kExtensions{".png", ".tif", ".jpg", ".pgm", ".bmp"};
  const std::string extension = plain_extension(file.filename().string());
  return std::any_of(kExtensions.begin(), kExtensions.end(), [&](const char* known) { return extension == known; });
}

/// Whether it could be meant for a slice, readable or not.
bool is_picture(const fs::path& file) {
  constexpr std::array kOthers{".webp", ".gif", ".jp2", ".jxl", ".heic", ".exr", ".ppm", ".pnm", ".fits",
                               ".raw",  ".dng", ".nef", ".cr2", ".cr3",  ".arw", ".czi", ".nd2", ".lif"};
  const std::string extension = lower_case(file.extension().string());
  return is_image(file) ||
         std::any_of(kOthers.begin(), kOthers.end(), [&](const char* known) { return extension == known; });
}

[[noreturn]] void refuse(const std::string& message) { throw Error(ErrorCode::kBadInput, message); }

/// Visible files that may be slices, by name.
std::vector<std::string> pictures_in(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    std::string name = entry.path().filename().string();
    if (entry.is_regular_file() && !name.starts_with('.') && is_picture(name)) names.push_back(std::move(name));
  }
  if (error) refuse("cannot read folder " + folder.string() + ": " + error.message());
  std::sort(names.begin(), names.end());
  return names;
}

/// Slices that belong together: names of one skeleton, or one multi-page TIFF.
struct Candidate {
  std::string description;
  std::vector<std::string> names;
  std::string tiff;
  std::size_t slices = 0;
};

/// "a*b*.png" of "a12b007.png".
std::string starred(const std::string& name) {
  const fs::path file(name);
  const NameFields fields = name_fields(file.stem().string());
  std::string text = fields.texts.front();
  for (std::size_t i = 1; i < fields.texts.size(); ++i) text += "*" + fields.texts[i];
  return text + file.extension().string();
}

/// "a*b{n}.png" of "a12b007.png".
std::string counted(const std::string& name) {
  std::string text = starred(name);
  return text.replace(text.rfind('*'), 1, "{n}");
}

Candidate pages(const std::string& name, int count) {
  return {name + " (" + std::to_string(count) + " pages)", {}, name, static_cast<std::size_t>(count)};
}

std::vector<Candidate> candidates_in(const fs::path& folder, const std::vector<std::string>& pictures) {
  std::map<std::string, std::vector<std::string>> families;
  std::vector<Candidate> candidates;
  for (const std::string& name : pictures) {
    if (!is_image(name)) continue;
    const NameFields fields = name_fields(fs::path(name).stem().string());
    if (!fields.numbers.empty()) families[fields.skeleton() + plain_extension(name)].push_back(name);
    if (is_tiff(name)) {
      if (const int count = tiff_content(folder / name).size(); count > 1) candidates.push_back(pages(name, count));
    }
  }
  for (auto& [key, names] : families) {
    const std::size_t count = names.size();
    const std::string description = starred(names.front()) + " (" + std::to_string(count) + " files)";
    candidates.push_back({description, std::move(names), {}, count});
  }
  std::sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
    return std::tuple(b.slices, a.description) < std::tuple(a.slices, b.description);
  });
  return candidates;
}

/// Names that a person would take for slices of the same stack, although they have other numbers, or none, as "img.png"
/// before "img (1).png".
void check_same_words(const fs::path& folder, const Candidate& best, const std::vector<Candidate>& all,
                      const std::vector<std::string>& pictures) {
  if (best.names.empty()) return;
  const auto words = [](const std::string& name) {
    return name_fields(fs::path(name).stem().string()).words() + plain_extension(name);
  };
  for (const Candidate& other : all) {
    if (&other == &best || other.names.empty() || words(other.names.front()) != words(best.names.front())) continue;
    ask_for_pattern("in " + folder.string() + " are " + best.description + " and also " + other.names.front() +
                        ", which may be a slice of them",
                    {counted(best.names.front()), counted(other.names.front())});
  }
  for (const std::string& name : pictures) {
    if (!is_image(name) || !name_fields(fs::path(name).stem().string()).numbers.empty()) continue;
    if (words(name) != words(best.names.front())) continue;
    ask_for_pattern("in " + folder.string() + " are " + best.description + " and also " + name +
                        ", which has no number and may be the first of them: give it one if it is a slice; if not",
                    {counted(best.names.front())});
  }
}

/// slices of the names that are used; the other pictures are ignored.
SliceList listed(const fs::path& folder, const std::vector<std::string>& names, NameOrder order,
                 const std::vector<std::string>& pictures) {
  SliceList result;
  result.description = std::move(order.description);
  result.gap = std::move(order.gap);
  result.doubt = std::move(order.doubt);
  result.z_um = std::move(order.z_um);
  if (!result.z_um.empty()) result.z_from = "the names";
  for (const std::size_t index : order.order) result.slices.push_back({folder / names[index], std::nullopt, false});
  result.used_files = static_cast<int>(names.size());
  std::set_difference(pictures.begin(), pictures.end(), names.begin(), names.end(), std::back_inserter(result.ignored));
  return result;
}

SliceList listed_pages(const fs::path& file, const StackChoice& choice, const std::vector<std::string>& pictures) {
  SliceList result = tiff_slices(file, choice);
  result.used_files = 1;
  const std::string used = file.filename().string();
  std::copy_if(pictures.begin(), pictures.end(), std::back_inserter(result.ignored),
               [&](const std::string& name) { return name != used; });
  return result;
}

constexpr const char* kExpected =
    "; expected image files (PNG, TIFF, JPEG, PGM, BMP) whose names differ in a number only, such as slice_000.png, "
    "slice_001.png, or one multi-page TIFF; --pattern of fvdctl describes other names";

SliceList find_by_pattern(const fs::path& folder, const NamePattern& pattern) {
  const auto pictures = pictures_in(folder);
  std::vector<std::string> names;
  std::copy_if(pictures.begin(), pictures.end(), std::back_inserter(names),
               [&](const std::string& name) { return is_image(name) && pattern.matches(name); });
  if (names.size() < 2) {
    refuse("--pattern '" + pattern.text() + "' matches " + std::to_string(names.size()) + " of the " +
           std::to_string(pictures.size()) + " image files in " + folder.string() +
           (pictures.empty() ? "" : ", such as " + pictures.front()) + ": a height map needs several");
  }
  return listed(folder, names, pattern.order(names), pictures);
}

}  // namespace

std::string SliceLocation::name() const {
  return page ? file.filename().string() + " page " + std::to_string(*page + 1) : file.filename().string();
}

SliceList find_slices(const fs::path& source, const StackChoice& choice) {
  const std::string& pattern = choice.pattern;
  std::error_code error;
  const auto status = fs::status(source, error);
  if (!fs::exists(status)) refuse("there is no file or folder " + source.string());
  if (fs::is_regular_file(status)) {
    const TiffContent content = is_tiff(source) ? tiff_content(source) : TiffContent{};
    if (content.size() < 2 && content.contiguous == 0)
      refuse(source.string() + " is a file but not a TIFF with several pages; expected one, or a folder of slices");
    if (!pattern.empty()) refuse(source.string() + " is one file: --pattern is for the names in a folder");
    return listed_pages(source, choice, {});
  }
  if (!fs::is_directory(status)) refuse(source.string() + " is neither a folder nor a file");
  if (!pattern.empty()) return find_by_pattern(source, NamePattern(pattern));
  const auto require_no_page = [&](const std::string& description) {
    if (!choice.channel && !choice.time) return;
    refuse("--channel and --time choose pages of a TIFF, but the slices are " + description +
           ": choose files with --pattern");
  };
  const auto pictures = pictures_in(source);
  const auto candidates = candidates_in(source, pictures);
  if (candidates.empty()) refuse("no slices in " + source.string() + kExpected);
  const Candidate& best = candidates.front();
  if (best.slices < 2 && candidates.size() > 1) {
    refuse("in " + source.string() + " no two names differ in their numbers only, as " + best.names.front() + " and " +
           candidates[1].names.front() + " show" + kExpected);
  }
  if (best.slices < 2) {
    refuse(source.string() + " has only one slice, " + best.names.front() + ": a height map needs several" + kExpected);
  }
  if (candidates.size() > 1 && 2 * candidates[1].slices > best.slices) {
    refuse("in " + source.string() + " both " + best.description + " and " + candidates[1].description +
           " could be the slices: move the others away, or say with --pattern of fvdctl which names are slices");
  }
  check_same_words(source, best, candidates, pictures);
  if (!best.tiff.empty()) return listed_pages(source / best.tiff, choice, pictures);
  require_no_page(best.description);
  return listed(source, best.names, order_names(best.names), pictures);
}

}  // namespace fvd
