#pragma once

/// The result directory of a job.
///
/// height.tiff, height_<method>.tiff, height.gsf, mask.png, texture.png, preview.png, step_log.csv, result.json

#include <filesystem>

#include "daemon/export/atomic_directory.hpp"
#include "daemon/export/result_data.hpp"

namespace fvd {

/// Writes all files of the result into the directory, result.json last; does not commit.
/// Encodes one file at a time in memory (at most about 4 bytes a pixel). Throws Error kStorageFull, kStorageWrite.
void write_result(AtomicDirectory& directory, const ResultData& data);

/// Makes final_dir with the result in it, durably: after the return a power cut does not harm it; after an exception
/// nothing of it exists. Throws Error kStorageFull, kStorageWrite; the latter also if final_dir exists.
void write_result(const std::filesystem::path& final_dir, const ResultData& data);

}  // namespace fvd
