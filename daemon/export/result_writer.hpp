#pragma once

/// The result directory of a job.
///
/// height.tiff, height_<method>.tiff, sigma.tiff, height.gsf, mask.png, texture.png, preview.png, step_log.csv,
/// result.json

#include <filesystem>

#include "core/surface/statistics.hpp"
#include "daemon/export/atomic_directory.hpp"
#include "daemon/export/result_data.hpp"

namespace fvd {

/// Writes all files of the result into the directory, result.json last; does not commit.
/// Encodes in memory, the images beside the rest (at most about 12 bytes a pixel). Returns the summary that the files
/// tell. Throws Error kStorageFull, kStorageWrite.
HeightSummary write_result(AtomicDirectory& directory, const ResultData& data);

/// Makes final_dir with the result in it, durably: after the return a power cut does not harm it; after an exception
/// nothing of it exists. Throws Error kStorageFull, kStorageWrite; the latter also if final_dir exists.
HeightSummary write_result(const std::filesystem::path& final_dir, const ResultData& data);

}  // namespace fvd
