#include "drivers/replay/slice_files.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <compare>
#include <map>
#include <system_error>
#include <tuple>
#include <utility>

#include "core/base/error.hpp"
#include "drivers/replay/image_file.hpp"

namespace fvd {

namespace fs = std::filesystem;

namespace {

std::string lower(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

bool is_tiff(const fs::path& file) {
  const std::string extension = lower(file.extension().string());
  return extension == ".tif" || extension == ".tiff";
}

bool is_image(const fs::path& file) {
  constexpr std::array kExtensions{".png", ".jpg", ".jpeg", ".pgm"};
  const std::string extension = lower(file.extension().string());
  return is_tiff(file) ||
         std::any_of(kExtensions.begin(), kExtensions.end(), [&](const char* known) { return extension == known; });
}

/// "a12b007.png" -> before "a12b", number "7", after ".png".
struct NumberedName {
  std::string before;
  std::string number;  // without leading zeros, so that length orders before digits
  std::string after;
};

std::optional<NumberedName> split_name(const fs::path& file) {
  const std::string stem = file.stem().string();
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  const auto last = std::find_if(stem.rbegin(), stem.rend(), is_digit);
  if (last == stem.rend()) return std::nullopt;
  const auto first = std::find_if_not(last, stem.rend(), is_digit);
  std::string number(first.base(), last.base());
  number.erase(0, std::min(number.find_first_not_of('0'), number.size() - 1));
  return NumberedName{std::string(stem.begin(), first.base()), std::move(number),
                      std::string(last.base(), stem.end()) + file.extension().string()};
}

struct NumberedFile {
  std::string number;
  fs::path file;
};

bool before(const NumberedFile& a, const NumberedFile& b) {
  return std::tuple(a.number.size(), a.number) < std::tuple(b.number.size(), b.number);
}

/// Slices that belong together.
struct Candidate {
  std::string description;
  std::vector<NumberedFile> files;  // a family, in natural order
  fs::path tiff;                    // or one multi-page TIFF
  std::size_t slices = 0;
};

[[noreturn]] void refuse(const std::string& message) { throw Error(ErrorCode::kBadInput, message); }

Candidate family(const std::string& pattern, std::vector<NumberedFile> files) {
  std::sort(files.begin(), files.end(), before);
  Candidate candidate{pattern + " (" + std::to_string(files.size()) + " files)", {}, {}, files.size()};
  candidate.files = std::move(files);
  return candidate;
}

Candidate pages(const fs::path& file, int count) {
  return {
      file.filename().string() + " (" + std::to_string(count) + " pages)", {}, file, static_cast<std::size_t>(count)};
}

std::vector<Candidate> candidates_in(const fs::path& folder) {
  std::map<std::pair<std::string, std::string>, std::vector<NumberedFile>> families;
  std::vector<Candidate> candidates;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    const fs::path& file = entry.path();
    if (!entry.is_regular_file() || file.filename().string().starts_with('.') || !is_image(file)) continue;
    if (const auto name = split_name(file)) families[{name->before, name->after}].push_back({name->number, file});
    if (is_tiff(file)) {
      if (const int count = count_tiff_pages(file); count > 1) candidates.push_back(pages(file, count));
    }
  }
  if (error) refuse("cannot read folder " + folder.string() + ": " + error.message());
  for (auto& [key, files] : families) {
    candidates.push_back(family(key.first + "*" + key.second, std::move(files)));
  }
  std::sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
    return std::tuple(b.slices, a.description) < std::tuple(a.slices, b.description);
  });
  return candidates;
}

void check_duplicates(const Candidate& candidate) {
  const auto twice = std::adjacent_find(candidate.files.begin(), candidate.files.end(),
                                        [](const auto& a, const auto& b) { return a.number == b.number; });
  if (twice == candidate.files.end()) return;
  refuse(twice->file.string() + " and " + (twice + 1)->file.filename().string() +
         " have the same number: their order is not known");
}

/// Numbers of more digits are time stamps or hashes, not counts.
constexpr std::size_t kMaxCountDigits = 9;

std::string find_gap(const std::vector<NumberedFile>& files) {
  const auto value = [](const NumberedFile& file) { return std::stol(file.number); };
  if (files.size() < 3) return {};
  if (files.back().number.size() > kMaxCountDigits) {
    return "the numbers in the names, such as " + files.back().file.filename().string() + ", are too long to be counts";
  }
  long smallest = value(files[1]) - value(files[0]);
  for (std::size_t i = 2; i < files.size(); ++i) smallest = std::min(smallest, value(files[i]) - value(files[i - 1]));
  for (std::size_t i = 1; i < files.size(); ++i) {
    if (value(files[i]) - value(files[i - 1]) == smallest) continue;
    return files[i - 1].file.filename().string() + " is followed by " + files[i].file.filename().string();
  }
  return {};
}

SliceList list(const Candidate& candidate) {
  SliceList result;
  result.description = candidate.description;
  for (const auto& [number, file] : candidate.files) result.slices.push_back({file, std::nullopt});
  if (!candidate.files.empty()) {
    check_duplicates(candidate);
    result.gap = find_gap(candidate.files);
    return result;
  }
  for (std::size_t page = 0; page < candidate.slices; ++page) {
    result.slices.push_back({candidate.tiff, static_cast<int>(page)});
  }
  return result;
}

constexpr const char* kExpected =
    "; expected image files (PNG, TIFF, JPEG, PGM) whose names differ in a number only, such as slice_000.png, "
    "slice_001.png, or one multi-page TIFF";

}  // namespace

std::string SliceLocation::name() const {
  return page ? file.filename().string() + " page " + std::to_string(*page + 1) : file.filename().string();
}

SliceList find_slices(const fs::path& source) {
  std::error_code error;
  const auto status = fs::status(source, error);
  if (!fs::exists(status)) refuse("there is no folder " + source.string());
  if (fs::is_regular_file(status)) {
    const int count = is_tiff(source) ? count_tiff_pages(source) : 0;
    if (count < 2) refuse(source.string() + " is a file but not a TIFF with several pages" + kExpected);
    return list(pages(source, count));
  }
  if (!fs::is_directory(status)) refuse(source.string() + " is neither a folder nor a file");
  const auto candidates = candidates_in(source);
  if (candidates.empty()) refuse("no slices in " + source.string() + kExpected);
  const Candidate& best = candidates.front();
  if (best.slices < 2) {
    refuse(source.string() + " has only one slice, " + best.files.front().file.filename().string() +
           ": a height map needs several" + kExpected);
  }
  if (candidates.size() > 1 && 2 * candidates[1].slices > best.slices) {
    refuse("in " + source.string() + " both " + best.description + " and " + candidates[1].description +
           " could be the slices: move the others away");
  }
  return list(best);
}

}  // namespace fvd
