#pragma once

/// Which results go to make room. No I/O.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace fvd {

/// A result on the disk.
struct KeptResult {
  std::int64_t age_s = 0;  ///< since its job ended
  std::uint64_t bytes = 0;
  std::uint64_t slices_bytes = 0;  ///< of these the recorded slices
  bool removable = false;          ///< acknowledged, and no file of it is still to be made
};

struct RetentionLimits {
  std::optional<std::int64_t> longest_s = {};
  std::optional<std::uint64_t> most_bytes = {};        ///< of all results
  std::optional<std::uint64_t> least_free_bytes = {};  ///< of the disk
};

struct RetentionStep {
  std::size_t result = 0;  ///< its index
  bool slices_alone = false;
  bool operator==(const RetentionStep&) const = default;
};

/// What is to be removed, in this order. results: the oldest first. What is not removable stays, even where a limit is
/// missed by it.
[[nodiscard]] std::vector<RetentionStep> retention_plan(const std::vector<KeptResult>& results,
                                                        const RetentionLimits& limits, std::uint64_t free_bytes);

}  // namespace fvd
