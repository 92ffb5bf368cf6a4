#pragma once

/// Where the replayed camera and the replayed stage meet: the slice the stage stands at.

#include <atomic>
#include <filesystem>
#include <memory>

namespace fvd {

/// context: thread-safe.
struct ReplayBench {
  std::atomic<int> slice{0};  ///< index of the slice in focus
};

/// The bench of a recording: the same one for everybody who names the same folder while somebody holds it. Camera and
/// stage are opened apart, in any order, and this is how they find each other.
/// context: thread-safe.
[[nodiscard]] std::shared_ptr<ReplayBench> replay_bench(const std::filesystem::path& recording);

}  // namespace fvd
