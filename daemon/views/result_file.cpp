#include "daemon/views/result_file.hpp"

#include <cerrno>
#include <cstring>
#include <optional>
#include <utility>

#include <fcntl.h>
#include <nlohmann/json.hpp>
#include <sys/stat.h>
#include <unistd.h>

#include "daemon/views/file_tag.hpp"

namespace fvd {

namespace {

using nlohmann::json;

constexpr std::string_view kRecord = "result.json";

std::string text_of(const json& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_string() ? found->get<std::string>() : std::string();
}

/// What the record says of the file; nothing where it does not name it.
std::optional<json> listed(const std::string& record, std::string_view name) {
  const json document = json::parse(record, nullptr, false);
  if (!document.is_object()) return std::nullopt;
  const auto files = document.find("files");
  if (files == document.end() || !files->is_array()) return std::nullopt;
  for (const json& file : *files) {
    if (file.is_object() && text_of(file, "name") == name) return file;
  }
  return std::nullopt;
}

/// A name, and neither a path nor a folder.
bool is_plain_name(std::string_view name) {
  return !name.empty() && name != "." && name != ".." && name.find('/') == std::string_view::npos &&
         name.find('\0') == std::string_view::npos;
}

std::variant<OpenedFile, NoFile> opened(const std::string& folder, const std::string& name) {
  const auto missing = [](const std::string& why) {
    return NoFile{"missing", "the result lists the file, but it cannot be opened: " + why};
  };
  const UniqueFd directory(::open(folder.c_str(), O_PATH | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC));
  if (!directory.valid()) return missing(std::strerror(errno));
  OpenedFile found;
  found.file = UniqueFd(::openat(directory.get(), name.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC));
  if (!found.file.valid()) return missing(errno == ELOOP ? "it is a link" : std::strerror(errno));
  struct stat status {};
  if (::fstat(found.file.get(), &status) != 0) return missing(std::strerror(errno));
  if (!S_ISREG(status.st_mode)) return missing("it is no file");
  found.size_bytes = static_cast<std::uint64_t>(status.st_size);
  found.tag = file_tag(status);
  return std::variant<OpenedFile, NoFile>(std::move(found));
}

}  // namespace

std::variant<OpenedFile, NoFile> open_result_file(const StoredJob& job, std::string_view name) {
  const NoFile unknown{"unknown_file", "the result has no file of that name; its result.json lists those that it has"};
  if (job.result_dir.empty() || !is_plain_name(name)) return unknown;
  if (name != kRecord) {
    const auto file = listed(job.result_json, name);
    if (!file) return unknown;
    const std::string state = text_of(*file, "state");
    if (state == "pending") return NoFile{"pending", "the file is still being made; ask again in a few seconds"};
    if (!state.empty() && state != "written") return NoFile{"not_made", "it was not made: " + text_of(*file, "reason")};
  }
  return opened(job.result_dir, std::string(name));
}

}  // namespace fvd
