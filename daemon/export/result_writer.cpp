#include "daemon/export/result_writer.hpp"

#include <algorithm>
#include <chrono>
#include <exception>
#include <functional>
#include <map>
#include <numeric>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/mutex.hpp"
#include "core/runtime/guarded_thread.hpp"
#include "core/runtime/thread_ticks.hpp"
#include "core/runtime/worker_pool.hpp"
#include "daemon/export/picture_exporters.hpp"
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

/// Whether its file shows what was measured, and not the surface alone.
bool shows_evaluation(const Exporter& exporter) {
  return exporter.need == ExportNeed::kEachSection || exporter.need == ExportNeed::kCuttingEdges ||
         exporter.encode == report_file;
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

/// The files of exporters, then the result.json that lists them, and behind them as pending those of the exporters that
/// follow.
class FilesInWork {
 public:
  FilesInWork(AtomicDirectory& directory, const ResultData& data, std::vector<WrittenBytes>* kept)
      : directory_(directory),
        data_(data),
        input_(export_input(data)),
        files_(listed(directory.files())),
        shared_(directory, kept) {}

  void make(std::span<const Exporter> exporters) {
    const std::vector<Task> tasks = tasks_of(exporters, input_);
    const std::vector<std::size_t> order = order_of(tasks);
    const std::size_t before = files_.size();
    files_.resize(before + tasks.size());
    const auto write = [&](int turn) {
      if (turn == static_cast<int>(order.size())) {
        input_.summary.wait();  // result.json needs it
        return;
      }
      const std::size_t index = order[static_cast<std::size_t>(turn)];
      files_[before + index] = shared_.write(tasks[index]);
    };
    WorkerPool(kExportersAtOnce).run(static_cast<int>(order.size()) + 1, std::ref(write));
  }

  /// since: when somebody began to wait for the files.
  Result finish(std::span<const Exporter> following, std::chrono::steady_clock::time_point since) {
    for (const Task& task : tasks_of(following, input_)) {
      files_.push_back({.name = task.name, .state = FileState::kPending});
    }
    Result result = evaluate(data_, input_.summary.get());
    result.files = std::move(files_);
    result.times.write_ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - since).count();
    directory_.add_file("result.json", result_json_text(result));
    return result;
  }

 private:
  AtomicDirectory& directory_;
  const ResultData& data_;
  ExportInput input_;
  std::vector<ResultFile> files_;
  SharedDirectory shared_;
};

Result write_files(AtomicDirectory& directory, const ResultData& data, const DividedExporters& exporters,
                   std::vector<WrittenBytes>* kept) {
  const auto start = std::chrono::steady_clock::now();
  FilesInWork work(directory, data, kept);
  work.make(exporters.first);
  return work.finish(exporters.following, start);
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

namespace {

/// All that a verdict waits for.
constexpr std::chrono::minutes kLongestFiles{10};

}  // namespace

struct FirstFilesWriter::Impl {
  Impl(AtomicDirectory& directory, const ResultData& data)
      : exporters(divided(chosen_exporters(data.exports))), work(directory, data, &written) {
    const auto late = std::stable_partition(exporters.first.begin(), exporters.first.end(),
                                            [](const Exporter& exporter) { return !shows_evaluation(exporter); });
    evaluated.assign(late, exporters.first.end());
    exporters.first.erase(late, exporters.first.end());
  }

  DividedExporters exporters;
  std::vector<Exporter> evaluated;  // of the first those that wait for the evaluation
  std::vector<WrittenBytes> written;
  FilesInWork work;
  std::exception_ptr failure;
  std::jthread thread;  // last: it uses everything above
};

FirstFilesWriter::FirstFilesWriter(AtomicDirectory& directory, const ResultData& data)
    : impl_(std::make_unique<Impl>(directory, data)) {
  impl_->thread = start_thread("fvd-files", [impl = impl_.get()](const std::stop_token&) {
    ThreadTicks ticks("fvd-files", kLongestFiles);
    ticks.tick(HostClock::now());
    try {
      impl->work.make(impl->exporters.first);
    } catch (...) {
      impl->failure = std::current_exception();
    }
  });
}

FirstFilesWriter::~FirstFilesWriter() = default;

FirstFiles FirstFilesWriter::finish() {
  const auto start = std::chrono::steady_clock::now();
  impl_->thread.join();
  if (impl_->failure) std::rethrow_exception(impl_->failure);
  if (!impl_->evaluated.empty()) impl_->work.make(impl_->evaluated);
  FirstFiles files;
  files.result = impl_->work.finish(impl_->exporters.following, start);
  files.written = std::move(impl_->written);
  return files;
}

FirstFiles write_first_files(AtomicDirectory& directory, const ResultData& data) {
  FirstFiles files;
  files.result = write_files(directory, data, divided(chosen_exporters(data.exports)), &files.written);
  return files;
}

}  // namespace fvd
