#pragma once

/// Makes a copy of all that an instrument knows.

#include <filesystem>
#include <string>
#include <vector>

namespace fvd {

/// Where an instrument keeps what it knows.
struct InstrumentPaths {
  std::filesystem::path state_dir;   ///< with fvd.sqlite
  std::filesystem::path recipe_dir;  ///< of the shipped recipes
  std::filesystem::path config_file;
};

/// Makes `folder`, which must not exist, with the copy; whole or not at all. The daemon may run and measure meanwhile.
/// with_results: also the folders of all results that the copied database knows. Returns the results whose folders are
/// not there. Throws Error kBadInput, kDatabase, kStorageFull, kStorageWrite.
std::vector<std::string> make_backup(const InstrumentPaths& instrument, const std::filesystem::path& folder,
                                     bool with_results);

}  // namespace fvd
