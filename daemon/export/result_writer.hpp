#pragma once

/// The result directory of a job: the files of the exporter table, and result.json.

#include <filesystem>
#include <span>

#include "core/surface/statistics.hpp"
#include "daemon/export/atomic_directory.hpp"
#include "daemon/export/exporter_table.hpp"
#include "daemon/export/result_data.hpp"

namespace fvd {

/// Writes all files of the result into the directory, result.json last; does not commit.
/// Two exporters run at a time, encoding in memory (at most about 12 bytes per pixel). Returns the summary that the
/// files tell. The first failure ends it: Error kStorageFull, kStorageWrite, kInternal, its message beginning with the
/// name of the file.
HeightSummary write_result(AtomicDirectory& directory, const ResultData& data,
                           std::span<const Exporter> exporters = exporter_table());

/// Makes final_dir with the result in it, durably: after the return a power cut does not harm it; after an exception
/// nothing of it exists. Throws Error as above; kStorageWrite also if final_dir exists.
HeightSummary write_result(const std::filesystem::path& final_dir, const ResultData& data);

}  // namespace fvd
