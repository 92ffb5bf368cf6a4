#pragma once

/// Files and folders copied so that a power cut does not harm the copy.

#include <filesystem>

namespace fvd {

/// Copies a file, or a folder with all in it but hidden files, to a path that does not exist; the parents of the path
/// are made. Each file is on the disk at the return, its folders too. Nothing where `from` does not exist. Throws Error
/// kStorageFull, kStorageWrite, kBadInput for what cannot be read.
void copy_durably(const std::filesystem::path& from, const std::filesystem::path& to);

/// Gives all below the path to the owner of `like`, where this process may do that.
void give_to_owner_of(const std::filesystem::path& like, const std::filesystem::path& path);

}  // namespace fvd
