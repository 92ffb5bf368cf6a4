#include "drivers/replay/replay_bench.hpp"

#include <map>
#include <mutex>

namespace fvd {

std::shared_ptr<ReplayBench> replay_bench(const std::filesystem::path& recording) {
  static std::mutex mutex;
  static std::map<std::filesystem::path, std::weak_ptr<ReplayBench>> benches;
  const std::lock_guard lock(mutex);
  std::erase_if(benches, [](const auto& entry) { return entry.second.expired(); });
  auto& known = benches[std::filesystem::weakly_canonical(recording)];
  auto bench = known.lock();
  if (!bench) {
    bench = std::make_shared<ReplayBench>();
    known = bench;
  }
  return bench;
}

}  // namespace fvd
