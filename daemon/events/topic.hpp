#pragma once

/// One document that readers are told of whenever it changed.

#include <chrono>
#include <optional>
#include <string>

#include "core/base/clock.hpp"

namespace fvd {

struct TopicDocument {
  std::string text;      ///< as it is told
  std::string compared;  ///< what makes it another one: without clocks, and what else changes by itself
  std::string urgent;    ///< what is told at once: without figures that change all the time
};

/// context: one thread at a time.
class Topic {
 public:
  /// patience: between two tellings of which the second says nothing urgent.
  explicit Topic(std::chrono::milliseconds patience) : patience_(patience) {}

  /// Keeps the newest document. True if it is to be told now: it is another one than what was told last, and urgent or
  /// awaited long enough, or somebody was shown another one since. The first is not: whoever begins to read is told it.
  [[nodiscard]] bool take(TopicDocument document, HostTime now);
  /// The newest document may be told by a later take(): it is another one than what was told last, or was shown as one.
  [[nodiscard]] bool owes() const;
  /// Of the newest document; "null" before the first.
  [[nodiscard]] const std::string& text() const noexcept { return newest_.text; }
  /// The same for somebody who is told of changes from now on: where it was not told yet, the next is told even if it
  /// is what was told before.
  [[nodiscard]] const std::string& show();

 private:
  const std::chrono::milliseconds patience_;
  TopicDocument newest_{"null", {}, {}};
  std::optional<TopicDocument> told_;
  HostTime told_at_{};
  bool has_shown_another_ = false;  // than told_, since that was told
};

}  // namespace fvd
