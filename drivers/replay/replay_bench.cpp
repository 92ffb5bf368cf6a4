#include "drivers/replay/replay_bench.hpp"

#include <map>

#include "core/base/mutex.hpp"

namespace fvd {

namespace {

struct Benches {
  Mutex mutex;
  std::map<std::filesystem::path, std::weak_ptr<ReplayBench>> by_recording FVD_GUARDED_BY(mutex);
};

}  // namespace

std::shared_ptr<ReplayBench> replay_bench(const std::filesystem::path& recording) {
  static Benches benches;
  const MutexLock lock(benches.mutex);
  std::erase_if(benches.by_recording, [](const auto& entry) { return entry.second.expired(); });
  auto& known = benches.by_recording[std::filesystem::weakly_canonical(recording)];
  auto bench = known.lock();
  if (!bench) {
    bench = std::make_shared<ReplayBench>();
    known = bench;
  }
  return bench;
}

}  // namespace fvd
