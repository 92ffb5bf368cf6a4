#pragma once

/// A study as the page that its report shows.

#include "daemon/report/study_page.hpp"
#include "daemon/study/study_draft.hpp"

namespace fvd {

/// All but what the study is given when it is kept. Takes the draft's pictures.
[[nodiscard]] StudyPage study_page(StudyDraft& draft);

/// Puts the study's id and time on the page.
void set_identity(const Study& study, StudyPage& page);

/// "verify.noise" in words: "Measurement noise".
[[nodiscard]] std::string study_title(const std::string& kind);

}  // namespace fvd
