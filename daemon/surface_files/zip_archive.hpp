#pragma once

/// A ZIP file from a stranger: read entry by entry, refused where it could do harm.

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "daemon/surface_files/file_bytes.hpp"

struct zip;

namespace fvd {

/// Refuses entries whose names are absolute or lead out of a folder, names that stand there twice, entries above 4 GiB,
/// compressed by more than 200 or encrypted, and more than 1000 entries. All throw Error kSurfaceFile.
class ZipArchive {
 public:
  explicit ZipArchive(const FileBytes& file);
  ~ZipArchive();
  ZipArchive(const ZipArchive&) = delete;
  ZipArchive& operator=(const ZipArchive&) = delete;

  [[nodiscard]] bool has(const std::string& name) const;
  /// The size of an entry that must be there.
  [[nodiscard]] std::uint64_t size(const std::string& name) const;
  /// The whole of an entry that must be there, at most `most` bytes.
  [[nodiscard]] std::string text(const std::string& name, std::size_t most) const;
  /// Gives the bytes of an entry in order, piece by piece, each but the last of a multiple of 8 bytes; checks its
  /// CRC-32 and that it is as long as it says. Returns the MD5 (RFC 1321) of all as 32 lower-case digits.
  std::string read(const std::string& name, const std::function<void(std::string_view)>& use) const;

 private:
  void check_entries() const;

  const FileBytes& file_;
  ::zip* archive_ = nullptr;
};

}  // namespace fvd
