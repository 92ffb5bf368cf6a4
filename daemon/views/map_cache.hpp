#pragma once

/// The maps of the results that were looked at last.

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <list>
#include <memory>
#include <stop_token>
#include <string>
#include <thread>

#include "core/base/clock.hpp"
#include "core/base/mutex.hpp"
#include "daemon/views/result_maps.hpp"

namespace fvd {

/// Owns a thread, from the first result on, that lets go of what nobody looks at: memory, and files that may be removed
/// meanwhile. context: thread-safe.
class MapCache {
 public:
  static constexpr std::chrono::seconds kLongestUnused{60};

  struct Limits {
    std::size_t results = 4;
    /// That their maps hold in memory, seen when the next result is asked for; one that is larger is not kept then.
    std::size_t bytes = std::size_t{256} << 20U;
  };
  MapCache() : MapCache(Limits{}) {}
  explicit MapCache(const Limits& limits) : limits_(limits) {}

  /// Of the job's result in the folder; never null. Whoever has it may use it for as long as he likes.
  [[nodiscard]] std::shared_ptr<ResultMaps> of(const std::string& job_id, const std::filesystem::path& folder,
                                               HostTime now = HostClock::now());
  /// The job's result is gone: its files are closed, so that they take no room on the disk.
  void forget(const std::string& job_id);
  /// Lets go of what nobody asked for within kLongestUnused. The thread does so by itself.
  void drop_unused(HostTime now);
  /// Results that are kept.
  [[nodiscard]] std::size_t size() const;

 private:
  struct Kept {
    std::string job_id;
    std::shared_ptr<ResultMaps> maps;
    HostTime used;
  };
  void trim() FVD_REQUIRES(mutex_);
  void run(const std::stop_token& stop);

  const Limits limits_;
  mutable Mutex mutex_;
  Condition changed_;
  std::list<Kept> newest_first_ FVD_GUARDED_BY(mutex_);
  std::jthread sweeper_;  // last; started under the mutex
};

}  // namespace fvd
