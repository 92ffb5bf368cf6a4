#pragma once

/// The maps of the results that were looked at last.

#include <cstddef>
#include <filesystem>
#include <list>
#include <memory>
#include <string>

#include "core/base/mutex.hpp"
#include "daemon/views/result_maps.hpp"

namespace fvd {

/// context: thread-safe.
class MapCache {
 public:
  struct Limits {
    std::size_t results = 4;
    std::size_t bytes = std::size_t{256} << 20U;  ///< that their maps hold in memory; one that is larger is not kept
  };
  MapCache() : MapCache(Limits{}) {}
  explicit MapCache(const Limits& limits) : limits_(limits) {}

  /// Of the job's result in the folder; never null. Whoever has it may use it for as long as he likes.
  [[nodiscard]] std::shared_ptr<ResultMaps> of(const std::string& job_id, const std::filesystem::path& folder);
  /// The job's result is gone: its files are closed, so that they take no room on the disk.
  void forget(const std::string& job_id);
  /// Results that are kept.
  [[nodiscard]] std::size_t size() const;

 private:
  struct Kept {
    std::string job_id;
    std::shared_ptr<ResultMaps> maps;
  };
  void trim() FVD_REQUIRES(mutex_);

  const Limits limits_;
  mutable Mutex mutex_;
  std::list<Kept> newest_first_ FVD_GUARDED_BY(mutex_);
};

}  // namespace fvd
