#include "drivers/replay/tiff_pages.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <system_error>
#include <utility>

#include "core/base/error.hpp"
#include "drivers/replay/page_description.hpp"
#include "drivers/replay/tiff_handle.hpp"

namespace fvd {

namespace {

[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& problem) {
  throw Error(ErrorCode::kBadInput, file.string() + " " + problem);
}

/// Why the present directory is no slice; empty if it may be one.
std::string why_not_a_slice(TIFF* tiff) {
  std::uint32_t kind = 0;
  TIFFGetField(tiff, TIFFTAG_SUBFILETYPE, &kind);
  std::uint16_t old_kind = 0;
  TIFFGetField(tiff, TIFFTAG_OSUBFILETYPE, &old_kind);
  if ((kind & FILETYPE_REDUCEDIMAGE) != 0 || old_kind == OFILETYPE_REDUCEDIMAGE) return "reduced image";
  if ((kind & FILETYPE_MASK) != 0 || page_of(tiff).photometric == PHOTOMETRIC_MASK) return "mask";
  return {};
}

std::string image_description(TIFF* tiff) {
  const char* text = nullptr;
  return TIFFGetField(tiff, TIFFTAG_IMAGEDESCRIPTION, &text) == 1 && text != nullptr ? text : "";
}

/// See TiffContent::contiguous; of the only directory.
int contiguous_images(TIFF* tiff, const std::string& description, std::uintmax_t file_bytes) {
  const auto told = read_imagej_description(description);
  const TiffPage page = page_of(tiff);
  const std::uint64_t* offsets = nullptr;
  if (!told || page.compression != COMPRESSION_NONE || page.bits % 8 != 0 || page.planes != PLANARCONFIG_CONTIG ||
      TIFFGetField(tiff, TIFFTAG_STRIPOFFSETS, &offsets) != 1) {
    return 0;
  }
  const auto images = static_cast<std::uint64_t>(told->channels) * static_cast<std::uint64_t>(told->slices) *
                      static_cast<std::uint64_t>(told->times);
  const std::uint64_t image_bytes = std::uint64_t{page.width} * page.height * page.samples * (page.bits / 8U);
  if (image_bytes == 0 || offsets[0] > file_bytes) return 0;
  return (file_bytes - offsets[0]) / image_bytes >= images ? static_cast<int>(images) : -1;
}

std::string listed(int count, const std::vector<std::string>& names) {
  std::string text = "1 to " + std::to_string(count);
  for (std::size_t i = 0; i < names.size(); ++i) {
    text += (i == 0 ? " (" : ", ") + std::to_string(i + 1) + " " + (names[i].empty() ? "unnamed" : names[i]);
  }
  return names.empty() ? text : text + ")";
}

/// The chosen one, 0-based.
int choose(const std::filesystem::path& file, const PageDescription& told, const char* what, int count,
           const std::optional<int>& chosen, const std::vector<std::string>& names) {
  std::string there = told.written_by + "'s description tells of " + std::to_string(told.slices) + " slices";
  if (told.channels > 1) there += ", " + std::to_string(told.channels) + " channels";
  if (told.times > 1) there += ", " + std::to_string(told.times) + " times";
  if (!chosen && count == 1) return 0;
  if (!chosen) {
    refuse(file, "has several " + std::string(what) + "s: " + there + "; say with --" + what + " of fvdctl" +
                     " which one is the stack, " + listed(count, names));
  }
  if (*chosen < 1 || *chosen > count) {
    refuse(file, "has no " + std::string(what) + " " + std::to_string(*chosen) + ": " + there + "; there are " +
                     listed(count, names));
  }
  return *chosen - 1;
}

SliceLocation location(const std::filesystem::path& file, const TiffContent& content, int image) {
  if (content.contiguous > 1) return {file, image, true};
  return {file, content.images.at(static_cast<std::size_t>(image)), false};
}

/// All pages are slices.
SliceList every_page(const std::filesystem::path& file, const TiffContent& content) {
  SliceList list;
  for (int image = 0; image < content.size(); ++image) list.slices.push_back(location(file, content, image));
  return list;
}

void spread_z(const PageDescription& told, const std::vector<PagePlace>& places, SliceList& list) {
  const bool recorded =
      std::all_of(places.begin(), places.end(), [](const PagePlace& p) { return p.z_um.has_value(); });
  std::set<double> different;
  for (const PagePlace& place : places) different.insert(place.z_um.value_or(0.0));
  if (recorded && different.size() == places.size()) {
    for (const PagePlace& place : places) list.z_um.push_back(*place.z_um);
  } else if (told.spacing_um) {
    for (const PagePlace& place : places) list.z_um.push_back(place.z * *told.spacing_um);
  }
  if (!list.z_um.empty()) list.z_from = told.written_by + "'s description";
}

/// The pages of one channel and time in the order of z.
std::vector<PagePlace> chosen_places(const std::filesystem::path& file, PageDescription told,
                                     const StackChoice& choice) {
  const int channel = choose(file, told, "channel", told.channels, choice.channel, told.channel_names);
  const int time = choose(file, told, "time", told.times, choice.time, {});
  std::erase_if(told.pages, [&](const PagePlace& place) { return place.channel != channel || place.time != time; });
  std::stable_sort(told.pages.begin(), told.pages.end(),
                   [](const PagePlace& a, const PagePlace& b) { return a.z < b.z; });
  return told.pages;
}

/// The slice of a described page; nothing if the file has no such image.
std::optional<SliceLocation> described(const std::filesystem::path& file, const TiffContent& content,
                                       const PageDescription& told, int page) {
  if (!told.by_directory) {
    if (page >= content.size()) return std::nullopt;
    return location(file, content, page);
  }
  const bool there = std::binary_search(content.images.begin(), content.images.end(), page);
  return there ? std::optional(SliceLocation{file, page, false}) : std::nullopt;
}

/// Whether every page is there that the description tells of, and no image that it knows nothing of.
bool fits(const TiffContent& content, const PageDescription& told) {
  const auto there = [&](const PagePlace& place) { return described({}, content, told, place.page).has_value(); };
  return std::all_of(told.pages.begin(), told.pages.end(), there) &&
         (told.by_directory || told.pages.size() == static_cast<std::size_t>(content.size()));
}

SliceList as_described(const std::filesystem::path& file, const TiffContent& content, const PageDescription& told,
                       const StackChoice& choice) {
  SliceList list;
  const std::vector<PagePlace> places = chosen_places(file, told, choice);
  for (const PagePlace& place : places) {
    const auto slice = described(file, content, told, place.page);
    if (!slice) {
      refuse(file, "has " + std::to_string(content.size()) + " images, but " + told.written_by +
                       "'s description tells of a page " + std::to_string(place.page + 1) +
                       ": the file is incomplete, or was changed without its description; save it again");
    }
    list.slices.push_back(*slice);
  }
  spread_z(told, places, list);
  return list;
}

void count_pages(const TiffContent& content, SliceList& list) {
  const auto page_text = [](int page) { return "page " + std::to_string(page + 1); };
  for (const LeftOutPage& page : content.left_out) {
    list.ignored_pages.push_back(page_text(page.page) + " [" + page.reason + "]");
  }
  for (int image = 0; image < content.size(); ++image) {
    const int page = content.contiguous > 1 ? image : content.images[static_cast<std::size_t>(image)];
    const bool used = std::any_of(list.slices.begin(), list.slices.end(),
                                  [page](const SliceLocation& slice) { return slice.page == page; });
    if (!used) list.ignored_pages.push_back(page_text(page));
  }
  list.used_pages = static_cast<int>(list.slices.size());
}

/// One slice at many times is what ImageJ makes of a stack whose third dimension nobody named.
void take_times_as_slices(PageDescription& told, std::string& note) {
  if (told.slices != 1 || told.channels != 1 || told.times < 2) return;
  for (PagePlace& place : told.pages) std::swap(place.z, place.time);
  std::swap(told.slices, told.times);
  told.spacing_um.reset();
  note = told.written_by + "'s description tells of " + std::to_string(told.slices) +
         " times of one slice; they were taken for slices";
}

}  // namespace

TiffContent tiff_content(const std::filesystem::path& file) {
  TiffContent content;
  std::string error;
  const Tiff tiff = open_tiff(file, error);
  if (!tiff) return content;
  int page = 0;
  do {
    if (std::string reason = why_not_a_slice(tiff.get()); !reason.empty()) {
      content.left_out.push_back({page, std::move(reason)});
    } else {
      if (content.images.empty()) {
        content.description = image_description(tiff.get());
        content.samples_per_page = page_of(tiff.get()).channels();
      }
      content.images.push_back(page);
    }
    ++page;
  } while (TIFFReadDirectory(tiff.get()) == 1);
  if (page == 1 && !content.images.empty() && content.description.starts_with("ImageJ=")) {
    TIFFSetDirectory(tiff.get(), 0);
    std::error_code no_size;
    const auto bytes = std::filesystem::file_size(file, no_size);
    content.contiguous = no_size ? 0 : contiguous_images(tiff.get(), content.description, bytes);
  }
  return content;
}

SliceList tiff_slices(const std::filesystem::path& file, const StackChoice& choice) {
  const TiffContent content = tiff_content(file);
  if (content.contiguous < 0) {
    refuse(file,
           "is an ImageJ stack of several images behind one directory, but ends before the last one: it is "
           "incomplete; copy or save it again");
  }
  auto told = read_imagej_description(content.description);
  if (!told) {
    told = read_ome_description(content.description, file.filename().string(), content.samples_per_page);
  }
  SliceList list;
  std::string note;
  if (told && !told->problem.empty()) {
    refuse(file, "has a description by " + told->written_by + " that cannot be used: " + told->problem);
  }
  if (told) take_times_as_slices(*told, note);
  const bool plain = !told || (told->channels == 1 && told->times == 1 && !fits(content, *told));
  if (plain && (choice.channel.value_or(1) != 1 || choice.time.value_or(1) != 1)) {
    refuse(file, "does not tell of channels or times: all its pages are one stack");
  }
  if (plain) {
    list = every_page(file, content);
    if (told) {
      note = told->written_by + "'s description tells of " + std::to_string(told->pages.size()) + " images, " +
             file.filename().string() + " has " + std::to_string(content.size()) + ": all were taken, z was not";
    }
  } else {
    list = as_described(file, content, *told, choice);
  }
  if (told && told->pixel_pitch_x_um && told->pixel_pitch_y_um) {
    list.pixel_pitch_x_um = told->pixel_pitch_x_um;
    list.pixel_pitch_y_um = told->pixel_pitch_y_um;
  }
  list.doubt = note;
  count_pages(content, list);
  list.description = file.filename().string() + " (" + std::to_string(list.slices.size()) + " pages)";
  if (list.slices.size() < 2) {
    refuse(file, "has only one slice" + (told ? " by its " + told->written_by + " description" : std::string()) +
                     ": a height map needs several");
  }
  return list;
}

}  // namespace fvd
