#include "daemon/export/stored_zip.hpp"

#include <limits>
#include <memory>

#include <glib.h>
#include <zlib.h>

#include "core/base/error.hpp"

namespace fvd {

namespace {

constexpr std::uint16_t kVersion = 20;
constexpr std::uint16_t kFirstDate = 1U << 5U | 1U;  // 1980-01-01

struct ChecksumFreer {
  void operator()(GChecksum* checksum) const noexcept { g_checksum_free(checksum); }
};

/// Little-endian; bytes beyond the eighth are 0.
void add_number(std::string& to, std::uint64_t value, int bytes) {
  for (int i = 0; i < bytes; ++i) {
    to.push_back(static_cast<char>(value & 0xFFU));
    value >>= 8U;
  }
}

/// What the local head and the directory tell alike.
std::string common_head(const std::string& name, const ContentDigest& digest) {
  std::string head;
  add_number(head, kVersion, 2);
  add_number(head, 0, 2);  // flags
  add_number(head, 0, 2);  // stored
  add_number(head, 0, 2);  // time
  add_number(head, kFirstDate, 2);
  add_number(head, digest.crc32, 4);
  add_number(head, digest.size_bytes, 4);
  add_number(head, digest.size_bytes, 4);
  add_number(head, name.size(), 2);
  add_number(head, 0, 2);  // extra field
  return head;
}

}  // namespace

ContentDigest digest_of(const ByteProducer& content) {
  ContentDigest digest;
  const std::unique_ptr<GChecksum, ChecksumFreer> md5(g_checksum_new(G_CHECKSUM_MD5));
  uLong crc = ::crc32(0, nullptr, 0);
  content([&](std::string_view bytes) {
    const auto* data = reinterpret_cast<const unsigned char*>(bytes.data());
    crc = ::crc32_z(crc, data, bytes.size());
    g_checksum_update(md5.get(), data, static_cast<gssize>(bytes.size()));
    digest.size_bytes += bytes.size();
  });
  digest.crc32 = static_cast<std::uint32_t>(crc);
  digest.md5 = g_checksum_get_string(md5.get());
  return digest;
}

void StoredZip::put(const std::string& bytes) {
  sink_(bytes);
  offset_ += bytes.size();
}

void StoredZip::add(const std::string& name, const ContentDigest& digest, const ByteProducer& content) {
  constexpr std::uint64_t kMost = std::numeric_limits<std::uint32_t>::max();
  constexpr std::uint64_t kHeads = 4096;
  if (offset_ + digest.size_bytes + kHeads > kMost) {
    throw Error(ErrorCode::kBadInput, "'" + name + "' makes the archive larger than 4 GiB");
  }
  const std::string head = common_head(name, digest);
  directory_ += std::string("PK\1\2", 4);
  add_number(directory_, kVersion, 2);
  directory_ += head;
  add_number(directory_, 0, 2 + 2 + 2 + 4);  // comment, disk, attributes
  add_number(directory_, offset_, 4);
  directory_ += name;
  ++entries_;
  put(std::string("PK\3\4", 4) + head + name);
  content(sink_);
  offset_ += digest.size_bytes;
}

void StoredZip::finish() {
  const std::uint64_t begin = offset_;
  put(directory_);
  std::string end("PK\5\6", 4);
  add_number(end, 0, 4);  // disks
  add_number(end, entries_, 2);
  add_number(end, entries_, 2);
  add_number(end, directory_.size(), 4);
  add_number(end, begin, 4);
  add_number(end, 0, 2);  // comment
  put(end);
}

}  // namespace fvd
