#pragma once

/// The state that the replayed camera and the replayed stage share: the slice at which the stage stands.

#include <atomic>
#include <filesystem>
#include <memory>

namespace fvd {

/// context: thread-safe.
struct ReplayBench {
  std::atomic<int> slice{0};  ///< index of the slice in focus
};

/// The bench of a recording; every caller that names the same folder gets the same object while anyone holds it. Camera
/// and stage are opened separately, in any order, and find each other this way.
/// context: thread-safe.
[[nodiscard]] std::shared_ptr<ReplayBench> replay_bench(const std::filesystem::path& recording);

}  // namespace fvd
