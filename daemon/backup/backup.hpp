#pragma once

/// Makes a copy of all that an instrument knows.

#include <filesystem>
#include <string>
#include <vector>

namespace fvd {

/// Where an instrument keeps what it knows.
struct InstrumentPaths {
  std::filesystem::path state_dir;           ///< with fvd.sqlite
  std::filesystem::path recipe_dir;          ///< of the shipped recipes
  std::filesystem::path config_file;         ///< with conf.d beside it
  std::filesystem::path stage_profile = {};  ///< empty = none is configured, as the next one
  std::filesystem::path token_file = {};
};

/// Makes `folder`, which must not exist, as FOLDER.tmp must not, in one that exists outside of the state folder, with
/// the copy; whole or not at all. The daemon may run and measure meanwhile. with_results: also the folders of all
/// results that the copied database knows. Returns the results whose folders are not there, also those that were
/// removed to make room meanwhile. Throws Error kBadInput, kDatabase, kStorageFull, kStorageWrite.
std::vector<std::string> make_backup(const InstrumentPaths& instrument, const std::filesystem::path& folder,
                                     bool with_results);

}  // namespace fvd
