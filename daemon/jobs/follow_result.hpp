#pragma once

/// Making the files of a result that its verdict did not wait for.

#include <filesystem>
#include <stop_token>
#include <string>
#include <vector>

#include "daemon/export/result_writer.hpp"

namespace fvd {

/// What follow_result() works on.
struct ResultToFollow {
  std::string job_id;
  std::filesystem::path folder;       ///< of the result
  std::string text;                   ///< of its result.json
  std::vector<WrittenBytes> written;  ///< files without a digest; those that are not here are read for it
};

struct FollowedResult {
  std::string text;      ///< of result.json as it is now
  bool pending = false;  ///< files are still to be made: of a stop, or of a disk that is full
  std::string reason;    ///< why they are pending; empty = of a stop, or none is
};

/// Makes the pending files of a result from the others in its folder, each durable before the next is begun, then the
/// digests, then result.json. A file that cannot be made is told as such with the reason: nobody waits for it. The same
/// files come out whenever they are made. stop: ends it within a file's encoding, at most a second or so; what is left
/// is pending. Throws Error kBadInput for a text that is no result.json, kStorageFull and kStorageWrite where
/// result.json itself cannot be written. context: one thread a folder; as much memory as follow_bytes() tells.
[[nodiscard]] FollowedResult follow_result(ResultToFollow result, const std::stop_token& stop);

/// Memory that follow_result() takes beside `written`: planes of the surface, and one file while it is encoded.
[[nodiscard]] std::size_t follow_bytes(const Result& result);

}  // namespace fvd
