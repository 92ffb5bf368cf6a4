#pragma once

/// The files that a setup ends in: the configuration, and the recipe of its trial scan.

#include <filesystem>
#include <string>

#include "daemon/setup/setup_draft.hpp"

namespace fvd {

/// The recipe of a trial scan, as a document. range: within the limits.
[[nodiscard]] std::string trial_recipe(const SetupDraft& draft, const TrialRange& range);

/// Camera and stage as an older configuration has them: what nobody is asked about is in force from the first question
/// on. The defaults where there is none, or one that cannot be read. Throws nothing but std::bad_alloc.
[[nodiscard]] DeviceConfigs older_devices(const std::filesystem::path& file);

/// Writes the configuration: camera and stage as the draft has them, the other blocks as in an older file there;
/// comments are lost, but the older file is kept beside it as FILE.old-N. replace: false refuses to touch a file that
/// is there, and so does a file that appears meanwhile. The text is checked as `fvd --check-config` does before it
/// takes the file's place, in one step: a power cut leaves the old file or the new one. With a trial, its recipe is put
/// into the recipe folder under a name that is free, before that. What fails leaves neither. Returns what was written,
/// in words. Throws Error kBadInput (there is a file), kBadConfig (with every problem), kStorageWrite, kStorageFull.
[[nodiscard]] std::string write_setup(const SetupDraft& draft, const std::filesystem::path& file, bool replace);

}  // namespace fvd
