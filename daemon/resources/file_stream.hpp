#pragma once

/// A file, or a piece of it, as the body of an answer.

#include <cstdint>
#include <string>
#include <utility>

#include "daemon/base/unique_fd.hpp"
#include "daemon/transport/http_resource.hpp"

namespace fvd {

/// The file stays open until all of it is sent: that it is replaced or removed meanwhile changes nothing.
class FileStream final : public BodySource {
 public:
  /// bytes from offset on, which the file has.
  FileStream(UniqueFd file, std::uint64_t offset, std::uint64_t bytes)
      : file_(std::move(file)), offset_(offset), left_(bytes) {}

  /// Throws Error kInternal where it cannot be read, or has become shorter.
  std::string next() override;

 private:
  UniqueFd file_;
  std::uint64_t offset_;
  std::uint64_t left_;
};

}  // namespace fvd
