#pragma once

/// All studies that were made: a folder each, which is never changed.

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/base/mutex.hpp"
#include "daemon/result/repeatability.hpp"
#include "daemon/study/study.hpp"
#include "daemon/study/study_draft.hpp"

namespace fvd {

/// A study that cannot be read.
struct BrokenStudy {
  std::string id;
  std::string reason;
};

/// context: every function thread-safe; keep() blocks for files, those that only read never wait for it.
class StudyBook {
 public:
  /// Reads <folder>/*/study.json; no such folder = no studies yet. What a killed process left is cleared away. One that
  /// cannot be read is told by broken() and keeps its number.
  explicit StudyBook(std::filesystem::path folder);
  /// Takes back what the disk did not take back when it was refused.
  ~StudyBook();
  StudyBook(const StudyBook&) = delete;
  StudyBook& operator=(const StudyBook&) = delete;

  /// Gives the study its id and time and makes its folder: the draft's files, and report.pdf made by page, which is
  /// called with the study as it will be kept. Durable at the return. Throws Error kStorageFull, kStorageWrite;
  /// kStudyRefused where a figure or constant is out of the range that could be read back. Nothing is left
  /// then; where the disk does not take that either, it is tried again by the next call and at the end.
  Study keep(StudyDraft draft, const std::function<std::string(const Study&)>& report);

  /// Throws Error kStudyRefused naming the id, also where it cannot be read.
  [[nodiscard]] Study get(const std::string& id) const;
  /// The newest first.
  [[nodiscard]] std::vector<Study> list() const;
  [[nodiscard]] std::vector<BrokenStudy> broken() const;

  /// By "measurement.value": of each value of this recipe the newest gauge study's figure, of jobs that were measured
  /// with this objective ("" = none is named), by a simulator or not: what a simulator scatters says nothing of an
  /// instrument.
  [[nodiscard]] std::map<std::string, Repeatability> newest_repeatability(const std::string& recipe_id,
                                                                          const std::string& objective,
                                                                          bool simulated) const;

  [[nodiscard]] std::filesystem::path folder_of(const std::string& id) const { return folder_ / id; }

 private:
  [[nodiscard]] int next_number() const;
  void take_back_refused() noexcept FVD_REQUIRES(keeping_);

  const std::filesystem::path folder_;
  Mutex keeping_;                                   ///< held while a folder is written; before mutex_
  std::set<int> refused_ FVD_GUARDED_BY(keeping_);  ///< their folders are there although keep() failed
  mutable Mutex mutex_;
  std::map<int, Study> studies_ FVD_GUARDED_BY(mutex_);
  std::map<int, BrokenStudy> broken_ FVD_GUARDED_BY(mutex_);
  int last_ FVD_GUARDED_BY(mutex_) = 0;
};

}  // namespace fvd
