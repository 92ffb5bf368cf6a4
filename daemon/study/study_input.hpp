#pragma once

/// A study's parameters as JSON, and studies where there is no daemon.

#include <filesystem>
#include <string>

#include "daemon/study/study.hpp"
#include "daemon/study/study_requests.hpp"

namespace fvd {

/// The request of a kind from its parameters, as the method of that name takes them; "person" is one of them. Throws
/// Error kBadInput with every problem, and for a kind that is made of other studies or is none.
[[nodiscard]] StudyRequest read_study_request(const std::string& kind, const std::string& json);

/// The study of results in folders: the jobs of the request are paths of folders, its recipe is that of a file. Nothing
/// is kept and the study has no id. calibration_folder: with the reference maps that results name; may be empty. Throws
/// what StudyDesk::make() throws. context: blocks for files.
[[nodiscard]] Study study_of_folders(const StudyRequest& request, const std::filesystem::path& calibration_folder);

}  // namespace fvd
