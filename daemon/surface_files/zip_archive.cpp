#include "daemon/surface_files/zip_archive.hpp"

#include <algorithm>
#include <cstring>
#include <set>
#include <vector>

#include <glib.h>
#include <zip.h>

namespace fvd {

namespace {

constexpr std::uint64_t kMaxEntry_bytes = std::uint64_t{1} << 32U;
constexpr std::uint64_t kMaxRatio = 200;
constexpr std::uint64_t kMaxEntries = 1000;
constexpr std::size_t kChunk_bytes = std::size_t{1} << 18U;
constexpr std::size_t kTail_bytes = 65'535 + 22 + 20;  // comment, end record, locator

struct ZipFileCloser {
  void operator()(zip_file_t* file) const noexcept { zip_fclose(file); }
};
struct ChecksumFreer {
  void operator()(GChecksum* checksum) const noexcept { g_checksum_free(checksum); }
};

std::uint64_t little_endian(std::string_view bytes) {
  std::uint64_t value = 0;
  for (auto byte = bytes.rbegin(); byte != bytes.rend(); ++byte)
    value = value << 8U | static_cast<unsigned char>(*byte);
  return value;
}

/// libzip takes memory for as many entries as the end of the file names: looked at before it does.
void check_number_of_entries(const FileBytes& file) {
  const std::uint64_t begin = file.size() - std::min<std::uint64_t>(file.size(), kTail_bytes);
  const std::string tail = file.text(begin, kTail_bytes);
  const auto check = [&file](std::uint64_t place, std::uint64_t entries) {
    if (entries > kMaxEntries)
      refuse(file.path(), byte_place(place), "the archive has " + std::to_string(entries) + " entries");
  };
  constexpr std::string_view kEnd("PK\5\6", 4);
  constexpr std::string_view kLocator64("PK\6\7", 4);
  constexpr std::string_view kEnd64("PK\6\6", 4);
  constexpr std::size_t kEnd64_bytes = 56;
  for (std::size_t at = tail.find(kEnd); at != std::string::npos; at = tail.find(kEnd, at + 1)) {
    if (tail.size() - at < 22) break;
    const std::string_view record = std::string_view(tail).substr(at, 22);
    const bool plausible = little_endian(record.substr(12, 4)) + little_endian(record.substr(16, 4)) <= begin + at;
    if (plausible) check(begin + at, little_endian(record.substr(10, 2)));
  }
  for (std::size_t at = tail.find(kLocator64); at != std::string::npos; at = tail.find(kLocator64, at + 1)) {
    if (tail.size() - at < 20) break;
    const std::uint64_t place = little_endian(std::string_view(tail).substr(at + 8, 8));
    const std::string record = file.text(place, kEnd64_bytes);
    if (record.size() == kEnd64_bytes && record.starts_with(kEnd64))
      check(place, little_endian(std::string_view(record).substr(32, 8)));
  }
}

bool is_safe(std::string_view name) {
  if (name.empty() || name.front() == '/' || name.find('\\') != std::string_view::npos) return false;
  if (name.size() > 1 && name[1] == ':') return false;
  for (;;) {
    const auto slash = name.find('/');
    if (name.substr(0, slash) == "..") return false;
    if (slash == std::string_view::npos) return true;
    name.remove_prefix(slash + 1);
  }
}

/// The name for a message: short, without control characters.
std::string shown(std::string_view name) {
  std::string text = "'" + std::string(name.substr(0, 80)) + "'";
  std::replace_if(
      text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < ' '; }, '?');
  return text;
}

void check_entry(const FileBytes& file, const zip_stat_t& entry) {
  const std::string place = "entry " + shown(entry.name);
  constexpr zip_uint64_t kNeeded = ZIP_STAT_SIZE | ZIP_STAT_COMP_SIZE;
  if ((entry.valid & kNeeded) != kNeeded) refuse(file.path(), place, "its size is not told");
  if (!is_safe(entry.name)) refuse(file.path(), place, "its name leads out of the archive");
  if (entry.size > kMaxEntry_bytes) refuse(file.path(), place, std::to_string(entry.size) + " bytes are above 4 GiB");
  if (entry.size / kMaxRatio > entry.comp_size || (entry.size > 0 && entry.comp_size == 0)) {
    refuse(file.path(), place, "it is compressed by more than 200");
  }
  if (entry.comp_size > file.size()) refuse(file.path(), place, "it is longer than the file");
  if ((entry.valid & ZIP_STAT_ENCRYPTION_METHOD) != 0 && entry.encryption_method != ZIP_EM_NONE) {
    refuse(file.path(), place, "it is encrypted");
  }
}

}  // namespace

ZipArchive::ZipArchive(const FileBytes& file) : file_(file) {
  check_number_of_entries(file);
  int error = 0;
  archive_ = zip_open(file.path().c_str(), ZIP_RDONLY, &error);
  if (archive_ == nullptr) {
    zip_error_t text;
    zip_error_init_with_code(&text, error);
    const std::string reason = zip_error_strerror(&text);
    zip_error_fini(&text);
    refuse(file.path(), "archive", "it cannot be opened: " + reason);
  }
  try {
    check_entries();
  } catch (...) {
    zip_discard(archive_);
    throw;
  }
}

ZipArchive::~ZipArchive() { zip_discard(archive_); }

void ZipArchive::check_entries() const {
  std::set<std::string> names;
  const zip_int64_t count = zip_get_num_entries(archive_, 0);
  for (zip_int64_t i = 0; i < count; ++i) {
    zip_stat_t entry;
    if (zip_stat_index(archive_, static_cast<zip_uint64_t>(i), 0, &entry) != 0 || (entry.valid & ZIP_STAT_NAME) == 0) {
      refuse(file_.path(), "entry " + std::to_string(i), "it has no name");
    }
    check_entry(file_, entry);
    if (!names.insert(entry.name).second) refuse(file_.path(), "entry " + shown(entry.name), "it stands there twice");
  }
}

bool ZipArchive::has(const std::string& name) const { return zip_name_locate(archive_, name.c_str(), 0) >= 0; }

std::uint64_t ZipArchive::size(const std::string& name) const {
  zip_stat_t entry;
  if (zip_stat(archive_, name.c_str(), 0, &entry) != 0) refuse(file_.path(), "entry " + shown(name), "it is missing");
  return entry.size;
}

std::string ZipArchive::text(const std::string& name, std::size_t most) const {
  if (const std::uint64_t bytes = size(name); bytes > most) {
    refuse(file_.path(), "entry " + shown(name), std::to_string(bytes) + " bytes are above " + std::to_string(most));
  }
  std::string all;
  read(name, [&all](std::string_view piece) { all += piece; });
  return all;
}

std::string ZipArchive::read(const std::string& name, const std::function<void(std::string_view)>& use) const {
  const std::uint64_t bytes = size(name);
  const std::string place = "entry " + shown(name);
  const std::unique_ptr<zip_file_t, ZipFileCloser> entry(zip_fopen(archive_, name.c_str(), 0));
  if (!entry) refuse(file_.path(), place, std::string("it cannot be opened: ") + zip_strerror(archive_));
  const std::unique_ptr<GChecksum, ChecksumFreer> md5(g_checksum_new(G_CHECKSUM_MD5));
  std::vector<char> chunk(kChunk_bytes);
  std::uint64_t done = 0;
  while (done < bytes) {
    // libzip may give fewer bytes than asked for: the pieces are to hold whole numbers.
    const auto wanted = static_cast<std::size_t>(std::min<std::uint64_t>(kChunk_bytes, bytes - done));
    std::size_t got = 0;
    while (got < wanted) {
      const zip_int64_t count = zip_fread(entry.get(), chunk.data() + got, wanted - got);
      if (count < 0) refuse(file_.path(), place, std::string("it is damaged: ") + zip_file_strerror(entry.get()));
      if (count == 0) refuse(file_.path(), place + ", byte " + std::to_string(done + got), "the entry ends");
      got += static_cast<std::size_t>(count);
    }
    g_checksum_update(md5.get(), reinterpret_cast<const guchar*>(chunk.data()), static_cast<gssize>(got));
    use({chunk.data(), got});
    done += got;
  }
  char more = 0;
  const zip_int64_t rest = zip_fread(entry.get(), &more, 1);  // also checks the CRC-32
  if (rest < 0) refuse(file_.path(), place, std::string("it is damaged: ") + zip_file_strerror(entry.get()));
  if (rest > 0) refuse(file_.path(), place, "it is longer than it says");
  return g_checksum_get_string(md5.get());
}

}  // namespace fvd
