#pragma once

/// gzip of a text, as the page's build makes it.

#include <stdexcept>
#include <string>

#include <zlib.h>

namespace fvd::test {

inline std::string packed(const std::string& text) {
  z_stream stream{};
  if (::deflateInit2(&stream, Z_BEST_COMPRESSION, Z_DEFLATED, 16 + MAX_WBITS, 8, Z_DEFAULT_STRATEGY) != Z_OK) {
    throw std::runtime_error("zlib");
  }
  std::string bytes(::deflateBound(&stream, text.size()) + 32, '\0');
  std::string input = text;
  stream.next_in = reinterpret_cast<Bytef*>(input.data());
  stream.avail_in = static_cast<uInt>(input.size());
  stream.next_out = reinterpret_cast<Bytef*>(bytes.data());
  stream.avail_out = static_cast<uInt>(bytes.size());
  const int outcome = ::deflate(&stream, Z_FINISH);
  bytes.resize(bytes.size() - stream.avail_out);
  ::deflateEnd(&stream);
  if (outcome != Z_STREAM_END) throw std::runtime_error("zlib");
  return bytes;
}

}  // namespace fvd::test
