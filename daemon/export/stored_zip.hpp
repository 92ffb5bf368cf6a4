#pragma once

/// A ZIP archive (PKWARE APPNOTE 6.3) of stored entries: the same entries give the same bytes.

#include <cstdint>
#include <string>
#include <vector>

#include "daemon/export/durable_file.hpp"

namespace fvd {

/// What an entry's head tells of its content.
struct ContentDigest {
  std::uint64_t size_bytes = 0;
  std::uint32_t crc32 = 0;
  std::string md5;  ///< RFC 1321, 32 lower-case digits
};

/// Runs through the content once.
[[nodiscard]] ContentDigest digest_of(const ByteProducer& content);

/// Entries are dated 1980-01-01, the least date of the format.
class StoredZip {
 public:
  explicit StoredZip(const ByteSink& sink) : sink_(sink) {}
  /// content gives the bytes of which the digest was made. Throws Error kBadInput above 4 GiB.
  void add(const std::string& name, const ContentDigest& digest, const ByteProducer& content);
  /// The directory at the end; call once.
  void finish();

 private:
  void put(const std::string& bytes);

  const ByteSink& sink_;
  std::string directory_;
  std::uint16_t entries_ = 0;
  std::uint64_t offset_ = 0;
};

}  // namespace fvd
