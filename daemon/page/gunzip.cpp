#include "daemon/page/gunzip.hpp"

#include <array>

#include <zlib.h>

#include "core/base/error.hpp"

namespace fvd {

namespace {

constexpr int kGzipWindow = 16 + MAX_WBITS;

/// Gives zlib's state back.
class Inflater {
 public:
  Inflater() {
    if (::inflateInit2(&stream_, kGzipWindow) != Z_OK) throw Error(ErrorCode::kInternal, "zlib has no memory");
  }
  ~Inflater() { ::inflateEnd(&stream_); }
  Inflater(const Inflater&) = delete;
  Inflater& operator=(const Inflater&) = delete;
  [[nodiscard]] z_stream& stream() { return stream_; }

 private:
  z_stream stream_{};
};

}  // namespace

std::string unpacked(std::string_view gzip) {
  Inflater inflater;
  z_stream& stream = inflater.stream();
  stream.next_in = reinterpret_cast<const Bytef*>(gzip.data());
  stream.avail_in = static_cast<uInt>(gzip.size());
  std::string plain;
  std::array<char, 16384> piece{};
  int outcome = Z_OK;
  while (outcome == Z_OK) {
    stream.next_out = reinterpret_cast<Bytef*>(piece.data());
    stream.avail_out = static_cast<uInt>(piece.size());
    outcome = ::inflate(&stream, Z_NO_FLUSH);
    plain.append(piece.data(), piece.size() - stream.avail_out);
  }
  if (outcome != Z_STREAM_END) {
    throw Error(ErrorCode::kInternal, "a file of the operator page cannot be unpacked; build fvd again");
  }
  return plain;
}

}  // namespace fvd
