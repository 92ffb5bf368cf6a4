#pragma once

/// The result directory of a job: the files of the exporter table, and result.json.

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "daemon/export/atomic_directory.hpp"
#include "daemon/export/exporter_table.hpp"
#include "daemon/result/result.hpp"
#include "daemon/result/result_data.hpp"

namespace fvd {

/// Judges what was acquired and writes all files of its result into the directory, result.json with the verdict last;
/// does not commit. Two exporters run at a time, encoding in memory (at most about 12 bytes per pixel). Returns the
/// result that result.json tells. The first failure ends it: Error kStorageFull, kStorageWrite, kInternal, its message
/// beginning with the name of the file.
Result write_result(AtomicDirectory& directory, const ResultData& data, std::span<const Exporter> exporters);

/// The same with the files that data.exports names.
Result write_result(AtomicDirectory& directory, const ResultData& data);

/// Makes final_dir with the result in it, durably: after the return a power cut does not harm it; after an exception
/// nothing of it exists. Throws Error as above; kStorageWrite also if final_dir exists.
Result write_result(const std::filesystem::path& final_dir, const ResultData& data);

/// The bytes of a file as they were written, whose digest is not known yet.
struct WrittenBytes {
  std::string name;
  std::string bytes;
};

/// A result whose other files follow.
struct FirstFiles {
  Result result;                      ///< as result.json tells it: lists the others as pending, the digests as unknown
  std::vector<WrittenBytes> written;  ///< what digests are made of afterwards; about 12 bytes per pixel

  [[nodiscard]] bool is_complete() const noexcept;
};

/// As write_result(), but of the files that data.exports names only those that a verdict waits for: see follows(). No
/// digest is computed: of 5 million points they take as long as all else here.
FirstFiles write_first_files(AtomicDirectory& directory, const ResultData& data);

/// The same while the evaluation still runs, which these files do not show: encoding them and bringing them to the disk
/// takes as long as it does. Destroyed without finish() it waits for what is under way.
class FirstFilesWriter {
 public:
  /// Begins at once, on threads of its own. directory and data outlive it; nothing else may be added to the directory
  /// before finish(), and of the data only `evaluation` and `times` may change.
  FirstFilesWriter(AtomicDirectory& directory, const ResultData& data);
  ~FirstFilesWriter();
  FirstFilesWriter(const FirstFilesWriter&) = delete;
  FirstFilesWriter& operator=(const FirstFilesWriter&) = delete;

  /// Waits for the files and writes result.json. Once. Throws as write_result().
  [[nodiscard]] FirstFiles finish();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace fvd
