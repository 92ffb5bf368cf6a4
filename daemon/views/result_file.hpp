#pragma once

/// A file of a stored result, by the name that its record tells.

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>

#include "daemon/base/unique_fd.hpp"
#include "daemon/store/job_status.hpp"

namespace fvd {

struct OpenedFile {
  UniqueFd file;  ///< regular; at its beginning
  std::uint64_t size_bytes = 0;
  std::string tag;  ///< another one once the file is another; letters, digits and "-"
};

/// Why there is no such file.
struct NoFile {
  std::string error;    ///< "unknown_file", "pending", "not_made", "missing"
  std::string message;  ///< for people; holds nothing of the name that was asked for
};

/// Names are result.json and those that it lists, letter for letter; nothing below a folder. Links are not followed.
/// context: thread-safe; reads files.
[[nodiscard]] std::variant<OpenedFile, NoFile> open_result_file(const StoredJob& job, std::string_view name);

}  // namespace fvd
