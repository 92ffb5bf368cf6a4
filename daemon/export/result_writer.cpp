#include "daemon/export/result_writer.hpp"

#include <algorithm>
#include <chrono>
#include <functional>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/mutex.hpp"
#include "core/runtime/worker_pool.hpp"
#include "daemon/export/result_json.hpp"

namespace fvd {

namespace {

/// One file in memory beside another: more would need more memory than the jobs reserve for it.
constexpr int kExportersAtOnce = 2;

/// A file to be made.
struct Task {
  std::string name;
  ExportCost cost;
  std::string (*encode)(const ExportInput& input);
  ExportInput input;
};

std::string with_method(std::string_view name, PeakMethod method) {
  std::string text(name);
  const auto place = text.find('*');
  return place == std::string::npos ? text : text.replace(place, 1, peak_method_name(method));
}

std::vector<Task> tasks_of(std::span<const Exporter> exporters, const ResultData& data,
                           const std::shared_future<HeightSummary>& summary) {
  std::vector<Task> tasks;
  const auto add = [&](const Exporter& exporter, const HeightMap& map, PeakMethod peak) {
    tasks.push_back({with_method(exporter.name, peak), exporter.cost, exporter.encode, {data, map, peak, summary}});
  };
  for (const Exporter& exporter : exporters) {
    if (exporter.need == ExportNeed::kResult) {
      add(exporter, data.map, data.peak);
    } else {
      for (const auto& [method, map] : data.extra_maps) add(exporter, map, method);
    }
  }
  return tasks;
}

/// Indices of the tasks as they are begun.
std::vector<std::size_t> order_of(const std::vector<Task>& tasks) {
  std::vector<std::size_t> order(tasks.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_partition(order.begin(), order.end(),
                        [&tasks](std::size_t index) { return tasks[index].cost == ExportCost::kSlow; });
  return order;
}

/// The directory, for exporters that run beside each other.
class SharedDirectory {
 public:
  explicit SharedDirectory(AtomicDirectory& directory) : directory_(directory) {}

  /// Makes the file of the task. Throws Error that begins with the file's name.
  AtomicDirectory::File write(const Task& task) {
    try {
      const std::string bytes = task.encode(task.input);
      MutexLock lock(mutex_);
      directory_.add_file(task.name, bytes);
      return {task.name, bytes.size()};
    } catch (const Error& error) {
      throw Error(error.code(), task.name + ": " + error.what());
    } catch (const std::exception& error) {
      throw Error(ErrorCode::kInternal, task.name + ": " + error.what());
    }
  }

 private:
  Mutex mutex_;
  AtomicDirectory& directory_ FVD_GUARDED_BY(mutex_);
};

}  // namespace

HeightSummary write_result(AtomicDirectory& directory, const ResultData& data, std::span<const Exporter> exporters) {
  const auto start = std::chrono::steady_clock::now();
  const std::shared_future<HeightSummary> summary = std::async(
      std::launch::deferred, [&data] { return summarize_heights(data.map.height_m, data.map.sigma_m, data.map.mask); });
  std::vector<AtomicDirectory::File> files = directory.files();
  const std::vector<Task> tasks = tasks_of(exporters, data, summary);
  const std::vector<std::size_t> order = order_of(tasks);
  const std::size_t before = files.size();
  files.resize(before + tasks.size());
  SharedDirectory shared(directory);
  const auto write = [&](int turn) {
    const std::size_t index = order[static_cast<std::size_t>(turn)];
    files[before + index] = shared.write(tasks[index]);
  };
  WorkerPool(kExportersAtOnce).run(static_cast<int>(order.size()), std::ref(write));
  const double write_ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  directory.add_file("result.json", result_json_text(data, summary.get(), WriteReport{std::move(files), write_ms}));
  return summary.get();
}

HeightSummary write_result(const std::filesystem::path& final_dir, const ResultData& data) {
  AtomicDirectory directory(final_dir);
  const HeightSummary summary = write_result(directory, data);
  directory.commit();
  return summary;
}

}  // namespace fvd
