#pragma once

/// The steps of the setup as rows of a table: what each asks, and what it does with an answer. Inside this folder only.

#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/setup/setup.hpp"
#include "daemon/setup/setup_bench.hpp"
#include "daemon/setup/setup_draft.hpp"
#include "daemon/setup/setup_question.hpp"

namespace fvd {

/// An answer in words.
class SetupAnswer {
 public:
  explicit SetupAnswer(std::string_view text);

  [[nodiscard]] const std::string& text() const { return text_; }  ///< without spaces around it
  [[nodiscard]] std::size_t size() const { return words_.size(); }
  /// Empty where there are fewer words.
  [[nodiscard]] const std::string& word(std::size_t index) const;
  [[nodiscard]] bool is(std::string_view only) const { return words_.size() == 1 && words_.front() == only; }
  [[nodiscard]] bool begins(std::string_view first, std::size_t count) const;  ///< with that word, of so many words
  /// Throws Error kBadInput if that word is no number of the range.
  [[nodiscard]] double number(std::size_t index, double least, double most, std::string_view what) const;

 private:
  std::string text_;
  std::vector<std::string> words_;
};

/// Throws Error kBadInput: the answer is none of those that the question names.
[[noreturn]] void refuse_answer(const SetupAnswer& answer);

struct SetupContext {
  const SetupOptions& options;
  SetupBench& bench;
  SetupDraft draft;
  std::vector<FoundCamera> cameras;  ///< of the last search
  std::string note;                  ///< to be told with the next question
  std::filesystem::path written;     ///< the configuration, once it is written
  std::stop_token stop;
};

enum class SetupNext {
  kStay,      ///< the same question again
  kOn,        ///< the next step
  kStepBack,  ///< the step before, with what was decided
};

struct SetupStep {
  const char* name;
  bool (*wanted)(SetupContext& context);  ///< nullptr = always; touches no device
  /// Fills all but name and note. Moves nothing. Where it throws an Error the answer before is not taken.
  SetupQuestion (*ask)(SetupContext& context);
  /// Throws Error for an answer that cannot be; the same question is then asked again, after kStageNotHomed the
  /// reference before it.
  SetupNext (*take)(SetupContext& context, const SetupAnswer& answer);
};

/// In the order in which they are asked.
[[nodiscard]] std::vector<SetupStep> device_steps();   ///< camera, line, profile, unit, scale, travel, reference
[[nodiscard]] std::vector<SetupStep> axis_steps();     ///< direction and limits
[[nodiscard]] std::vector<SetupStep> picture_steps();  ///< exposure, focus, orientation, pixel pitch
[[nodiscard]] std::vector<SetupStep> last_steps();     ///< trial scan, files

/// Fills context.cameras, or the note where that failed.
void search_cameras(SetupContext& context);

/// "12.3 um", "0.04 um": four significant digits.
[[nodiscard]] std::string um_text(double um);

/// Where the axis stands. Throws Error kStageNotHomed: a position without a reference is none; else as the bench does.
[[nodiscard]] Micrometers position(SetupContext& context);

/// Longest way away from the part for one answer.
inline constexpr double kLongestUp_um = 1000.0;

/// The usual criterion, with the time that this stage needs for the way added to its timeout. distance_um: >= 0.
[[nodiscard]] SettleCriterion settle_within(const StageConfig& stage, double distance_um);

/// Moves by a distance and says in the note where the axis stands. Throws as Axis::move_to().
void move_by(SetupContext& context, double distance_um);

}  // namespace fvd
