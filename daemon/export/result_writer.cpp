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
#include "daemon/export/sha256.hpp"
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

std::vector<Task> tasks_of(std::span<const Exporter> exporters, const ExportInput& of_result) {
  std::vector<Task> tasks;
  for (const Exporter& exporter : exporters) {
    for (auto& [name, input] : export_files(exporter, of_result)) {
      tasks.push_back({std::move(name), exporter.cost, exporter.encode, exporter.stream, std::move(input)});
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
      list.push_back({.name = file.name, .size_bytes = file.size_bytes});
      continue;
    }
    const std::string folder = file.name.substr(0, slash + 1);
    const auto [place, is_new] = folders.try_emplace(folder, list.size());
    if (is_new) list.push_back({.name = folder, .files = 0});
    ResultFile& entry = list[place->second];
    ++*entry.files;
    entry.size_bytes += file.size_bytes;
  }
  return list;
}

/// The directory, for exporters that run beside each other.
class SharedDirectory {
 public:
  /// kept: takes the bytes in place of their digest; null = the digest is wanted at once.
  SharedDirectory(AtomicDirectory& directory, std::vector<WrittenBytes>* kept) : directory_(directory), kept_(kept) {}

  /// Makes the file of the task. Throws Error that begins with the file's name.
  ResultFile write(const Task& task) {
    try {
      return task.stream != nullptr ? write_stream(task) : write_bytes(task);
    } catch (const Error& error) {
      throw Error(error.code(), task.name + ": " + error.what());
    } catch (const std::exception& error) {
      throw Error(ErrorCode::kInternal, task.name + ": " + error.what());
    }
  }

 private:
  ResultFile write_bytes(const Task& task) {
    std::string bytes = task.encode(task.input);
    ResultFile file{.name = task.name, .size_bytes = bytes.size()};
    {
      const MutexLock lock(mutex_);
      directory_.add_file(task.name, bytes);
      if (kept_ != nullptr) {
        kept_->push_back({task.name, std::move(bytes)});
        return file;
      }
    }
    file.sha256 = sha256_of(bytes);  // while the disk is busy with them
    return file;
  }

  /// Another exporter encodes meanwhile, but adds its file afterwards.
  ResultFile write_stream(const Task& task) {
    Sha256 digest;
    const MutexLock lock(mutex_);
    directory_.add_file(task.name, [&](const ByteSink& sink) {
      task.stream(task.input, [&](std::string_view bytes) {
        digest.update(bytes);
        sink(bytes);
      });
    });
    return {.name = task.name, .size_bytes = directory_.files().back().size_bytes, .sha256 = digest.digits()};
  }

  Mutex mutex_;
  AtomicDirectory& directory_ FVD_GUARDED_BY(mutex_);
  std::vector<WrittenBytes>* const kept_ FVD_PT_GUARDED_BY(mutex_);
};

/// Writes the files of the exporters, then the result.json that lists them, and behind them as pending those of
/// `following`.
Result write_files(AtomicDirectory& directory, const ResultData& data, const DividedExporters& exporters,
                   std::vector<WrittenBytes>* kept) {
  const auto start = std::chrono::steady_clock::now();
  const ExportInput input = export_input(data);
  const std::vector<Task> tasks = tasks_of(exporters.first, input);
  const std::vector<std::size_t> order = order_of(tasks);
  std::vector<ResultFile> files = listed(directory.files());
  const std::size_t before = files.size();
  files.resize(before + tasks.size());
  SharedDirectory shared(directory, kept);
  const auto write = [&](int turn) {
    const std::size_t index = order[static_cast<std::size_t>(turn)];
    files[before + index] = shared.write(tasks[index]);
  };
  WorkerPool(kExportersAtOnce).run(static_cast<int>(order.size()), std::ref(write));
  for (const Task& task : tasks_of(exporters.following, input)) {
    files.push_back({.name = task.name, .state = FileState::kPending});
  }
  Result result = evaluate(data, input.summary.get());
  result.files = std::move(files);
  result.times.write_ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  directory.add_file("result.json", result_json_text(result));
  return result;
}

}  // namespace

Result write_result(AtomicDirectory& directory, const ResultData& data, std::span<const Exporter> exporters) {
  return write_files(directory, data, {{exporters.begin(), exporters.end()}, {}}, nullptr);
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

bool FirstFiles::is_complete() const noexcept {
  return written.empty() && std::none_of(result.files.begin(), result.files.end(),
                                         [](const ResultFile& file) { return file.state == FileState::kPending; });
}

FirstFiles write_first_files(AtomicDirectory& directory, const ResultData& data) {
  FirstFiles files;
  files.result = write_files(directory, data, divided(chosen_exporters(data.exports)), &files.written);
  return files;
}

}  // namespace fvd
