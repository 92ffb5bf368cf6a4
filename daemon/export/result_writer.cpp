#include "daemon/export/result_writer.hpp"

#include <algorithm>
#include <chrono>
#include <functional>
#include <map>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/mutex.hpp"
#include "core/runtime/worker_pool.hpp"
#include "daemon/export/result_json.hpp"
#include "daemon/result/evaluate.hpp"

namespace fvd {

namespace {

/// One file in memory beside another: more would need more memory than the jobs reserve for it.
constexpr int kExportersAtOnce = 2;

/// A file to be made.
struct Task {
  std::string name;
  ExportCost cost;
  std::string (*encode)(const ExportInput& input);
  void (*stream)(const ExportInput& input, const ByteSink& sink);  ///< in place of encode
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
    tasks.push_back({with_method(exporter.name, peak),
                     exporter.cost,
                     exporter.encode,
                     exporter.stream,
                     {data, map, peak, summary}});
  };
  for (const Exporter& exporter : exporters) {
    switch (exporter.need) {
      case ExportNeed::kResult:
        add(exporter, data.map, data.peak);
        break;
      case ExportNeed::kSmoothedMap:
        if (data.smoothed) add(exporter, data.map, data.peak);
        break;
      case ExportNeed::kRepeatedScans:
        if (data.repeated) add(exporter, data.map, data.peak);
        break;
      case ExportNeed::kEachExtraMap:
        for (const auto& [method, map] : data.extra_maps) add(exporter, map, method);
        break;
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

/// One entry per file; the files of a folder, e.g. recorded slices, share one entry.
std::vector<ResultFile> listed(const std::vector<AtomicDirectory::File>& files) {
  std::vector<ResultFile> list;
  std::map<std::string, std::size_t> folders;  // name -> place in the list
  for (const auto& file : files) {
    const auto slash = file.name.find('/');
    if (slash == std::string::npos) {
      list.push_back({file.name, std::nullopt, file.size_bytes});
      continue;
    }
    const std::string folder = file.name.substr(0, slash + 1);
    const auto [place, is_new] = folders.try_emplace(folder, list.size());
    if (is_new) list.push_back({folder, 0, 0});
    ResultFile& entry = list[place->second];
    ++*entry.files;
    entry.size_bytes += file.size_bytes;
  }
  return list;
}

/// The directory, for exporters that run beside each other.
class SharedDirectory {
 public:
  explicit SharedDirectory(AtomicDirectory& directory) : directory_(directory) {}

  /// Makes the file of the task. Throws Error that begins with the file's name.
  AtomicDirectory::File write(const Task& task) {
    try {
      if (task.stream != nullptr) return write_stream(task);
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
  /// Another exporter encodes meanwhile, but adds its file afterwards.
  AtomicDirectory::File write_stream(const Task& task) {
    MutexLock lock(mutex_);
    directory_.add_file(task.name, [&task](const ByteSink& sink) { task.stream(task.input, sink); });
    return directory_.files().back();
  }

  Mutex mutex_;
  AtomicDirectory& directory_ FVD_GUARDED_BY(mutex_);
};

}  // namespace

Result write_result(AtomicDirectory& directory, const ResultData& data, std::span<const Exporter> exporters) {
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
  Result result = evaluate(data, summary.get());
  result.files = listed(files);
  result.times.write_ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  directory.add_file("result.json", result_json_text(result));
  return result;
}

Result write_result(AtomicDirectory& directory, const ResultData& data) {
  return write_result(directory, data, chosen_exporters(data.exports));
}

Result write_result(const std::filesystem::path& final_dir, const ResultData& data) {
  AtomicDirectory directory(final_dir);
  Result result = write_result(directory, data);
  directory.commit();
  return result;
}

}  // namespace fvd
